// Colors of designs by a quantity: brighter is better, on a map that all common kinds of color
// vision read.

import type { TrialEvent, TrialsEvent } from "../../protocol";
import { colorAt } from "../../view/body/colormaps";
import { type Axis, isDone, rangeOf, valueOn } from "./trials";

export interface Coloring {
  readonly axis: Axis | null;
  readonly range: readonly [number, number];
  /** The best value is the brightest. */
  readonly turned: boolean;
  color(trial: TrialEvent): string;
}

const FAILED = "var(--bad)";

/** Colors of trials by an axis; the first objective where none is given. */
export function coloring(
  study: TrialsEvent,
  axes: readonly Axis[],
  by?: Axis | undefined,
): Coloring {
  const axis = by ?? axes.find((one) => one.role === "objective") ?? null;
  const range = rangeOf(axis ? study.trials.map((trial) => valueOn(trial, axis)) : []);
  const at = axis?.role === "objective" ? study.objectives.indexOf(axis.name) : -1;
  const turned = at >= 0 && study.directions[at] === "minimize";
  return {
    axis,
    range,
    turned,
    color(trial) {
      if (!isDone(trial)) return FAILED;
      const value = axis ? valueOn(trial, axis) : Number.NaN;
      if (!Number.isFinite(value)) return "var(--faint)";
      const share = (value - range[0]) / (range[1] - range[0]);
      return `rgb(${colorAt("viridis", turned ? 1 - share : share).join(" ")})`;
    },
  };
}
