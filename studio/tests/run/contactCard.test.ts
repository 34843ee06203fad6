import { expect, it } from "vitest";
import type { Touch } from "../../src/protocol";
import { forceOf, frictionOf, isSmooth } from "../../src/run/ContactCard";
import { holdOf } from "../../src/run/hold";

const touch = (first: string, second: string): Touch => ({
  ...{ of: [first, second], force: [0, 3, 4], pressed: 12, area: 1e-6, gap: 0, slipping: 0 },
  ...{ friction: 3, bound: 4 },
});

it("gives the force on the first, and of the body on itself all that presses", () => {
  expect(forceOf(touch("body", "plate"))).toBe(5);
  expect(forceOf(touch("body", "body"))).toBe(12);
});

it("says how much of the friction is used", () => {
  expect(frictionOf(touch("body", "plate"))).toBe("3 N of 4 N (75 %)");
  const none = { ...touch("body", "plate"), friction: 1e-9, bound: 0 };
  expect(frictionOf(none)).toContain("(0 %)");
});

it("calls a surface without friction smooth, and a bond not", () => {
  const pair = touch("body", "plate");
  expect(isSmooth({ ...pair, bound: 0, slipping: 1 })).toBe(true);
  expect(isSmooth({ ...pair, bound: 0, slipping: 0 })).toBe(false);
  expect(isSmooth({ ...pair, slipping: 1 })).toBe(false);
});

it("says whether surfaces hold", () => {
  expect([0, 0.01, 0.25, 0.99, 1].map(holdOf)).toEqual([
    ...["sticks", "sticks", "25 % slips", "slips", "slips"],
  ]);
});
