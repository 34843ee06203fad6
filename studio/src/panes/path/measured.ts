// A measured curve laid over a path: two columns of a table, with their units.
import { describeDimension, sameDimension } from "../../controls/dimension";
import { dimensionOf, siUnit } from "../../controls/kinds";
import { factorOf, shownUnit } from "../../controls/units";
import { unitOf } from "../../controls/unitTable";

/** A measured curve in SI units, rising in x. */
export interface Measured {
  readonly name: string;
  readonly x: readonly number[];
  readonly y: readonly number[];
  /** Its first line names no units, so that they were taken to be those of the axes. */
  readonly assumed: boolean;
  /** The column of y has the name of the axis. */
  readonly named: boolean;
}

/** Difference between a computed curve and a measured one, where both are known. */
export interface Misfit {
  readonly rms: number;
  readonly largest: number;
  readonly count: number;
}

/** An axis that a column is sought for. */
export interface Axis {
  readonly name: string;
  readonly kind: string;
}

interface Head {
  /** Its first cell, as it stands. */
  readonly text: string;
  /** The letters and digits of the name before the unit. */
  readonly name: string;
  /** null: no unit that this page knows. */
  readonly unit: string | null;
  /** Its first row holds a number. */
  readonly numeric: boolean;
}

interface Sheet {
  readonly heads: readonly Head[];
  readonly rows: readonly (readonly string[])[];
}

/** A name without the free choices of writers of tables: case, spaces, dots and dashes. */
function bareName(text: string): string {
  return text.toLowerCase().replaceAll(/[^\p{L}\p{N}]+/gu, "");
}

/** A head and the unit at its end: `pressure_kPa`, `angle (deg)`, `force [N]`. */
function headOf(text: string, first: string | undefined): Head {
  const numeric = first !== undefined && first !== "" && Number.isFinite(Number(first));
  const found = /^(.*?)[[(]([^\])]+)[\])]\s*$/.exec(text) ?? /^(.*)_([^_\s]+)$/.exec(text) ?? null;
  const unit = found?.[2]?.trim() ?? "";
  if (unit === "" || unitOf(unit) === null) {
    return { text, name: bareName(text), unit: null, numeric };
  }
  return { text, name: bareName(found?.[1] ?? ""), unit, numeric };
}

function sheetOf(text: string): Sheet {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() && !line.startsWith("#"));
  // If a semicolon or a tab separates the columns, a comma is that of decimals.
  const apart = lines.some((line) => /[;\t]/.test(line));
  const cells = lines.map((line) =>
    line.split(apart ? /[;\t]/ : ",").map((cell) => {
      const bare = cell.trim().replace(/^"(.*)"$/, "$1");
      return apart ? bare.replace(/^([+-]?\d*),(\d+)/, "$1.$2") : bare;
    }),
  );
  const first = cells[0] ?? [];
  const headed = first.some((cell) => cell !== "" && Number.isNaN(Number(cell)));
  const rows = cells.slice(headed ? 1 : 0);
  return { heads: first.map((cell, i) => headOf(headed ? cell : "", rows[0]?.[i])), rows };
}

function isOf(head: Head, kind: string): boolean {
  const unit = head.unit === null ? null : unitOf(head.unit);
  return unit !== null && sameDimension(unit.dimension, dimensionOf(kind));
}

/**
 * The column of an axis: that of its name, or the first of its kind, or the first number without a
 * unit; `others` are the names of other axes, whose columns are not meant.
 */
function columnOf(
  heads: readonly Head[],
  axis: Axis,
  others: readonly string[] = [],
  taken = -1,
): number | null {
  const own = bareName(axis.name);
  const free = [...heads.entries()].filter(([i]) => i !== taken);
  const meant = free.filter(([, { name }]) => name === own || !others.includes(name));
  const fitting = meant.filter(([, head]) => isOf(head, axis.kind));
  const found =
    fitting.find(([, { name }]) => name === own) ??
    fitting[0] ??
    meant.find(([, { unit, numeric }]) => unit === null && numeric);
  return found?.[0] ?? null;
}

/** Size of the unit of a column; without one a number is in the unit that the axis shows. */
function factorFor(head: Head, kind: string): number {
  return factorOf(head.unit ?? shownUnit(siUnit(kind)));
}

