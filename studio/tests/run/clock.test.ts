import { expect, it } from "vitest";
import { clockText } from "../../src/run/Transport";

it("shows the time of a played motion, and none of a state found without time", () => {
  expect(clockText(null)).toBe("0.000 s");
  expect(clockText({ state: "playing", time: 0.25, untimed: false })).toBe("0.250 s");
  // Motion that has come to rest says when.
  expect(clockText({ state: "at-rest", time: 0.25, untimed: false })).toBe("0.250 s");
  expect(clockText({ state: "at-rest", time: 0.25, untimed: true })).toBe("at rest");
  expect(clockText({ state: "at-rest", time: 0, untimed: false })).toBe("at rest");
  expect(clockText({ state: "diverged", time: 0.25, untimed: true })).toBe("no time");
});
