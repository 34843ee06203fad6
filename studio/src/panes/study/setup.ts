// Conversion of the pane's choices to the study command.
import type { Parameter, Sampler, SpaceRange, StudySpec, TriedRange } from "../../protocol";
import type { StudyDraft, Sweep } from "./draft";

/** A parameter that a study may vary, as it is set up now. */
export interface Choice {
  readonly parameter: Parameter;
  readonly on: boolean;
  readonly sweep: Sweep;
  /** Why it cannot be varied like this. */
  readonly problem: string | null;
}

/** The range that the design gives, or one around the value where it gives none. */
function usualSweep(parameter: Parameter): Sweep {
  const size = Math.abs(parameter.value) || parameter.factor;
  return {
    low: parameter.min ?? parameter.value - size / 2,
    high: parameter.max ?? parameter.value + size / 2,
    step: parameter.step,
    log: false,
  };
}

/**
 * All parameters with a value of their own, with the ranges that were given by hand, else those of
 * the shown study if it varied parameters of this design, else the usual ones. Those of the study,
 * or with a range where there is none, are on unless switched off.
 */
export function choices(
  parameters: readonly Parameter[],
  draft: StudyDraft,
  tried: Readonly<Record<string, TriedRange>> = {},
): Choice[] {
  const names = new Set(parameters.map(({ name }) => name));
  const varied = Object.keys(tried);
  const known = varied.length > 0 && varied.every((name) => names.has(name));
  return parameters
    .filter((parameter) => !parameter.formula)
    .map((parameter) => {
      const { name } = parameter;
      const before = known ? tried[name] : undefined;
      const sweep = { ...usualSweep(parameter), ...before, ...draft.ranges[name] };
      const ranged = parameter.min !== null && parameter.max !== null;
      return {
        parameter,
        on: draft.chosen[name] ?? (known ? before !== undefined : ranged),
        sweep,
        problem: problemOf(sweep),
      };
    });
}

function problemOf(sweep: Sweep): string | null {
  if (!(sweep.low < sweep.high)) return "the low end must lie below the high end";
  if (sweep.step !== null && !(sweep.step > 0)) return "a step must be positive";
  if (sweep.log && sweep.low <= 0) return "a range in decades must be positive";
  return null;
}

/** Number of values of a range by its steps; null where it has none. */
export function countOf(sweep: Sweep): number | null {
  if (sweep.step === null || !(sweep.step > 0) || !(sweep.high > sweep.low)) return null;
  return Math.floor((sweep.high - sweep.low) / sweep.step + 1e-9) + 1;
}

/** Number of designs of a grid; null where a range has no step. */
export function gridSize(chosen: readonly Choice[]): number | null {
  let size = 1;
  for (const { sweep } of chosen) {
    const count = countOf(sweep);
    if (count === null) return null;
    size *= count;
  }
  return size;
}

// Up to here a grid is solved as quickly as a search, and misses nothing.
const SMALL_GRID = 200;

/** The sampler that was chosen; else all designs where they are few, and a search where not. */
export function samplerOf(chosen: readonly Choice[], draft: StudyDraft): string {
  if (draft.sampler !== null) return draft.sampler;
  const size = gridSize(chosen);
  return size !== null && size <= SMALL_GRID ? "grid" : "tpe";
}

/** Why the study cannot be started, in words with a remedy; null where it can. */
export function obstacle(
  all: readonly Choice[],
  objectives: number,
  draft: StudyDraft,
  samplers: readonly Sampler[],
  refused: Readonly<Record<string, string>> = {},
): string | null {
  const chosen = all.filter((one) => one.on);
  const name = samplerOf(chosen, draft);
  const sampler = samplers.find((one) => one.name === name);
  if (chosen.length === 0) return "Choose at least one parameter to vary.";
  const wrong = chosen.find((one) => one.problem);
  if (wrong) return `${wrong.parameter.name}: ${wrong.problem}.`;
  if (objectives === 0) return "Add an objective: what to make as large or as small as possible.";
  if (sampler?.single_objective && objectives > 1) {
    return `${sampler.name} takes one objective; choose tpe or nsga-ii for several.`;
  }
  if (name === "grid") {
    const without = chosen.find((one) => countOf(one.sweep) === null);
    if (without) return `${without.parameter.name}: a grid needs a step.`;
  } else if (!(draft.budget >= 1)) return "Give a budget of at least one design.";
  if (name === "gradient" && refused.gradient) return refused.gradient;
  if (name === "gradient" && chosen.some((one) => one.sweep.step !== null)) {
    return "gradient needs ranges without steps; empty their steps.";
  }
  return null;
}

/** The study to ask for. */
export function studySpec(all: readonly Choice[], draft: StudyDraft): StudySpec {
  const space: Record<string, SpaceRange> = {};
  for (const { parameter, on, sweep } of all) {
    if (on) space[parameter.name] = { ...sweep };
  }
  return {
    kind: "study",
    sampler: samplerOf(
      all.filter((one) => one.on),
      draft,
    ),
    budget: Math.round(draft.budget),
    seed: Math.round(draft.seed),
    workers: draft.workers,
    space,
    ...(draft.name.trim() ? { name: draft.name.trim() } : {}),
  };
}
