import { describe, expect, it } from "vitest";
import { importanceOf, mostImportant } from "../../src/panes/study/atlas/importance";
import { longestSide, sizeIn } from "../../src/panes/study/atlas/pictures";
import { placed } from "../../src/panes/study/atlas/places";
import { type Axis, axesOf, rangeText, remaining } from "../../src/panes/study/trials";
import type { TrialEvent, TrialsEvent } from "../../src/protocol";

/** Designs of two parameters, of which `wall` decides the rise and `cap` next to nothing. */
function trial(index: number, wall: number, cap: number, rise: number | null): TrialEvent {
  return {
    t: "trial",
    job: "s",
    index,
    parameters: { cap, wall },
    objectives: rise === null ? null : { rise },
    metrics: rise === null ? {} : { mass: 0.1 * wall },
    status: rise === null ? "diverged" : "ok",
    seconds: 0.1,
    feasible: rise !== null,
    front: false,
    message: rise === null ? "it burst" : "",
  };
}

const TRIALS = [
  trial(0, 0.001, 0.002, 0.009),
  trial(1, 0.001, 0.004, 0.0088),
  trial(2, 0.002, 0.002, 0.005),
  trial(3, 0.002, 0.004, 0.0049),
  trial(4, 0.003, 0.002, 0.002),
  trial(5, 0.003, 0.004, 0.0021),
  trial(6, 0.0005, 0.002, null),
];
const STUDY: TrialsEvent = {
  t: "trials",
  job: "s",
  parameters: ["cap", "wall"],
  objectives: ["rise"],
  directions: ["maximize"],
  kinds: { cap: "length", wall: "length", rise: "length", mass: "mass" },
  constraints: [],
  space: {},
  trials: TRIALS,
};
const AXES = axesOf(STUDY);
const axis = (name: string) => AXES.find((one) => one.name === name) as Axis;

describe("importance", () => {
  it("is the share of the variance that a parameter explains", () => {
    expect(importanceOf(TRIALS, axis("wall"), axis("rise"))).toBeCloseTo(0.999, 2);
    expect(importanceOf(TRIALS, axis("cap"), axis("rise"))).toBeLessThan(0.01);
  });

  it("chooses the parameter that decides, though another stands first", () => {
    expect(mostImportant(TRIALS, AXES)?.name).toBe("wall");
  });

  it("chooses the first parameter where nothing can be told", () => {
    expect(mostImportant([trial(0, 1, 1, 1)], AXES)?.name).toBe("cap");
  });

  it("puts many values in bins, so that single values explain nothing by themselves", () => {
    const noise = Array.from({ length: 64 }, (_, i) => trial(i, i, 1, Math.sin(37 * i) + 2));
    expect(importanceOf(noise, axis("wall"), axis("rise"))).toBeLessThan(0.3);
  });
});

describe("requirements", () => {
  it("leave those that meet all of them, and no failed one", () => {
    expect(remaining(TRIALS, AXES, {})).toBe(7);
    const brushes = { "objective:rise": [0.004, Infinity] as const };
    expect(remaining(TRIALS, AXES, brushes)).toBe(4);
    expect(remaining(TRIALS, AXES, { ...brushes, "metric:mass": [-Infinity, 0.00015] })).toBe(2);
    expect(remaining(TRIALS, AXES, { "parameter:wall": [-Infinity, Infinity] })).toBe(6);
  });

  it("are said in words", () => {
    expect(rangeText(axis("rise"), [-Infinity, Infinity])).toBe("any");
    expect(rangeText(axis("rise"), [0.004, Infinity])).toBe("at least 4 mm");
    expect(rangeText(axis("rise"), [0.004, 0.005])).toBe("4 mm to 5 mm");
  });
});

describe("map", () => {
  const box = { left: 100, right: 500, top: 50, bottom: 350, rail: 80 };
  const map = placed(TRIALS, axis("wall"), axis("rise"), box);
  const at = (index: number) => map.places.find((place) => place.trial.index === index);

  it("puts trials at their values, larger ones to the right and up", () => {
    expect(at(4)?.x).toBeGreaterThan(at(0)?.x ?? 0);
    expect(at(0)?.y).toBeLessThan(at(4)?.y ?? 0);
    for (const { x, y } of map.places) {
      expect(x).toBeGreaterThanOrEqual(100);
      expect(x).toBeLessThanOrEqual(500);
      expect(y).toBeGreaterThanOrEqual(50);
      expect(y).toBeLessThanOrEqual(350);
    }
  });

  it("puts a failed trial at its parameter, below all that have an objective", () => {
    expect(at(6)?.y).toBe(350);
    expect(Math.max(...[0, 1, 2, 3, 4, 5].map((i) => at(i)?.y ?? 0))).toBeLessThan(270);
    expect(at(6)?.x).toBeLessThan(at(0)?.x ?? 0);
  });
});

describe("a map of few columns", () => {
  const box = { left: 40, right: 760, top: 40, bottom: 360, rail: 80 };

  it("sets designs that would cover each other side by side in their column, the best in its middle", () => {
    const alike = [0, 1, 2, 3].flatMap((i) => [trial(2 * i, 1, 1, 5), trial(2 * i + 1, 2, 1, 5)]);
    const { places } = placed(alike, axis("wall"), axis("rise"), box);
    const [first, second] = [0, 1].map((odd) =>
      places.filter((one) => one.trial.index % 2 === odd),
    );
    const xs = (column: typeof first) => column?.map(({ x }) => x) ?? [];
    expect(new Set(xs(first)).size).toBe(4);
    expect(Math.max(...xs(first))).toBeLessThan(Math.min(...xs(second)));
    expect(first?.[0]?.x).toBeCloseTo(40 + 720 / 4, 6);
    // The place of their values is kept, to draw a line from there.
    for (const { atX } of first ?? []) expect(atX).toBeCloseTo(40 + 720 / 4, 6);
  });

  it("leaves designs of as many values where they are", () => {
    const many = Array.from({ length: 30 }, (_, i) => trial(i, i, 1, 5));
    const map = placed(many, axis("wall"), axis("rise"), box);
    expect(map.places.map(({ x }) => x)).toEqual(many.map((_, i) => map.toX(i)));
  });
});

describe("pictures", () => {
  it("have one scale, so that a smaller design is drawn smaller", () => {
    const [small, large] = [
      { url: "a", atRest: true, width: 0.01, height: 0.02, failure: "" },
      { url: "b", atRest: true, width: 0.04, height: 0.02, failure: "" },
    ];
    const longest = longestSide([small, large]);
    expect(longest).toBe(0.04);
    expect(sizeIn(80, small, longest)).toEqual({ width: 20, height: 40 });
    expect(sizeIn(80, large, longest)).toEqual({ width: 80, height: 40 });
    expect(sizeIn(80, small, 0)).toEqual({ width: 40, height: 80 });
    expect(sizeIn(80, { width: 0, height: 0 }, longest)).toEqual({ width: 80, height: 80 });
  });
});
