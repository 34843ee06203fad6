import { describe, expect, it } from "vitest";
import { nextPace, paceName } from "../src/engine/pace";
import { PACES } from "../src/protocol";

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
});
