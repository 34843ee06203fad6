import { describe, expect, it } from "vitest";
import { decadeName, decades, tickSpace } from "../../src/controls/axes";

// The steps between ticks that uPlot has, and those ticks of a range that it then draws.
function ticks(range: number, pixels: number): number {
  const steps = [-3, -2, -1, 0, 1].flatMap((p) => [1, 2, 2.5, 5].map((m) => m * 10 ** p));
  const step = steps.find((one) => (one / range) * pixels >= tickSpace(pixels)) as number;
  return Math.floor(range / step) + 1;
}

describe("axes of plots", () => {
  it("have two ticks also where they are narrow", () => {
    for (const pixels of [110, 150, 180, 240, 400]) {
      for (const range of [0.036, 0.05, 0.0999, 0.21, 0.39, 0.7, 3.9]) {
        expect(ticks(range, pixels), `${range} s on ${pixels} px`).toBeGreaterThanOrEqual(2);
      }
    }
  });

  it("name powers of ten, as many as there is room for", () => {
    expect(decades(1e-4, 1, 200)).toHaveLength(5);
    expect(decades(1e-4, 1, 50)).toEqual([1e-4, 1e-2, 1].map((x) => expect.closeTo(x, 12)));
    expect(decades(1e-9, 100, 30)).toHaveLength(2);
    expect([1e-9, 1e-4, 0.01, 1, 100, 1e6].map(decadeName)).toEqual([
      "10⁻⁹",
      "10⁻⁴",
      "0.01",
      "1",
      "100",
      "10⁶",
    ]);
  });
});
