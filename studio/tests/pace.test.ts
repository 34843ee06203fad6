import { describe, expect, it } from "vitest";
import { nextPace, paceFor, paceName, RealTimeFactor } from "../src/engine/pace";
import { PACES } from "../src/protocol";

describe("the pace of time", () => {
  it("is real time for what lasts, and slower for what does not", () => {
    expect([3, 0.6, 0.05, 1e-6].map(paceFor)).toEqual([1, 1 / 2, 1 / 50, 1 / 200]);
  });

  it("has names that can be read", () => {
    expect(PACES.map(paceName)).toEqual(["1×", "1/2", "1/5", "1/10", "1/50", "1/200"]);
  });

  it("goes by steps and stops at its ends", () => {
    expect(nextPace(1, 1)).toBe(1 / 2);
    expect(nextPace(1 / 50, -1)).toBe(1 / 10);
    expect(nextPace(1, -1)).toBe(1);
    expect(nextPace(1 / 200, 1)).toBe(1 / 200);
    expect(nextPace(1 / 20, 1)).toBe(1 / 200); // between two of the list: the next slower ones
  });

  it("is measured against the clock", () => {
    const factor = new RealTimeFactor();
    expect(factor.value).toBe(0);
    for (let tick = 0; tick < 200; tick++) factor.mark((0.02 * tick) / 60, (1000 * tick) / 60);
    expect(factor.value).toBeCloseTo(0.02, 9);
    factor.restart();
    expect(factor.value).toBe(0);
  });
});
