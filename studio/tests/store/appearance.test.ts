import { expect, test } from "vitest";
import { appearanceOf, type ChosenAppearance } from "../../src/store/appearance";

const seen = (appearance: ChosenAppearance, cavities = false) => ({ appearance, cavities });
const CUT = { smooth: true, cut: true };
const ON_THE_GRID = { smooth: true, cut: false };
const UNTRACED = { smooth: false, cut: true };

test("a body of cut voxels is smooth before a hand chooses, once its shape is traced", () => {
  expect(appearanceOf(seen("auto"), CUT)).toBe("smooth");
  expect(appearanceOf(seen("auto"), UNTRACED)).toBe("voxels");
});

test("a body on the grid is drawn by its voxels before a hand chooses", () => {
  expect(appearanceOf(seen("auto"), ON_THE_GRID)).toBe("voxels");
  expect(appearanceOf(seen("auto"), null)).toBe("voxels");
});

test("a choice of a hand wins for every body", () => {
  for (const body of [CUT, ON_THE_GRID, UNTRACED])
    for (const chosen of ["voxels", "tets", "wireframe"] as const)
      expect(appearanceOf(seen(chosen), body)).toBe(chosen);
  expect(appearanceOf(seen("smooth"), ON_THE_GRID)).toBe("smooth");
});

test("voxels stand for a smooth shape that is not there, and where chambers are shown", () => {
  expect(appearanceOf(seen("smooth"), UNTRACED)).toBe("voxels");
  expect(appearanceOf(seen("auto", true), CUT)).toBe("voxels");
  expect(appearanceOf(seen("smooth", true), CUT)).toBe("voxels");
  expect(appearanceOf(seen("wireframe", true), CUT)).toBe("wireframe");
});
