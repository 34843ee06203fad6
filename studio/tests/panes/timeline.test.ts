import { describe, expect, it } from "vitest";
import {
  added,
  endOf,
  moved,
  pointsOf,
  rangeOf,
  removed,
  snapped,
  snapStep,
  whole,
  written,
} from "../../src/panes/timeline/points";
import type { HistoryLine } from "../../src/protocol";

const line: HistoryLine = {
  path: ["loads", 0, "history"],
  title: "Pressure",
  used_by: [],
  way: "points",
  words: "",
  times: [0, 0.2, 0.6],
  factors: [0, 1, 0],
  repeat: 1,
  lives: "",
  low: null,
  high: null,
};
const source = { loads: [{ history: { time: ["0 s", "200 ms", "= long"], factor: [0, 1, 0] } }] };
const points = pointsOf(line, source)!;
const values = (some: typeof points | null | undefined) =>
  some?.map(({ time, factor }) => [time, factor]);

describe("points of a history", () => {
  it("are those of the text, and of nothing else", () => {
    expect(values(points)).toEqual([
      [0, 0],
      [0.2, 1],
      [0.6, 0],
    ]);
    expect(pointsOf({ ...line, way: "sine" }, source)).toBeNull();
    expect(pointsOf({ ...line, times: [0, 1] }, source)).toBeNull();
    const many = Array.from({ length: 201 }, (_, i) => i);
    expect(pointsOf({ ...line, times: many, factors: many }, source)).toBeNull();
  });

  it("stay between their neighbors, and within the range of their users", () => {
    expect(moved(points, 1, 5, 2, line)[1]!.time).toBe(0.5999);
    expect(moved(points, 1, -5, 2, line)[1]!.time).toBeGreaterThan(0);
    expect(moved(points, 0, -5, 0, line)[0]!.time).toBe(0);
    const valve = { ...line, low: 0, high: 1 };
    expect(moved(points, 1, 0.2, 3, valve)[1]!.factor).toBe(1);
    expect(moved(points, 1, 0.2, -3, valve)[1]!.factor).toBe(0);
  });

  it("that are formulas stay where the formula puts them", () => {
    expect(moved(points, 2, 0.9, 0.5, line)[2]).toMatchObject({ time: 0.6, factor: 0.5 });
  });

  it("end as they begin where they repeat", () => {
    const breath = { ...line, repeat: 3 };
    const next = moved(points, 0, 0, 0.4, breath);
    expect(values(next)).toEqual([
      [0, 0.4],
      [0.2, 1],
      [0.6, 0.4],
    ]);
    expect(values(removed(points, 2, breath))).toEqual([
      [0, 0],
      [0.2, 0],
    ]);
    expect(added(points, 0.9, 0.7, breath)?.points.at(-1)?.factor).toBe(0);
    expect(removed(points.slice(0, 2), 1, breath)).toBeNull();
  });

  it("are added in order, not on top of each other, and one stays", () => {
    expect(added(points, 0.4, 0.7, line)?.index).toBe(2);
    expect(added(points, 0.2, 0.7, line)).toBeNull();
    expect(added(points, 0.4, 7, { ...line, high: 1 })?.points[2]?.factor).toBe(1);
    expect(removed(points.slice(0, 1), 0, line)).toBeNull();
  });
});

describe("the text of a history", () => {
  it("keeps untouched points, and the unit of touched ones", () => {
    const next = moved(points, 1, 0.3, 0.5, line);
    expect(written(line, next)).toEqual([
      { path: ["loads", 0, "history", "time"], value: ["0 s", "300 ms", "= long"] },
      { path: ["loads", 0, "history", "factor"], value: [0, 0.5, 0] },
    ]);
  });

  it("gives a zero the unit of the others, and a new point that of the one before", () => {
    const zero = {
      loads: [{ history: { time: [0, "200 ms", "600 ms"], factor: [0, "50 %", 0] } }],
    };
    const some = pointsOf({ ...line, factors: [0, 0.5, 0] }, zero)!;
    const [times, factors] = written(line, moved(moved(some, 0, 0.1, 0, line), 1, 0.2, 0.6, line));
    expect(times?.value).toEqual(["100 ms", "200 ms", "600 ms"]);
    expect(factors?.value).toEqual([0, "60 %", 0]);
    const more = added(points, 0.4, 1, line)!.points;
    expect(written(line, more)[0]?.value).toEqual(["0 s", "200 ms", "400 ms", "= long"]);
  });
});

describe("the axes", () => {
  it("snap to round steps, and finer to a tenth of them", () => {
    expect(snapStep(1, false)).toBeCloseTo(0.05);
    expect(snapStep(1, true)).toBeCloseTo(0.005);
    expect(snapped(0.1234, 0.05)).toBe(0.1);
  });

  it("end beyond the last instant of all repeats, and of a run", () => {
    expect(endOf([{ ...line, repeat: 3 }], null)).toBeCloseTo(1.08 * 1.8);
    expect(endOf([line], 5)).toBeCloseTo(5.4);
    expect(endOf([], null)).toBe(1);
  });

  it("show zero and one, and values beyond", () => {
    expect(rangeOf([0, 1])[0]).toBeLessThan(0);
    expect(rangeOf([0, 2])[1]).toBeGreaterThan(2);
    expect(rangeOf([-1, 0])[0]).toBeLessThan(-1);
  });

  it("draw every repeat", () => {
    expect(whole([0, 1, 2], [0, 1, 0], 2)).toEqual([
      [0, 1, 2, 3, 4],
      [0, 1, 0, 1, 0],
    ]);
  });
});
