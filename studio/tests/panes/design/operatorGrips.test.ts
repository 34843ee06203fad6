// @vitest-environment happy-dom
import { Matrix4, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { shapeGrips, snappedValue } from "../../../src/panes/design/shapes/shapeGrips";
import type { ShapeGrip } from "../../../src/panes/design/shapes/shapeReader";
import { typedChanges } from "../../../src/panes/design/shapes/typedNumber";
import type { DocumentEvent, Parameter } from "../../../src/protocol";
import { CameraRig } from "../../../src/view/drawing/camera";
import {
  frontOf,
  gripLabel,
  numberText,
  ShapeHandle,
  within,
} from "../../../src/view/hands/shapeHandle";
import { previewOf } from "../../../src/view/hands/shapePreview";

const PARAMETERS = [
  { name: "lean", value: Math.PI / 6, kind: "angle", factor: Math.PI / 180, display_unit: "deg" },
  { name: "many", value: 4, kind: "number", factor: 1, display_unit: "" },
].map((one) => ({
  ...{ min: null, max: null, step: null, formula: false },
  ...one,
})) as Parameter[];

type Table = Record<string, unknown>;
const BOX = { low: [0, 0, 0], high: [0.04, 0.02, 0.01] } as const;

function gripsOf(text: Table, solved: Table, box: typeof BOX | null = BOX) {
  const parameters = { lean: { value: "30 deg" }, many: 4 };
  const source = { shapes: { it: text }, parameters };
  const all = shapeGrips("it", source, { shapes: { it: solved } }, PARAMETERS, box as never);
  return Object.fromEntries(all.map((grip) => [grip.id, grip])) as Record<string, ShapeGrip>;
}
const write = (grip: ShapeGrip | undefined, value: number) => grip?.number.changes(value);
const image = (grip: ShapeGrip, value: number, at: readonly [number, number, number]) =>
  new Vector3(...at).applyMatrix4(previewOf(grip, value)).toArray();
const near = (values: readonly number[]) => values.map((x) => expect.closeTo(x, 9));
const DEGREE = Math.PI / 180;

describe("a shape that is turned", () => {
  const text = { kind: "rotate", of: "a", angle: "30 deg" };
  const solved = { kind: "rotate", angle: Math.PI / 6, axis: "z", center: [0.01, 0, 0] };

  it("has its angle on a ring about the axis, through the center", () => {
    const { angle } = gripsOf(text, solved);
    expect(angle?.way).toEqual({ about: [0, 0, 1] });
    expect(angle?.from).toEqual([0.01, 0, 0]);
    expect(write(angle, 45 * DEGREE)).toEqual([
      { path: ["shapes", "it", "angle"], value: "45 deg" },
    ]);
    expect(numberText(angle!, 45 * DEGREE)).toBe("45°");
    expect(snappedValue(angle!, 33 * DEGREE, 5 * DEGREE)).toBeCloseTo(35 * DEGREE, 9);
    // A quarter more takes the points beside the center a quarter around it.
    expect(image(angle!, 120 * DEGREE, [0.02, 0, 0])).toEqual(near([0.01, 0.01, 0]));
  });

  it("goes with its center by the rest of the way after the rotation", () => {
    const quarter = { ...solved, angle: Math.PI / 2 };
    const grips = gripsOf(text, quarter);
    expect(grips["center-x"]?.at).toEqual([0.01, 0, 0]);
    // With R of a quarter about z: the shape goes by (1 − R) d = d − (0, d).
    expect(image(grips["center-x"]!, 0.02, [0, 0, 0])).toEqual(near([0.01, -0.01, 0]));
    expect(write(grips["center-x"], 0.02)).toEqual([
      { path: ["shapes", "it", "center"], value: ["20 mm", 0, 0] },
    ]);
  });

  it("changes the parameter that its angle is, and says why it does not", () => {
    const { angle } = gripsOf({ ...text, angle: "= lean" }, solved);
    expect(write(angle, 40 * DEGREE)).toEqual([
      { path: ["parameters", "lean", "value"], value: "40 deg" },
    ]);
    expect(gripLabel(angle!, angle!.value)).toContain("It changes the parameter lean");
    const other = gripsOf({ ...text, angle: "= 2*lean" }, solved).angle!;
    expect(gripLabel(other, other.value)).toContain("follows the formula “= 2*lean”");
  });

  it("takes typed numbers in degrees", () => {
    const { angle } = gripsOf(text, solved);
    const document = { source: {}, valid: true, parameters: [] } as unknown as DocumentEvent;
    expect(typedChanges(angle!, "12.5", document)).toEqual({
      changes: [{ path: ["shapes", "it", "angle"], value: "12.5 deg" }],
    });
    expect(typedChanges(angle!, "45°", document)).toMatchObject({ changes: [{ value: "45 deg" }] });
    expect(typedChanges(angle!, "5 mm", document)).toHaveProperty("problem");
  });
});

describe("a shape that is scaled", () => {
  it("has one factor to all sides, about its center", () => {
    const solved = { kind: "scale", factor: 2, center: [0, 0, 0] };
    const grips = gripsOf({ kind: "scale", of: "a", factor: 2 }, solved);
    const factor = grips.factor!;
    expect([factor.reach, factor.rate]).toEqual([0.02, 100]);
    expect(write(factor, 2.5)).toEqual([{ path: ["shapes", "it", "factor"], value: 2.5 }]);
    expect(image(factor, 3, [0.04, 0.02, 0])).toEqual(near([0.06, 0.03, 0]));
    expect(numberText(factor, 2.5)).toBe("× 2.5");
    expect(snappedValue(factor, -1, 0.05)).toBe(0.01);
    // At twice the size the center goes the other way.
    expect(image(grips["center-y"]!, 0.003, [0, 0, 0])).toEqual(near([0, -0.003, 0]));
  });

  it("or one for each axis", () => {
    const solved = { kind: "scale", factor: [1, 2, 4], center: [0.04, 0, 0] };
    const grips = gripsOf({ kind: "scale", of: "a", factor: [1, 2, 4] }, solved);
    // Its box reaches farther to the other side of the center.
    expect(grips["factor-x"]?.way).toEqual({ along: [-1, 0, 0] });
    expect(write(grips["factor-z"], 3)).toEqual([
      { path: ["shapes", "it", "factor", 2], value: 3 },
    ]);
    expect(image(grips["factor-z"]!, 8, [0, 0, 0.01])).toEqual(near([0, 0, 0.02]));
  });
});

describe("a mirror", () => {
  const text = { kind: "mirror", of: "a", normal: "x" };
  const solved = { kind: "mirror", normal: "x", point: [0.05, 0, 0], keep: false };

  it("has a plane, by which the image moves twice as far", () => {
    const plane = gripsOf(text, solved)["plane-x"]!;
    expect([plane.value, plane.from]).toEqual([0.05, [0, 0.01, 0.005]]);
    expect(image(plane, 0.06, [0, 0, 0])).toEqual(near([0.02, 0, 0]));
    expect(write(plane, 0.06)).toEqual([
      { path: ["shapes", "it", "point"], value: ["60 mm", 0, 0] },
    ]);
    const [corners] = plane.outline!(0.06);
    expect(corners!.every(([x]) => x === 0.06)).toBe(true);
  });

  it("is not drawn as one of two that both stay, and has no grip where it is oblique", () => {
    const both = gripsOf(text, { ...solved, keep: true })["plane-x"]!;
    expect(image(both, 0.06, [1, 2, 3])).toEqual([1, 2, 3]);
    expect(gripsOf(text, { ...solved, normal: [1, 1, 0] })).toEqual({});
  });
});

describe("copies", () => {
  const text = { kind: "array", of: "a", count: ["= many", 1, 1], spacing: ["10 mm", 0, 0] };
  const solved = { kind: "array", count: [4, 1, 1], spacing: [0.01, 0, 0] };

  it("are so far apart and so many, each by the grip at their end", () => {
    const grips = gripsOf(text, solved);
    expect(Object.keys(grips)).toEqual(["spacing-x", "count-x"]);
    const spacing = grips["spacing-x"]!;
    expect([spacing.reach, spacing.rate]).toEqual([0.04, 1 / 3]);
    expect(write(spacing, 0.012)).toEqual([
      { path: ["shapes", "it", "spacing", 0], value: "12 mm" },
    ]);
    expect(write(grips["count-x"], 6)).toEqual([{ path: ["parameters", "many"], value: 6 }]);
    expect(snappedValue(grips["count-x"]!, 0.2, 1)).toBe(1);
    expect(numberText(grips["count-x"]!, 6)).toBe("many = 6 copies");
  });

  it("are outlined while a grip is held, from the first on", () => {
    const { "count-x": count, "spacing-x": spacing } = gripsOf(text, solved);
    expect(count!.outline!(4)).toEqual([]);
    expect(spacing!.outline!(0.01)).toEqual([]);
    const ends = (lines: readonly (readonly (readonly number[])[])[]) => {
      const xs = lines.flat().map(([x]) => x!);
      return [Math.min(...xs), Math.max(...xs)];
    };
    // One is 10 mm long; the last of six begins 50 mm on.
    expect(ends(count!.outline!(6))).toEqual(near([0, 0.06]));
    expect(ends(spacing!.outline!(0.02))).toEqual(near([0, 0.07]));
  });

  it("to the other side begin at the upper end", () => {
    const back = { kind: "array", count: [1, 3, 1], spacing: [0, -0.005, 0] };
    const grips = gripsOf({ ...text, count: [1, 3, 1], spacing: [0, "-5 mm", 0] }, back);
    const spacing = grips["spacing-y"]!;
    expect(spacing.way).toEqual({ along: [0, -1, 0] });
    expect([spacing.from[1], spacing.rate]).toEqual([0.02, -0.5]);
  });

  it("take a whole number", () => {
    const document = { source: {}, valid: true, parameters: [] } as unknown as DocumentEvent;
    const { "count-x": count } = gripsOf({ ...text, count: [4, 1, 1] }, solved);
    expect(typedChanges(count!, "2.5", document)).toEqual({ problem: "expected a whole number" });
    expect(typedChanges(count!, "7 copies", document)).toEqual({
      changes: [{ path: ["shapes", "it", "count", 0], value: 7 }],
    });
    expect(typedChanges(count!, "0", document)).toHaveProperty("problem");
  });

  it("around an axis spread over an angle, a full turn where none is written", () => {
    const around = {
      kind: "polar-array",
      count: 6,
      angle: 2 * Math.PI,
      axis: "y",
      center: [0, 0, 0],
    };
    const grips = gripsOf({ kind: "polar-array", of: "a", count: 6 }, around);
    expect(numberText(grips.angle!, grips.angle!.value)).toBe("360°");
    expect(snappedValue(grips.angle!, 7, 5 * DEGREE)).toBeCloseTo(2 * Math.PI, 9);
    expect(write(grips.count, 5)).toEqual([{ path: ["shapes", "it", "count"], value: 5 }]);
  });
});

it("keeps grips in the picture, on the way to where they end", () => {
  const center = { x: 100, y: 100 };
  expect(within(center, { x: 150, y: 20 }, 400, 300)).toEqual({ x: 150, y: 20 });
  expect(within(center, { x: 100, y: 388 }, 400, 300)).toEqual({ x: 100, y: 288 });
  expect(within(center, { x: -76, y: 276 }, 400, 300)).toEqual({ x: 12, y: 188 });
  // The chosen entry is out of the picture itself.
  expect(within({ x: 500, y: 100 }, { x: 600, y: 100 }, 400, 300)).toEqual({ x: 600, y: 100 });
});

describe("the ring of an angle", () => {
  it("has its grip on the side of the eye", () => {
    const front = frontOf(new Vector3(0, 0, 1), new Vector3(0.6, 0, 0.8), new Vector3(0, 1, 0));
    expect(front.toArray()).toEqual(near([1, 0, 0]));
    const along = frontOf(new Vector3(0, 0, 1), new Vector3(0, 0, 1), new Vector3(0, 1, 0));
    expect(along.toArray()).toEqual(near([0, 1, 0]));
  });

  it("is turned by keys, and drawn", () => {
    const rig = new CameraRig();
    rig.resize(800, 600);
    const done: number[] = [];
    const handle = new ShapeHandle(rig, {
      changed: () => {},
      dropped: () => {},
      stepped: (_grip, value) => done.push(value / DEGREE),
      typed: () => null,
    });
    const solved = { kind: "rotate", angle: Math.PI / 6, axis: "z", center: [0, 0, 0] };
    const grips = Object.values(gripsOf({ kind: "rotate", angle: "30 deg" }, solved));
    handle.place({ grips, pose: new Matrix4(), middle: new Vector3() }, 800, 600);
    const button = handle.element.querySelector("[data-testid=shape-angle]");
    expect(handle.element.querySelector("path.ring")?.getAttribute("d")).toContain("L");
    button?.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp" }));
    button?.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", shiftKey: true }));
    expect(done.map((one) => Number(one.toFixed(6)))).toEqual([35, 31]);
  });
});
