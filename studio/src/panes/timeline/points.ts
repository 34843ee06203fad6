// The points of a history, and its text after they are changed.
import { writeValue } from "../../controls/kinds";
import { factorOf } from "../../controls/units";
import { unitOf } from "../../controls/unitTable";
import type { HistoryLine } from "../../protocol";
import type { Change } from "../design/edits";
import { inside } from "../design/fields/schema";
import { ticks } from "../study/chart/ticks";

/** Points are dragged one by one up to this many; longer lists are changed in the text. */
export const MOST_POINTS = 200;

/** A point: its instant in s and its factor, each with its text. */
export interface Point {
  readonly time: number;
  readonly factor: number;
  /** The text's own entries; a number that was changed here has none. */
  readonly written: { readonly time?: unknown; readonly factor?: unknown };
  /** The units that the text has for them, or "" for a bare factor. */
  readonly units: { readonly time: string; readonly factor: string };
}

/** Least gap between two points: a round part of the time that all of them take, s. */
function gapOf(points: readonly Point[]): number {
  const span = Math.max(points.at(-1)!.time - points[0]!.time, 1e-3);
  return 10 ** Math.floor(Math.log10(span)) / 1e3;
}

/** Between which values a point may be moved. */
export interface Room {
  readonly time: readonly [number, number];
  readonly factor: readonly [number, number];
}

/** The points of a line with the entries of the document, or null where none can be changed. */
export function pointsOf(line: HistoryLine, source: unknown): readonly Point[] | null {
  if (line.way !== "points" || line.times.length > MOST_POINTS) return null;
  const table = line.path.reduce<unknown>(inside, source);
  const times = inside(table, "time");
  const factors = inside(table, "factor");
  if (!Array.isArray(times) || !Array.isArray(factors)) return null;
  if (times.length !== line.times.length || factors.length !== line.factors.length) return null;
  // A zero has no unit of its own.
  const unit = times.map(unitIn).find((one) => one !== "") ?? "s";
  return line.times.map((time, i) => ({
    time,
    factor: line.factors[i]!,
    written: { time: times[i], factor: factors[i] },
    units: { time: unitIn(times[i]) || unit, factor: unitIn(factors[i]) },
  }));
}

export function isFormula(written: unknown): boolean {
  return typeof written === "string" && written.trimStart().startsWith("=");
}

/** Range of a point: never past its neighbors, nor outside of the values that the user of the history can have. */
export function roomOf(points: readonly Point[], index: number, line: HistoryLine): Room {
  const point = points[index]!;
  const gap = gapOf(points);
  const before = points[index - 1];
  const after = points[index + 1];
  const free: Room = {
    time: [
      before ? round(before.time + gap) : 0,
      after ? round(after.time - gap) : Number.POSITIVE_INFINITY,
    ],
    factor: [line.low ?? Number.NEGATIVE_INFINITY, line.high ?? Number.POSITIVE_INFINITY],
  };
  // Formulas, and the ends of a repeated history, move with something else.
  const [first, last] = [index === 0, index === points.length - 1];
  const tied = line.repeat > 1 && (first || last);
  const other = points[first ? points.length - 1 : 0]!;
  const fixed = isFormula(point.written.factor) || (tied && isFormula(other.written.factor));
  return {
    time: isFormula(point.written.time) ? [point.time, point.time] : free.time,
    factor: fixed ? [point.factor, point.factor] : free.factor,
  };
}

/** A number without the noise of binary fractions. */
export const round = (value: number): number => Number(value.toPrecision(12));

const within = (value: number, [low, high]: readonly [number, number]) =>
  Math.min(Math.max(value, low), high);

/** Move a point as near to a place as it can go; both ends of a repeated history keep one factor. */
export function moved(
  points: readonly Point[],
  index: number,
  time: number,
  factor: number,
  line: HistoryLine,
): readonly Point[] {
  const room = roomOf(points, index, line);
  const next = changed(points[index]!, within(time, room.time), within(factor, room.factor));
  const last = points.length - 1;
  const other = line.repeat > 1 && (index === 0 || index === last) ? last - index : -1;
  return points.map((point, i) => {
    if (i === index) return next;
    return i === other ? changed(point, point.time, next.factor) : point;
  });
}

function changed(point: Point, time: number, factor: number): Point {
  return {
    ...point,
    time,
    factor,
    written: {
      ...(time === point.time && "time" in point.written ? { time: point.written.time } : {}),
      ...(factor === point.factor && "factor" in point.written
        ? { factor: point.written.factor }
        : {}),
    },
  };
}

