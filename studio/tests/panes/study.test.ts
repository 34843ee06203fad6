import { describe, expect, it } from "vitest";
import { compare } from "../../src/controls/Table";
import { project } from "../../src/panes/study/chart/space";
import { ticks } from "../../src/panes/study/chart/ticks";
import type { StudyDraft } from "../../src/panes/study/draft";
import {
  choices,
  countOf,
  gridSize,
  obstacle,
  samplerOf,
  studySpec,
} from "../../src/panes/study/setup";
import {
  axesOf,
  bestFirst,
  bestSoFar,
  brokenBy,
  frontOf,
  matchesFilter,
  rangeOf,
  reasonOf,
  textOn,
  trialsText,
  valueOn,
  within,
} from "../../src/panes/study/trials";
import type { Parameter, TrialEvent, TrialsEvent } from "../../src/protocol";

function parameter(name: string, given: Partial<Parameter> = {}): Parameter {
  return {
    name,
    value: 0.01,
    kind: "length",
    text: "10 mm",
    min: null,
    max: null,
    step: null,
    display_unit: "mm",
    former: null,
    factor: 1e-3,
    formula: false,
    description: "",
    ...given,
  };
}

const DRAFT: StudyDraft = {
  name: " arm ",
  sampler: "grid",
  budget: 10,
  workers: null,
  seed: 3,
  chosen: {},
  ranges: {},
};
const SAMPLERS = [
  { name: "grid", title: "", single_objective: false },
  { name: "cma-es", title: "", single_objective: true },
  { name: "gradient", title: "", single_objective: true },
];
const RANGED = parameter("wall", { min: 0.005, max: 0.015, step: 0.005 });

describe("setup", () => {
  it("varies values with a range, not formulas, and counts the values of a step", () => {
    const all = choices([RANGED, parameter("cap"), parameter("f", { formula: true })], DRAFT);
    expect(all.map((one) => [one.parameter.name, one.on])).toEqual([
      ["wall", true],
      ["cap", false],
    ]);
    // 5, 10 and 15 mm, though 0.015 - 0.005 is not exactly twice 0.005 in binary.
    expect(countOf({ low: 0.005, high: 0.015, step: 0.005, log: false })).toBe(3);
    expect(gridSize(all.filter((one) => one.on))).toBe(3);
  });
  it("asks for the chosen study", () => {
    const draft = { ...DRAFT, chosen: { cap: true }, ranges: { cap: { high: 0.02 } } };
    const spec = studySpec(choices([RANGED, parameter("cap")], draft), draft);
    expect(spec).toMatchObject({ kind: "study", name: "arm", sampler: "grid", seed: 3 });
    expect(spec.space).toEqual({
      wall: { low: 0.005, high: 0.015, step: 0.005, log: false },
      cap: { low: 0.005, high: 0.02, step: null, log: false },
    });
  });
  it("tries all designs where they are few, and searches where not, unless told", () => {
    const open = { ...DRAFT, sampler: null };
    const few = choices([RANGED], open);
    expect(samplerOf(few, open)).toBe("grid");
    expect(studySpec(few, open).sampler).toBe("grid");
    const fine = { ...open, ranges: { wall: { step: 1e-6 } } };
    expect(samplerOf(choices([RANGED], fine), fine)).toBe("tpe");
    const free = { ...open, ranges: { wall: { step: null } } };
    expect(samplerOf(choices([RANGED], free), free)).toBe("tpe");
    expect(samplerOf(few, { ...open, sampler: "random" })).toBe("random");
  });
  it("says why a study cannot start", () => {
    const ranged = choices([RANGED], DRAFT);
    expect(obstacle(ranged, 1, DRAFT, SAMPLERS)).toBeNull();
    expect(obstacle(ranged, 0, DRAFT, SAMPLERS)).toMatch(/objective/);
    const along = { ...DRAFT, sampler: "gradient" };
    const why = { gradient: "bodies are not known to gradients yet: solve one of them." };
    expect(obstacle(ranged, 1, DRAFT, SAMPLERS, why)).toBeNull();
    expect(obstacle(ranged, 1, along, SAMPLERS, why)).toBe(why.gradient);
    expect(obstacle(choices([parameter("cap")], DRAFT), 1, DRAFT, SAMPLERS)).toMatch(
      /at least one/,
    );
    const free = { ...DRAFT, chosen: { cap: true } };
    expect(obstacle(choices([parameter("cap")], free), 1, free, SAMPLERS)).toMatch(/needs a step/);
    const several = { ...DRAFT, sampler: "cma-es" };
    expect(obstacle(ranged, 2, several, SAMPLERS)).toMatch(/one objective/);
    const stepped = { ...DRAFT, sampler: "gradient" };
    expect(obstacle(ranged, 1, stepped, SAMPLERS)).toMatch(/without steps/);
    const turned = { ...DRAFT, ranges: { wall: { low: 0.02 } } };
    expect(obstacle(choices([RANGED], turned), 1, turned, SAMPLERS)).toMatch(/low end/);
  });
});

