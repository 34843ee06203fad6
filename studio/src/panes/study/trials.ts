// Data of a study's trials for its plots and its table.

import { describeValue, formatKind, siUnit } from "../../controls/kinds";
import { tableText } from "../../controls/tableText";
import type { TrialEvent, TrialsEvent } from "../../protocol";

/** A quantity that each trial has: a parameter, an objective or another metric. */
export interface Axis {
  readonly key: string;
  readonly name: string;
  readonly role: "parameter" | "objective" | "constraint" | "metric";
  readonly kind: string;
  /** The values of a parameter that is no number, in order. */
  readonly choices: readonly string[] | null;
  /** Smallest and largest allowed value of a constraint; infinite where open. */
  readonly allowed?: readonly [number, number];
}

export function isDone(trial: TrialEvent): boolean {
  return trial.objectives !== null && Object.values(trial.objectives).every(Number.isFinite);
}

/** Parameters, objectives, constraints, then the other metrics of a study. */
export function axesOf(study: TrialsEvent): Axis[] {
  const { trials, kinds, constraints } = study;
  const asked = [...study.parameters, ...study.objectives, ...constraints.map((one) => one.name)];
  const metrics = [...new Set(trials.flatMap((trial) => Object.keys(trial.metrics)))].filter(
    (name) => !asked.includes(name) && !isRepeated(name, study),
  );
  const axis = (role: Axis["role"], name: string): Axis => ({
    key: `${role}:${name}`,
    name,
    role,
    kind: kinds[name] ?? "number",
    choices: role === "parameter" ? wordsOf(trials, name) : null,
  });
  return [
    ...study.parameters.map((name) => axis("parameter", name)),
    ...study.objectives.map((name) => axis("objective", name)),
    ...constraints.map((one) => ({
      ...axis("constraint", one.name),
      allowed: [one.min ?? -Infinity, one.max ?? Infinity] as const,
    })),
    ...metrics.map((name) => axis("metric", name)),
  ];
}

/** Check if a metric has the values of a constraint of that metric in all trials. */
function isRepeated(name: string, { trials, constraints }: TrialsEvent): boolean {
  return constraints.some(
    (one) =>
      one.metric === name && trials.every(({ metrics }) => metrics[name] === metrics[one.name]),
  );
}

/** Constraints that a trial with a result breaks. */
export function brokenBy(trial: TrialEvent, axes: readonly Axis[]): Axis[] {
  if (!isDone(trial)) return [];
  return axes.filter((axis) => {
    if (!axis.allowed) return false;
    const [low, high] = axis.allowed;
    const value = valueOn(trial, axis);
    return !(value >= low && value <= high);
  });
}

/** Range of a quantity in words, such as "at most 90 g". */
export function rangeText(axis: Axis, [low, high]: readonly [number, number]): string {
  const [least, most] = [textOn(low, axis, 3), textOn(high, axis, 3)];
  if (low === -Infinity && high === Infinity) return "any";
  if (low === -Infinity) return `at most ${most}`;
  if (high === Infinity) return `at least ${least}`;
  return `${least} to ${most}`;
}

/** Reason why a trial is not allowed, such as "limit is 120 g, at most 90 g"; empty for others. */
export function reasonOf(trial: TrialEvent, axes: readonly Axis[]): string {
  return brokenBy(trial, axes)
    .map((axis) => {
      const value = textOn(valueOn(trial, axis), axis, 4);
      return `${axis.name} is ${value}, ${rangeText(axis, axis.allowed ?? [-Infinity, Infinity])}`;
    })
    .join("; ");
}

function wordsOf(trials: readonly TrialEvent[], name: string): readonly string[] | null {
  const words = new Set<string>();
  for (const trial of trials) {
    const value = trial.parameters[name];
    if (value !== undefined && typeof value !== "number") words.add(describeValue(value));
  }
  return words.size > 0 ? [...words].sort() : null;
}

/** The value of a trial on an axis; NaN where it has none. */
export function valueOn(trial: TrialEvent, axis: Axis): number {
  if (axis.role === "parameter") {
    const value = trial.parameters[axis.name];
    if (axis.choices) return axis.choices.indexOf(describeValue(value));
    return typeof value === "number" ? value : Number.NaN;
  }
  const from = axis.role === "objective" ? trial.objectives : trial.metrics;
  return from?.[axis.name] ?? Number.NaN;
}

/** A value of an axis as text with its unit. */
export function textOn(value: number, axis: Axis, digits = 4): string {
  if (axis.choices) return axis.choices[Math.round(value)] ?? "–";
  return formatKind(value, axis.kind, digits);
}

