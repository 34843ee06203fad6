// Places of the pictures of trials on a map of two quantities.
import type { TrialEvent } from "../../../protocol";
import { padded } from "../chart/ticks";
import { type Axis, isDone, rangeOf, valueOn } from "../trials";

export interface Place {
  readonly trial: TrialEvent;
  /** Middle of the picture, pixels. */
  readonly x: number;
  readonly y: number;
  /** Place of its values along x, pixels, from which a picture may have moved aside. */
  readonly atX: number;
}

export interface Map2 {
  readonly places: readonly Place[];
  /** Smallest and largest value along x and y. */
  readonly limits: readonly [number, number, number, number];
  toX(value: number): number;
  toY(value: number): number;
}

/** Range for the middles of pictures, pixels. */
export interface Box {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
  /** The height of a picture, which those without a value take for themselves at the bottom. */
  readonly rail: number;
}

/** Columns of a map: more values are taken as any. */
const COLUMNS = 12;

function limitsOf(trials: readonly TrialEvent[], axis: Axis): readonly [number, number] {
  if (axis.choices) return [-0.5, Math.max(axis.choices.length - 0.5, 0.5)];
  const values = trials.map((trial) => valueOn(trial, axis)).filter(Number.isFinite);
  const columns = [...new Set(values)].sort((a, b) => a - b);
  if (columns.length < 2 || columns.length > COLUMNS) return padded(rangeOf(values), 0.06);
  const [low, high] = [columns[0] as number, columns.at(-1) as number];
  const half = Math.min(...columns.slice(1).map((x, i) => x - (columns[i] as number))) / 2;
  return [low - half, high + half];
}

/**
 * Put each trial at its values. One that has no value along y, as a failed one has no objective,
 * stands below all others; one that has none along x, at the left.
 */
export function placed(trials: readonly TrialEvent[], x: Axis, y: Axis, box: Box): Map2 {
  const [x0, x1] = limitsOf(trials, x);
  const [y0, y1] = limitsOf(trials, y);
  const low = trials.some((trial) => !Number.isFinite(valueOn(trial, y)))
    ? Math.max(box.top + 1, box.bottom - box.rail)
    : box.bottom;
  const toX = (value: number) => box.left + ((value - x0) / (x1 - x0)) * (box.right - box.left);
  const toY = (value: number) => low - ((value - y0) / (y1 - y0)) * (low - box.top);
  const places = trials.map((trial) => {
    const [atX, atY] = [valueOn(trial, x), valueOn(trial, y)];
    return {
      trial,
      x: Number.isFinite(atX) ? toX(atX) : box.left,
      atX: Number.isFinite(atX) ? toX(atX) : box.left,
      y: Number.isFinite(atY) ? toY(atY) : box.bottom,
    };
  });
  return { places: sideBySide(places, box), limits: [x0, x1, y0, y1], toX, toY };
}

/** The part of a picture that another may cover. */
const COVERED = 0.45;

/**
 * If trials share few values along x, those that would cover each other stand beside each other
 * within their column: the first of them, which are the best, at its middle.
 */
function sideBySide(places: readonly Place[], { left, right, rail }: Box): Place[] {
  const columns = [...new Set(places.map((place) => place.x))].sort((a, b) => a - b);
  if (columns.length > COLUMNS || columns.length === places.length) return [...places];
  const gaps = columns.slice(1).map((x, i) => x - (columns[i] as number));
  const room = columns.length > 1 ? Math.min(...gaps) / 2 - 0.3 * rail : (right - left) / 2;
  const step = (1 - COVERED) * rail;
  const most = Math.max(0, Math.floor(room / step));
  const taken: Place[] = [];
  for (const place of places) {
    // Empty frames say the same: one of a column is enough.
    if (!isDone(place.trial)) {
      taken.push(place);
      continue;
    }
    const beside = Array.from({ length: 2 * most + 1 }, (_, i) => ({
      ...place,
      x: place.x + (i % 2 ? -1 : 1) * Math.ceil(i / 2) * step,
    })).filter(({ x }) => x >= left && x <= right);
    const covers = (one: Place) =>
      taken.filter(
        (other) => Math.abs(other.x - one.x) < 0.9 * step && Math.abs(other.y - one.y) < step,
      ).length;
    const free = beside.find((one) => covers(one) === 0);
    taken.push(free ?? beside.sort((a, b) => covers(a) - covers(b))[0] ?? place);
  }
  return taken;
}
