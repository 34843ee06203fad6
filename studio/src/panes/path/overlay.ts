// The number along a path that is shown, and the measured curve over it.
import type { PathColumn, PathEvent } from "../../protocol";
import type { Changeable } from "./lines";
import { farthest, type Measured, readMeasured } from "./measured";
import type { PathTable } from "./tables";

type Read = Measured | { readonly problem: string };

function read(table: PathTable, path: PathEvent, column: PathColumn): Read {
  const others = path.columns.filter((one) => one !== column).map(({ name }) => name);
  const over = { name: path.over, kind: path.kind };
  return readMeasured(table.text, table.name, over, column, others);
}

/** A number that the design asks for comes first; without it, the displacement that changes most. */
function mostTelling(path: PathEvent): PathColumn | undefined {
  const first = path.columns[0];
  const moved = path.columns.filter((one) => /\.[xyz]$/.test(one.name));
  const size = (column: PathColumn) =>
    Math.max(...column.values.map((value) => Math.abs(value ?? 0)));
  const standard = first && ["cavity_volume", "elastic_energy"].includes(first.name);
  return standard && moved.length > 0
    ? moved.reduce((best, one) => (size(one) > size(best) ? one : best))
    : first;
}

/** The number that a table is for: that of its name, or the most telling one of its kind. */
function columnFor(table: PathTable, path: PathEvent): PathColumn | undefined {
  const found = [mostTelling(path), ...path.columns].flatMap((column) => {
    const curve = column && read(table, path, column);
    return curve && "x" in curve ? [{ column, curve }] : [];
  });
  return (found.find(({ curve }) => curve.named) ?? found[0])?.column;
}

export interface Overlaid {
  readonly column: PathColumn;
  readonly measured: Measured | null;
  /** Why the newest table lies over no number. */
  readonly problem: string | null;
}

/** The chosen number or the one that suits the newest table, with the measured curve over it. */
export function overlaid(
  path: PathEvent,
  tables: readonly PathTable[],
  chosen: string,
): Overlaid | null {
  const newest = tables[0];
  const suited = newest && columnFor(newest, path);
  const column =
    path.columns.find(({ name }) => name === chosen) ?? suited ?? mostTelling(path) ?? null;
  if (!column) return null;
  const curves = tables.flatMap((table) => {
    const curve = read(table, path, column);
    if (!("x" in curve)) return [];
    return !curve.assumed || [null, column.name].includes(table.column) ? [curve] : [];
  });
  const failed = newest && !suited ? read(newest, path, column) : null;
  return {
    column,
    measured: curves[0] ?? null,
    problem: failed && "problem" in failed ? failed.problem : null,
  };
}

/** The value that a table is over, and the end of its range; null where no column is of such a kind. */
export function suggested(
  choices: readonly Changeable[],
  table: PathTable | undefined,
): { readonly what: Changeable; readonly end: number } | null {
  for (const what of table ? choices : []) {
    const end = farthest(table?.text ?? "", what.kind);
    if (end !== null) return { what, end };
  }
  return null;
}
