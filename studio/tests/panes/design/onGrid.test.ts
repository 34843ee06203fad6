import { describe, expect, it } from "vitest";
import {
  brokenCount,
  commonVoxel,
  namesOfShapes,
} from "../../../src/panes/design/parameters/onGrid";

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

describe("lengths of shapes", () => {
  it("are those of their formulas, at any depth, and no way of a clamp", () => {
    const source = {
      parameters: {
        wall: { value: "3 mm" },
        gap: "1 mm",
        whole: { value: "= 2*wall + gap" },
        lift: { value: "7 mm" },
      },
      shapes: { body: { kind: "box", size: ["= whole", "10 mm", "10 mm"] } },
      clamps: [{ motion: { displacement: [0, 0, "= lift"] } }],
    };
    expect([...namesOfShapes(source)].sort()).toEqual(["gap", "wall", "whole"]);
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
