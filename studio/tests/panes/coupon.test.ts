import { expect, it } from "vitest";
import { chartOf } from "../../src/panes/coupon/curves";
import type { CouponFitEvent, CouponModel } from "../../src/protocol";

const MODEL: CouponModel = {
  ...{ name: "yeoh-2", size: 2, error: 1, largest: 2, young: 3, low: 2, high: 4 },
  ...{ stresses: [[1e3, 2e3], [3e3]], table: {}, refused: "", warnings: [] },
};
const FIT: CouponFitEvent = {
  t: "coupon_fit",
  name: "mine",
  curves: [
    { name: "a", mode: "uniaxial", strain: [0.1, 0.3], stress: [1100, 2100] },
    { name: "b", mode: "planar", strain: [0.2], stress: [3100] },
  ],
  models: [MODEL],
  recommended: "yeoh-2",
  rejected: [],
};

it("draws the model over the measured points of each mode, in the order of the strain", () => {
  const { series, data } = chartOf(FIT, MODEL);
  expect(series.map(({ label }) => label)).toEqual([
    "a",
    "b",
    "yeoh-2, uniaxial",
    "yeoh-2, planar",
  ]);
  expect(data[0]).toEqual([10, 20, 30]);
  expect(data[1]).toEqual([1.1, Number.NaN, 2.1]);
  expect(data[3]).toEqual([1, Number.NaN, 2]);
  expect(data[4]).toEqual([Number.NaN, 3, Number.NaN]);
});