/** Smallest and largest finite value; equal ones are set apart so that they can be drawn. */
export function rangeOf(values: readonly number[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  if (low === high) {
    const half = Math.abs(low) * 0.05 || 0.5;
    return [low - half, high + half];
  }
  return [low, high];
}

/** Check if `a` is at least as good as `b` in all objectives and better in one. */
function dominates(a: TrialEvent, b: TrialEvent, study: TrialsEvent): boolean {
  let better = false;
  for (const [i, name] of study.objectives.entries()) {
    const sign = study.directions[i] === "maximize" ? -1 : 1;
    const left = sign * (a.objectives?.[name] ?? Number.NaN);
    const right = sign * (b.objectives?.[name] ?? Number.NaN);
    if (!(left <= right)) return false;
    if (left < right) better = true;
  }
  return better;
}

/** Numbers of the trials that no other feasible one beats. */
export function frontOf(study: TrialsEvent): Set<number> {
  // Each trial meets only those that stand so far: few, also where thousands were tried.
  let front: TrialEvent[] = [];
  for (const trial of study.trials) {
    if (!trial.feasible || !isDone(trial)) continue;
    if (front.some((other) => dominates(other, trial, study))) continue;
    front = front.filter((other) => !dominates(trial, other, study));
    front.push(trial);
  }
  return new Set(front.map((trial) => trial.index));
}

/** Trials as a league: those that no other beats, the others that count, then infeasible or failed ones. */
export function bestFirst(study: TrialsEvent, front: ReadonlySet<number>): TrialEvent[] {
  const name = study.objectives[0];
  const sign = study.directions[0] === "maximize" ? -1 : 1;
  const league = (trial: TrialEvent) =>
    front.has(trial.index) ? 0 : !isDone(trial) ? 3 : trial.feasible ? 1 : 2;
  const value = (trial: TrialEvent) =>
    name !== undefined && isDone(trial) ? sign * (trial.objectives?.[name] ?? 0) : 0;
  return [...study.trials].sort(
    (a, b) => league(a) - league(b) || value(a) - value(b) || a.index - b.index,
  );
}

/** The best value so far after each feasible trial, in the order of the trials. */
export function bestSoFar(study: TrialsEvent, objective: number): { x: number; y: number }[] {
  const name = study.objectives[objective];
  if (name === undefined) return [];
  const sign = study.directions[objective] === "maximize" ? -1 : 1;
  const steps: { x: number; y: number }[] = [];
  let best = Infinity;
  for (const trial of [...study.trials].sort((a, b) => a.index - b.index)) {
    if (trial.feasible && isDone(trial)) {
      best = Math.min(best, sign * (trial.objectives?.[name] ?? Number.NaN));
    }
    if (best < Infinity) steps.push({ x: trial.index, y: sign * best });
  }
  return steps;
}

export type Brushes = Readonly<Record<string, readonly [number, number]>>;

/** Check if a trial lies within all stretches that are brushed. */
export function within(trial: TrialEvent, axes: readonly Axis[], brushes: Brushes): boolean {
  return axes.every((axis) => {
    const brush = brushes[axis.key];
    if (!brush) return true;
    const value = valueOn(trial, axis);
    return value >= brush[0] && value <= brush[1];
  });
}

/** Number of trials that meet all requirements, of all that there are; failed ones meet none. */
export function remaining(
  trials: readonly TrialEvent[],
  axes: readonly Axis[],
  brushes: Brushes,
): number {
  if (Object.keys(brushes).length === 0) return trials.length;
  return trials.filter((trial) => isDone(trial) && within(trial, axes, brushes)).length;
}

const COMPARISON = /^([\w-]+)\s*(<=|>=|<|>|=)\s*(.+)$/;

/**
 * Check if a trial is meant by a filter such as `ok`, `diverged`, `#12` or `wall > 8 mm`.
 *
 * Several conditions stand with commas between; `read` turns a text with a unit into an SI value.
 */
export function matchesFilter(
  trial: TrialEvent,
  axes: readonly Axis[],
  filter: string,
  read: (text: string, kind: string) => number,
): boolean {
  return filter
    .split(",")
    .map((part) => part.trim().toLowerCase())
    .filter((part) => part !== "")
    .every((part) => {
      const comparison = COMPARISON.exec(part);
      const axis = comparison && axes.find((one) => one.name.toLowerCase() === comparison[1]);
      if (comparison && axis) {
        const value = valueOn(trial, axis);
        const bound = axis.choices
          ? axis.choices.findIndex((word) => word.toLowerCase() === comparison[3])
          : read(comparison[3] ?? "", axis.kind);
        switch (comparison[2]) {
          case "<":
            return value < bound;
          case ">":
            return value > bound;
          case "<=":
            return value <= bound;
          case ">=":
            return value >= bound;
          default:
            return Math.abs(value - bound) <= 1e-9 * Math.max(Math.abs(bound), 1e-12);
        }
      }
      if (/^#\d+$/.test(part)) return trial.index === Number(part.slice(1));
      const words = [trial.status, trial.feasible ? "" : "infeasible", trial.message].join(" ");
      return words.toLowerCase().includes(part);
    });
}

/** Trials as a table for a spreadsheet: SI numbers, their units in its head. */
export function trialsText(trials: readonly TrialEvent[], axes: readonly Axis[]): string {
  const titled = ({ name, kind }: Axis) =>
    siUnit(kind) === "1" ? name : `${name} (${siUnit(kind)})`;
  return tableText(
    ["design", "status", ...axes.map(titled), "seconds", "note"],
    trials.map((trial) => [
      trial.index,
      trial.status,
      ...axes.map((axis) =>
        axis.choices ? describeValue(trial.parameters[axis.name]) : valueOn(trial, axis),
      ),
      trial.seconds,
      trial.message,
    ]),
  );
}