function trial(index: number, wall: unknown, rise: number | null, given = {}): TrialEvent {
  return {
    t: "trial",
    job: "s",
    index,
    parameters: { wall },
    objectives: rise === null ? null : { rise, weight: 1 / rise },
    metrics: { mass: index },
    status: rise === null ? "diverged" : "ok",
    seconds: 1,
    feasible: rise !== null,
    front: false,
    message: rise === null ? "blew up at 0.3 s" : "",
    ...given,
  };
}
const STUDY: TrialsEvent = {
  t: "trials",
  job: "s",
  parameters: ["wall"],
  objectives: ["rise", "weight"],
  directions: ["maximize", "minimize"],
  kinds: { wall: "length", rise: "length", weight: "mass", mass: "mass" },
  constraints: [],
  space: {},
  trials: [
    trial(2, 0.01, 0.002),
    trial(0, 0.005, 0.001),
    trial(1, 0.015, null),
    trial(3, 0.015, 0.009, { feasible: false }),
  ],
};

describe("constraints", () => {
  const limited: TrialsEvent = {
    ...STUDY,
    kinds: { ...STUDY.kinds, limit: "mass" },
    constraints: [{ name: "limit", metric: "mass", min: null, max: 0.0015 }],
    trials: STUDY.trials.map((one) => ({
      ...one,
      metrics: { mass: one.index / 1000, limit: one.index / 1000 },
    })),
  };
  const axes = axesOf(limited);

  it("are columns, in place of the metric that they bound", () => {
    const limit = axes.find((axis) => axis.name === "limit");
    expect(limit).toMatchObject({ role: "constraint", allowed: [-Infinity, 0.0015] });
    expect(axes.some((axis) => axis.name === "mass")).toBe(false);
  });

  it("say why a design is not allowed", () => {
    const [broken, kept, failed] = limited.trials;
    expect(reasonOf(broken as TrialEvent, axes)).toBe("limit is 2 g, at most 1.5 g");
    expect(reasonOf(kept as TrialEvent, axes)).toBe("");
    expect(reasonOf(failed as TrialEvent, axes)).toBe("");
  });

  it("are broken by a value that is not known", () => {
    const unknown = { ...(limited.trials[1] as TrialEvent), metrics: { limit: null } };
    expect(brokenBy(unknown, axes).map((axis) => axis.name)).toEqual(["limit"]);
  });
});

describe("ranges of a study", () => {
  const tried = { wall: { low: 0.004, high: 0.006, step: 0.001, log: false } };

  it("stand again where the study is shown", () => {
    const all = choices([RANGED, parameter("cap", { min: 0, max: 1 })], DRAFT, tried);
    expect(all.map((one) => [one.on, one.sweep.low, one.sweep.high])).toEqual([
      [true, 0.004, 0.006],
      [false, 0, 1],
    ]);
  });

  it("give way to those that were typed since", () => {
    const draft = { ...DRAFT, ranges: { wall: { high: 0.02 } } };
    expect(choices([RANGED], draft, tried)[0]?.sweep).toMatchObject({ low: 0.004, high: 0.02 });
  });

  it("of another design do not count", () => {
    const other = { radius: tried.wall };
    expect(choices([RANGED], DRAFT, other)[0]?.sweep).toMatchObject({ low: 0.005, high: 0.015 });
  });
});

