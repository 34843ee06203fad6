import { expect, it } from "vitest";
import type { Touch } from "../src/protocol";
import { forceOf, holdOf } from "../src/run/ContactCard";

const touch = (first: string, second: string): Touch => ({
  ...{ of: [first, second], force: [0, 3, 4], pressed: 12, area: 1e-6, gap: 0, slipping: 0 },
});

it("gives the force on the first, and of the body on itself all that presses", () => {
  expect(forceOf(touch("body", "plate"))).toBe(5);
  expect(forceOf(touch("body", "body"))).toBe(12);
});

it("says whether surfaces hold", () => {
  expect([0, 0.01, 0.25, 0.99, 1].map(holdOf)).toEqual([
    ...["sticks", "sticks", "25 % slips", "slips", "slips"],
  ]);
});
