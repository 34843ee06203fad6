// Importance of a parameter for an objective, by the trials that there are.
import type { TrialEvent } from "../../../protocol";
import { type Axis, isDone, rangeOf, valueOn } from "../trials";

/** Up to so many values a parameter is taken value by value; more are put in as many bins. */
const BINS = 8;

/**
 * The share of an objective's variance that lies between the groups of trials with about the same
 * value of a parameter: the correlation ratio, 0 to 1. 0 where nothing can be told.
 */
export function importanceOf(
  trials: readonly TrialEvent[],
  parameter: Axis,
  objective: Axis,
): number {
  const pairs = trials
    .filter((trial) => isDone(trial))
    .map((trial) => [valueOn(trial, parameter), valueOn(trial, objective)] as const)
    .filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
  if (pairs.length < 2) return 0;
  const values = new Set(pairs.map(([x]) => x));
  const [low, high] = rangeOf(pairs.map(([x]) => x));
  const group = (x: number) =>
    values.size <= BINS ? x : Math.min(BINS - 1, Math.floor(((x - low) / (high - low)) * BINS));
  const groups = new Map<number, number[]>();
  for (const [x, y] of pairs) groups.set(group(x), [...(groups.get(group(x)) ?? []), y]);
  const mean = (numbers: readonly number[]) =>
    numbers.reduce((sum, one) => sum + one, 0) / numbers.length;
  const whole = mean(pairs.map(([, y]) => y));
  const total = pairs.reduce((sum, [, y]) => sum + (y - whole) ** 2, 0);
  let between = 0;
  for (const group of groups.values()) between += group.length * (mean(group) - whole) ** 2;
  return total > 0 ? between / total : 0;
}

/** The parameter that says most about the first objective; the first where none says anything. */
export function mostImportant(
  trials: readonly TrialEvent[],
  axes: readonly Axis[],
): Axis | undefined {
  const objective = axes.find((axis) => axis.role === "objective");
  const parameters = axes.filter((axis) => axis.role === "parameter");
  if (!objective) return parameters[0];
  let best = parameters[0];
  let most = 0;
  for (const parameter of parameters) {
    const importance = importanceOf(trials, parameter, objective);
    if (importance > most) [best, most] = [parameter, importance];
  }
  return best;
}