describe("trials", () => {
  const axes = axesOf(STUDY);
  it("has an axis for each parameter, objective and other metric", () => {
    expect(axes.map((axis) => axis.key)).toEqual([
      "parameter:wall",
      "objective:rise",
      "objective:weight",
      "metric:mass",
    ]);
    expect(valueOn(STUDY.trials[2] as TrialEvent, axes[1] as never)).toBeNaN();
    expect(textOn(0.012, axes[0] as never)).toBe("12 mm");
  });
  it("copies designs with the units of their columns, why they failed, and words as they are", () => {
    const failed = trial(1, 0.015, null);
    expect(trialsText([failed], axesOf({ ...STUDY, trials: [failed] }))).toBe(
      "design\tstatus\twall (m)\trise (m)\tweight (kg)\tmass (kg)\tseconds\tnote\n" +
        "1\tdiverged\t0.015\t\t\t1\t1\tblew up at 0.3 s\n",
    );
    const soft = trial(0, "soft", 1, { message: "two\tlines\nhere" });
    const copied = trialsText([soft], axesOf({ ...STUDY, trials: [soft] }));
    expect(copied).toContain("\tsoft\t1\t1\t");
    expect(copied).toContain("two lines here\n");
  });
  it("puts choices that are no numbers in order", () => {
    const words = { ...STUDY, trials: [trial(0, "soft", 1), trial(1, "firm", 2)] };
    const axis = axesOf(words)[0];
    expect(axis?.choices).toEqual(["firm", "soft"]);
    expect(valueOn(words.trials[0] as TrialEvent, axis as never)).toBe(1);
  });
  it("finds the best and the front among designs that are allowed", () => {
    // Design 2 rises more and weighs less than 0; 3 would be better but breaks a constraint.
    expect([...frontOf(STUDY)]).toEqual([2]);
    expect(bestSoFar(STUDY, 0)).toEqual([
      { x: 0, y: 0.001 },
      { x: 1, y: 0.001 },
      { x: 2, y: 0.002 },
      { x: 3, y: 0.002 },
    ]);
  });
  it("keeps equals on the front, and takes off trials that a later one beats", () => {
    const one = (index: number, rise: number, weight: number) => ({
      ...trial(index, 0.01, 1),
      objectives: { rise, weight },
    });
    const trials = [one(0, 1, 1), one(1, 2, 2), one(2, 2, 2), one(3, 3, 2), one(4, 0, 3)];
    expect([...frontOf({ ...STUDY, trials })]).toEqual([0, 3]);
    expect([...frontOf({ ...STUDY, trials: trials.slice(0, 3) })]).toEqual([0, 1, 2]);
  });
  it("lists the best first, then infeasible trials, then failed ones", () => {
    const league = bestFirst(STUDY, frontOf(STUDY)).map((one) => one.index);
    expect(league).toEqual([2, 0, 3, 1]);
  });
  it("keeps brushed trials", () => {
    const kept = STUDY.trials.filter((one) =>
      within(one, axes, { "parameter:wall": [0.004, 0.012] }),
    );
    expect(kept.map((one) => one.index)).toEqual([2, 0]);
  });
  it("filters by words, numbers and comparisons with units", () => {
    const read = (text: string) => Number.parseFloat(text) * 1e-3;
    const found = (filter: string) =>
      STUDY.trials.filter((one) => matchesFilter(one, axes, filter, read)).map((one) => one.index);
    expect(found("diverged")).toEqual([1]);
    expect(found("blew")).toEqual([1]);
    expect(found("#3")).toEqual([3]);
    expect(found("wall >= 10 mm, ok")).toEqual([2, 3]);
    expect(found("wall = 15 mm")).toEqual([1, 3]);
    expect(found("rise < 1.5 mm")).toEqual([0]);
    expect(found("infeasible")).toEqual([1, 3]);
    expect(found("")).toHaveLength(4);
  });
});

it("spreads a range of one value, and skips text that is no number", () => {
  expect(rangeOf([2, Number.NaN, 4])).toEqual([2, 4]);
  expect(rangeOf([0])).toEqual([-0.5, 0.5]);
  expect(rangeOf([])).toEqual([0, 1]);
});

it("puts ticks on round numbers", () => {
  expect(ticks(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
  expect(ticks(-3.1, 8, 4)).toEqual([0, 5]);
  expect(ticks(1, 1, 4)).toEqual([1]);
});

it("draws near bodies larger, and up as up", () => {
  const turn = { around: 0, above: 0, zoom: 1 };
  const top = project([0, 0, 1], turn, 200, 100);
  expect(top.x).toBeCloseTo(100);
  expect(top.y).toBeLessThan(50);
  const [near, far] = [project([1, -1, 0], turn, 200, 100), project([1, 1, 0], turn, 200, 100)];
  expect(near.near).toBeGreaterThan(far.near);
  expect(near.x).toBeGreaterThan(far.x);
});

it("sorts rows without a value to the end, up and down", () => {
  const rows = [2, null, 1, 3];
  expect([...rows].sort((a, b) => compare(a, b, 1))).toEqual([1, 2, 3, null]);
  expect([...rows].sort((a, b) => compare(a, b, -1))).toEqual([3, 2, 1, null]);
});
