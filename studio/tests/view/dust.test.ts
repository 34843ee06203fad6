import { expect, it } from "vitest";
import type { Frame } from "../../src/engine/frames";
import { withoutDust } from "../../src/view/body/dust";

const frame = (min: number, max: number) => ({ kind: "frame", min, max }) as Frame;

it("takes rounding errors of zero for zero", () => {
  expect(withoutDust(frame(0, 1.46e-13), "Pa")).toMatchObject({ min: 0, max: 0 });
  expect(withoutDust(frame(0, 1.16e-29), "J/m^3")).toMatchObject({ min: 0, max: 0 });
  expect(withoutDust(frame(-1e-18, 1e-18), "m")).toMatchObject({ min: 0, max: 0 });
});

it("keeps small true values, also beside large ones", () => {
  for (const [min, max, unit] of [
    [0, 1e-5, "Pa"],
    [-1e-12, 5000, "Pa"],
    [0, 1e-10, "m"],
    [1 - 1e-16, 1, ""],
  ] as const) {
    const given = frame(min, max);
    expect(withoutDust(given, unit)).toBe(given);
  }
});