/** Why no column is that of an axis, with a head that would be. */
function missing(heads: readonly Head[], axis: Axis): { readonly problem: string } {
  const due = describeDimension(dimensionOf(axis.kind));
  const came = heads.map(({ text, unit }) => {
    const known = unit === null ? null : unitOf(unit);
    return `“${text}”${known ? ` (${describeDimension(known.dimension)})` : ""}`;
  });
  const example = `${axis.name} (${shownUnit(siUnit(axis.kind))})`;
  return {
    problem: `no column is ${due} as ${axis.name} is, among ${came.join(", ")}; such a one is “${example}”`,
  };
}

/** Read two columns: the value changed along the path, and a number over it. */
export function readMeasured(
  text: string,
  name: string,
  x: Axis,
  y: Axis,
  others: readonly string[] = [],
): Measured | { readonly problem: string } {
  const { heads, rows } = sheetOf(text);
  if (heads.length === 0) return { problem: "it has no two rows of numbers" };
  const bareOthers = others.map(bareName);
  const at = columnOf(heads, x, bareOthers);
  if (at === null) return missing(heads, x);
  const over = columnOf(heads, y, bareOthers, at);
  if (over === null) return missing(heads, y);
  const [across, along] = [heads[at]!, heads[over]!];
  const [fx, fy] = [factorFor(across, x.kind), factorFor(along, y.kind)];
  const points: [number, number][] = [];
  for (const [i, row] of rows.entries()) {
    const [one, two] = [Number(row[at] || Number.NaN), Number(row[over] || Number.NaN)];
    if (!Number.isFinite(one) || !Number.isFinite(two))
      return { problem: `row ${i + 1} has no two numbers: ${row.join(", ")}` };
    points.push([fx * one, fy * two]);
  }
  if (points.length < 2) return { problem: "it has no two rows of numbers" };
  points.sort((a, b) => a[0] - b[0]);
  return {
    name,
    x: points.map(([one]) => one),
    y: points.map(([, two]) => two),
    assumed: across.unit === null || along.unit === null,
    named: along.name !== "" && along.name === bareName(y.name),
  };
}

/** The number of a column of a kind that is farthest from zero, SI; null where none names its unit. */
export function farthest(text: string, kind: string): number | null {
  const { heads, rows } = sheetOf(text);
  const at = heads.findIndex((head) => isOf(head, kind));
  if (at < 0) return null;
  const numbers = rows.map((row) => Number(row[at] || Number.NaN)).filter(Number.isFinite);
  const most = numbers.reduce((far, one) => (Math.abs(one) > Math.abs(far) ? one : far), 0);
  return most === 0 ? null : most * factorFor(heads[at]!, kind);
}

/** Compare on a path that rises or falls throughout; null for a loop, or where they do not meet. */
export function misfit(
  measured: Measured,
  x: readonly number[],
  y: readonly (number | null)[],
): Misfit | null {
  const points = x
    .map((at, i): [number, number | null | undefined] => [at, y[i]])
    .filter((point): point is [number, number] => typeof point[1] === "number");
  const falls = (points.at(-1)?.[0] ?? 0) < (points[0]?.[0] ?? 0);
  if (falls) points.reverse();
  if (points.some(([at], i) => i > 0 && at <= (points[i - 1] as [number, number])[0])) return null;
  const off = measured.x.flatMap((at, i) => {
    const after = points.findIndex(([one]) => one >= at);
    const [high, low] = [points[after], points[Math.max(0, after - 1)]];
    if (!high || !low || at < low[0]) return [];
    const share = high[0] > low[0] ? (at - low[0]) / (high[0] - low[0]) : 0;
    return [low[1] + share * (high[1] - low[1]) - (measured.y[i] as number)];
  });
  if (off.length === 0) return null;
  const rms = Math.sqrt(off.reduce((sum, one) => sum + one * one, 0) / off.length);
  return { rms, largest: Math.max(...off.map(Math.abs)), count: off.length };
}

/** Both curves over all their x: where one has none it is NaN, and its line goes on. */
export function together(
  x: readonly number[],
  y: readonly number[],
  measured: Measured,
): [number[], number[], number[]] {
  const rows: [number, number, number][] = [
    ...x.map((at, i): [number, number, number] => [at, y[i] as number, Number.NaN]),
    ...measured.x.map((at, i): [number, number, number] => [
      at,
      Number.NaN,
      measured.y[i] as number,
    ]),
  ];
  // A loop keeps its order: only a path that rises can be sorted among the measured points.
  if (x.every((at, i) => i === 0 || at >= (x[i - 1] as number))) rows.sort((a, b) => a[0] - b[0]);
  return [0, 1, 2].map((k) => rows.map((row) => row[k] as number)) as [
    number[],
    number[],
    number[],
  ];
}