/** Add a point at a place; gives the points and its index, or null where one stands already. */
export function added(
  points: readonly Point[],
  time: number,
  factor: number,
  line: HistoryLine,
): { readonly points: readonly Point[]; readonly index: number } | null {
  if (points.length >= MOST_POINTS || time < 0) return null;
  const gap = gapOf(points);
  if (points.some((point) => Math.abs(point.time - time) < gap)) return null;
  const index = points.filter((point) => point.time < time).length;
  const high = line.high ?? Number.POSITIVE_INFINITY;
  const fresh = {
    time,
    factor: within(factor, [line.low ?? Number.NEGATIVE_INFINITY, high]),
    written: {},
    units: points[Math.max(index - 1, 0)]!.units,
  };
  return { points: tied(points.toSpliced(index, 0, fresh), line, index), index };
}

/** Take a point away; null where it is one of the last that there must be. */
export function removed(
  points: readonly Point[],
  index: number,
  line: HistoryLine,
): readonly Point[] | null {
  if (points.length <= (line.repeat > 1 ? 2 : 1)) return null;
  return tied(points.toSpliced(index, 1), line, index);
}

/** The end of a repeated history is its beginning: a new end takes the factor of the other. */
function tied(points: readonly Point[], line: HistoryLine, at: number): readonly Point[] {
  const last = points.length - 1;
  if (line.repeat <= 1 || (at > 0 && at < last)) return points;
  const [kept, given] = at === 0 ? [points[last]!, 0] : [points[0]!, last];
  return points.map((one, i) => (i === given ? changed(one, one.time, kept.factor) : one));
}

/** The changes of the text: entries that were not touched stay as they are written. */
export function written(line: HistoryLine, points: readonly Point[]): Change[] {
  const list = (key: "time" | "factor") =>
    points.map((point) => {
      if (key in point.written) return point.written[key];
      const unit = point.units[key];
      return writeValue(point[key], factorOf(unit), unit);
    });
  return [
    { path: [...line.path, "time"], value: list("time") },
    { path: [...line.path, "factor"], value: list("factor") },
  ];
}

/** The unit that an entry is written with. */
function unitIn(entry: unknown): string {
  const unit = /^\s*[-+\d.e]+\s*(\S+)\s*$/i.exec(String(entry ?? ""))?.[1];
  return unit !== undefined && unitOf(unit) ? unit : "";
}

/** The round step that values snap to on an axis of which some twenty make the span. */
export function snapStep(span: number, fine: boolean): number {
  const [first = 0, second = 1] = ticks(0, span, 25);
  return (second - first) / (fine ? 10 : 1);
}

export function snapped(value: number, step: number): number {
  return round(Math.round(value / step) * step);
}

/** The instants and factors of the whole, with all its repeats. */
export function whole(
  times: readonly number[],
  factors: readonly number[],
  repeat: number,
): [number[], number[]] {
  const long = (times.at(-1) ?? 0) - (times[0] ?? 0);
  // A history that repeats more often than can be seen is drawn as often as can be.
  const cycles = Math.min(repeat, Math.max(1, Math.floor(4000 / Math.max(times.length, 1))));
  const all: [number[], number[]] = [[...times], [...factors]];
  for (let cycle = 1; cycle < cycles; cycle++) {
    all[0].push(...times.slice(1).map((time) => time + cycle * long));
    all[1].push(...factors.slice(1));
  }
  return all;
}

/** The end of the axis that all lines share: a little beyond the last instant, in s. */
export function endOf(lines: readonly HistoryLine[], endTime: number | null): number {
  const ends = lines.map(({ times, repeat }) => {
    const [first, last] = [times[0] ?? 0, times.at(-1) ?? 0];
    return last + (repeat - 1) * (last - first);
  });
  const last = Math.max(endTime ?? 0, ...ends);
  return last > 0 ? 1.08 * last : 1;
}

/** The factors that a row shows: from zero, or below it, to one, or above it. */
export function rangeOf(factors: readonly number[]): [number, number] {
  let [low, high] = [0, 1];
  for (const factor of factors) {
    low = Math.min(low, factor);
    high = Math.max(high, factor);
  }
  const pad = 0.08 * (high - low);
  return [low - (low < 0 ? pad : 0.04 * (high - low)), high + pad];
}
