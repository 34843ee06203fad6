import { describe, expect, it } from "vitest";
import { nextPace, paceName } from "../../src/engine/pace";
import { PACES, type StatEvent } from "../../src/protocol";
import { apply, showAskedPace, useStudio } from "../../src/store/studio";

const stat = (pace: number, choices: number): StatEvent =>
  ({
    t: "stat",
    pace,
    pace_chosen: pace,
    pace_choices: choices,
  }) as Partial<StatEvent> as StatEvent;
const shown = () => useStudio.getState().stat?.pace_chosen;

describe("the pace of time", () => {
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

  it("stays as asked for until it is confirmed, and then follows the engine", () => {
    apply(stat(1 / 50, 1));
    showAskedPace(1 / 10);
    expect(shown()).toBe(1 / 10);
    apply(stat(1 / 50, 1)); // was on its way when the pace was asked for
    expect(shown()).toBe(1 / 10);
    apply(stat(1 / 10, 2));
    apply(stat(1 / 2, 3)); // chosen in another tab
    expect(shown()).toBe(1 / 2);
  });

  it("is not confirmed by the same pace from before", () => {
    apply(stat(1 / 50, 4));
    showAskedPace(1 / 10);
    showAskedPace(1 / 50);
    apply(stat(1 / 50, 4));
    apply(stat(1 / 10, 5));
    expect(shown()).toBe(1 / 50);
    apply(stat(1 / 50, 6));
    apply(stat(1, 7));
    expect(shown()).toBe(1);
  });
});
