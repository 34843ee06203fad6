// A measured curve laid over a path: two columns of a CSV file, with their units.
import { siUnit } from "../../controls/kinds";
import { parseQuantity, shownUnit } from "../../controls/units";

/** A measured curve in SI units, rising in x. */
export interface Measured {
  readonly name: string;
  readonly x: readonly number[];
  readonly y: readonly number[];
  /** Its first line names no units, so that they were taken to be those of the axes. */
  readonly assumed: boolean;
}

/** Difference between a computed curve and a measured one, where both are known. */
export interface Misfit {
  readonly rms: number;
  readonly largest: number;
  readonly count: number;
}

/** The unit at the end of a column's name: `pressure_kPa`, `angle (deg)`, `force [N]`. */
function unitOf(header: string): string | null {
  const found = /[[(]([^\])]+)[\])]\s*$/.exec(header) ?? /_([^_\s]+)$/.exec(header);
  return found?.[1]?.trim() ?? null;
}

function factorFor(header: string | undefined, kind: string): number | { problem: string } {
  const unit = header === undefined ? null : unitOf(header);
  // Without a unit a number is in the unit that the axis shows.
  const parsed = parseQuantity(`1 ${unit ?? shownUnit(siUnit(kind))}`, siUnit(kind));
  if ("value" in parsed) return parsed.value;
  return { problem: `“${header}” is no ${kind}: name the column as in angle_deg or angle (deg)` };
}

/** Read two columns: the value changed along the path, and a number of the given kind over it. */
export function readMeasured(
  text: string,
  name: string,
  xKind: string,
  yKind: string,
): Measured | { readonly problem: string } {
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
  const factors = [xKind, yKind].map((kind, i) =>
    factorFor(headed ? (first[i] ?? "") : undefined, kind),
  );
  for (const factor of factors) if (typeof factor !== "number") return factor;
  const [fx, fy] = factors as [number, number];
  const rows: [number, number][] = [];
  for (const [i, row] of cells.slice(headed ? 1 : 0).entries()) {
    const [x, y] = [Number(row[0] || Number.NaN), Number(row[1] || Number.NaN)];
    if (!Number.isFinite(x) || !Number.isFinite(y))
      return { problem: `row ${i + 1} has no two numbers: ${row.join(", ")}` };
    rows.push([fx * x, fy * y]);
  }
  if (rows.length < 2) return { problem: "it has no two rows of numbers" };
  rows.sort((a, b) => a[0] - b[0]);
  const assumed = !headed || first.slice(0, 2).some((cell) => unitOf(cell) === null);
  return { name, x: rows.map(([x]) => x), y: rows.map(([, y]) => y), assumed };
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
