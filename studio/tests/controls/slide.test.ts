import { expect, it } from "vitest";
import { isOnStep, stepToward } from "../../src/controls/slide";

it("knows values that stand on a step", () => {
  expect(isOnStep(0.005, 0.0025, 0.0025)).toBe(true);
  expect(isOnStep(0.00375, 0.0025, 0.0025)).toBe(false);
  expect(isOnStep(0.1 + 0.2, 0, 0.1)).toBe(true);
});

it("moves from between two steps to the next one in the direction of the hand", () => {
  const wall = { min: 0.0025, step: 0.0025 };
  expect(stepToward(0.0031, 0.003, wall.min, wall.step)).toBe(0.005);
  expect(stepToward(0.0029, 0.003, wall.min, wall.step)).toBe(0.0025);
  expect(stepToward(0.005, 0.003, wall.min, wall.step)).toBe(0.005);
});
