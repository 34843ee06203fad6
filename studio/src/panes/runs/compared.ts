// Results of two designs side by side, as rows of a table.
import { describeValue, formatKind } from "../../controls/kinds";
import { factorOf, formatNumber, unitText } from "../../controls/units";
import type { ComparedEvent, Side } from "../../protocol";

export interface ComparedRow {
  readonly name: string;
  readonly a: string;
  readonly b: string;
  /** The change from a to b, where both are numbers. */
  readonly change: string;
  readonly differs: boolean;
}

/** The unit in which the text of a design writes a parameter; null where it has none. */
export function unitIn(text: string, parameter: string): string | null {
  const name = parameter.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  const line = new RegExp(`^\\s*"?${name}"?\\s*=\\s*(.*)$`, "m").exec(text)?.[1] ?? "";
  return /"\s*[+-]?[\d.]+(?:e[+-]?\d+)?\s*([^"\d][^"]*)"/i.exec(line)?.[1]?.trim() ?? null;
}

/** An SI value in the unit in which a design writes that parameter. */
function inUnitOf(text: string, parameter: string, value: unknown): string | null {
  const unit = unitIn(text, parameter);
  if (unit === null || typeof value !== "number") return null;
  return `${formatNumber(value / factorOf(unit), 5)} ${unitText(unit)}`;
}

/** Rows for all names of two tables, in their order; `kindOf` tells the units. */
export function comparedRows(
  a: Readonly<Record<string, unknown>>,
  b: Readonly<Record<string, unknown>>,
  kindOf: (name: string) => string,
  texts: { readonly a: string; readonly b: string } = { a: "", b: "" },
): ComparedRow[] {
  const names = [...new Set([...Object.keys(a), ...Object.keys(b)])];
  return names.map((name) => {
    const [left, right] = [a[name], b[name]];
    const text = (value: unknown, design: string) =>
      inUnitOf(design, name, value) ??
      (typeof value === "number" ? formatKind(value, kindOf(name)) : describeValue(value));
    return {
      name,
      a: text(left, texts.a),
      b: text(right, texts.b),
      change: changeOf(left, right, kindOf(name)),
      differs: JSON.stringify(left) !== JSON.stringify(right),
    };
  });
}

/** The change from one number to another in percent of the size of the first. */
export function percentChange(a: number, b: number): number {
  return (100 * (b - a)) / Math.abs(a);
}

/** Name of a side: a run by its name, a trial by its number. */
export function sideTitle(side: Side): string {
  const slash = side.id.lastIndexOf("/");
  return slash < 0 ? side.name : `Design ${side.id.slice(slash + 1)}`;
}

/** Title of the table of changes. */
export function changeTitle(a: Side, b: Side): string {
  return `${sideTitle(b)} minus ${sideTitle(a)}, in % of ${sideTitle(a)}`;
}

function changeOf(a: unknown, b: unknown, kind: string): string {
  if (typeof a !== "number" || typeof b !== "number" || a === b) return "";
  const sign = b > a ? "+" : "";
  if (a === 0) return `${sign}${formatKind(b - a, kind, 3)}`;
  return `${sign}${formatNumber(percentChange(a, b), 3)} %`;
}

/** Differences of the designs that are not told by the parameters already. */
export function otherDifferences(compared: ComparedEvent): ComparedEvent["differences"] {
  return compared.differences.filter(
    ({ where }) => !where.startsWith("parameters.") || !where.endsWith(".value"),
  );
}
