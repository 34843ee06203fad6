import { describe, expect, it } from "vitest";
import { brokenCount, commonVoxel } from "../../../src/panes/design/parameters/onGrid";

describe("a length on voxels", () => {
  it("is whole, also where binary numbers are not", () => {
    expect(brokenCount(0.0075, 0.0025)).toBeNull();
    expect(brokenCount(3 * 0.1e-3, 0.1e-3)).toBeNull();
    expect(brokenCount(0, 0.005)).toBeNull();
  });
  it("is broken", () => {
    expect(brokenCount(0.00375, 0.0025)).toBeCloseTo(1.5, 9);
    expect(brokenCount(-0.00375, 0.0025)).toBeCloseTo(1.5, 9);
  });
});

describe("the voxel of all lengths", () => {
  it("is their largest divisor up to the present voxel", () => {
    expect(commonVoxel([0.00375, 0.0125, 0.02], 0.0025)).toBeCloseTo(0.00125, 12);
    expect(commonVoxel([0.01, 0.02], 0.004)).toBeCloseTo(0.0025, 12);
  });
  it("is none that makes far more voxels, and none of nothing", () => {
    expect(commonVoxel([0.0037, 0.0125], 0.0025)).toBeNull();
    expect(commonVoxel([], 0.0025)).toBeNull();
    expect(commonVoxel([0], 0.0025)).toBeNull();
  });
});
