// Where the pictures of trials stand on a map of two quantities.
import type { TrialEvent } from "../../../protocol";
import { padded } from "../chart/ticks";
import { type Axis, isDone, rangeOf, valueOn } from "../trials";

export interface Place {
  readonly trial: TrialEvent;
  /** Middle of the picture, pixels. */
  readonly x: number;
  readonly y: number;
}

export interface Map2 {
  readonly places: readonly Place[];
  /** Smallest and largest value along x and y. */
  readonly limits: readonly [number, number, number, number];
  toX(value: number): number;
  toY(value: number): number;
}

/** Where the middles of pictures may stand, pixels. */
export interface Box {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
  /** The height of a picture, which those without a value take for themselves at the bottom. */
  readonly rail: number;
}

function limitsOf(trials: readonly TrialEvent[], axis: Axis): readonly [number, number] {
  if (axis.choices) return [-0.5, Math.max(axis.choices.length - 0.5, 0.5)];
  return padded(rangeOf(trials.map((trial) => valueOn(trial, axis))), 0.06);
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
      y: Number.isFinite(atY) ? toY(atY) : box.bottom,
    };
  });
  // The best are drawn last, over the others.
  places.sort((a, b) => Number(isDone(a.trial)) - Number(isDone(b.trial)));
  return { places, limits: [x0, x1, y0, y1], toX, toY };
}
