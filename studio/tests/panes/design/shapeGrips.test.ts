import { Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { shapeGrips, snappedValue } from "../../../src/panes/design/shapes/shapeGrips";
import type { ShapeGrip } from "../../../src/panes/design/shapes/shapeReader";
import { typedChanges } from "../../../src/panes/design/shapes/typedNumber";
import type { DocumentEvent, Parameter } from "../../../src/protocol";
import { gripLabel, numberText } from "../../../src/view/hands/shapeHandle";
import { previewOf } from "../../../src/view/hands/shapePreview";

const PARAMETERS = [
  { name: "length", value: 0.04, kind: "length", factor: 0.001, display_unit: "mm" },
  { name: "half", value: 0.02, kind: "length", factor: 0.001, display_unit: "mm", formula: true },
].map((one) => ({
  ...{ min: null, max: null, step: null, formula: false },
  ...one,
})) as Parameter[];

type Table = Record<string, unknown>;

/** Grips of one shape: as it is written, and as it comes out. */
function gripsOf(text: Table, solved: Table, parameters: Table = {}): Record<string, ShapeGrip> {
  const grips = shapeGrips(
    "it",
    { shapes: { it: text }, parameters },
    { shapes: { it: solved } },
    PARAMETERS,
  );
  return Object.fromEntries(grips.map((grip) => [grip.id, grip]));
}

const BOX = { kind: "box", size: ["40 mm", "20 mm", "10 mm"] };
const SOLVED = { kind: "box", size: [0.04, 0.02, 0.01], corner: null, center: null };
const write = (grip: ShapeGrip | undefined, value: number) => grip?.number.changes(value);
const image = (grip: ShapeGrip, value: number, at: readonly [number, number, number]) =>
  new Vector3(...at).applyMatrix4(previewOf(grip, value)).toArray();
const near = (values: readonly number[]) => values.map((x) => expect.closeTo(x, 9));

describe("a box", () => {
  it("grows away from its corner, which stays", () => {
    const grips = gripsOf(BOX, SOLVED);
    const size = grips["size-x"]!;
    expect([size.value, size.rate, size.reach]).toEqual([0.04, 1, 0.04]);
    expect(size.from).toEqual([0, 0.01, 0.005]);
    expect(image(size, 0.05, [0, 0.02, 0.01])).toEqual(near([0, 0.02, 0.01]));
    expect(image(size, 0.05, [0.04, 0.02, 0.01])).toEqual(near([0.05, 0.02, 0.01]));
    expect(write(size, 0.05)).toEqual([{ path: ["shapes", "it", "size", 0], value: "50 mm" }]);
  });

  it("with a center grows to both sides, twice as fast as its grip", () => {
    const center = { center: ["5 mm", 0, 0] };
    const size = gripsOf({ ...BOX, ...center }, { ...SOLVED, center: [0.005, 0, 0] })["size-x"]!;
    expect([size.rate, size.reach]).toEqual([2, 0.02]);
    expect(image(size, 0.06, [-0.015, 0, 0])).toEqual(near([-0.025, 0, 0]));
  });

  it("is moved by the place that is written, or by a corner that is then written whole", () => {
    expect(write(gripsOf(BOX, SOLVED)["move-y"], 0.0125)).toEqual([
      { path: ["shapes", "it", "corner"], value: [0, "12.5 mm", 0] },
    ]);
    const written = { ...BOX, center: ["5 mm", "1 mm", 0] };
    const grips = gripsOf(written, { ...SOLVED, center: [0.005, 0.001, 0] });
    expect(write(grips["move-y"], 0)).toEqual([{ path: ["shapes", "it", "center", 1], value: 0 }]);
    expect(image(grips["move-y"]!, 0.003, [0, 0, 0])).toEqual(near([0, 0.002, 0]));
  });
});

describe("a number that is a formula", () => {
  const solved = { ...SOLVED, size: [0.04, 0.02, 0.04] };
  const parameters = { length: { value: "40 mm" }, half: "= length/2" };
  const text = { kind: "box", size: ["= length", "= half", "= length - 2*half"] };
  const grips = gripsOf(text, solved, parameters);

  it("changes the parameter of a formula of one name, and reports it", () => {
    const size = grips["size-x"]!;
    expect(write(size, 0.05)).toEqual([
      { path: ["parameters", "length", "value"], value: "50 mm" },
    ]);
    expect(numberText(size, 0.05)).toBe("length = 50 mm");
    expect(gripLabel(size, 0.05)).toContain("changes the parameter length");
  });

  it("does not change a formula of more, or of a parameter that is one itself, and gives the reason", () => {
    expect(grips["size-y"]!.number.blocked).toContain("follows a formula itself");
    expect(grips["size-z"]!.number.blocked).toContain("“= length - 2*half”");
    expect(write(grips["size-z"], 0.01)).toEqual([]);
    expect(gripLabel(grips["size-z"]!, 0.04)).toContain("change it in the form");
  });
});

describe("other kinds", () => {
  it("a cylinder has a height along its axis and a radius around it", () => {
    const text = { kind: "cylinder", radius: "5 mm", height: "20 mm", axis: "x" };
    const solved = { kind: "cylinder", radius: 0.005, height: 0.02, base: [0.01, 0, 0], axis: "x" };
    const grips = gripsOf(text, solved);
    expect(Object.keys(grips)).toEqual(["move-x", "move-y", "move-z", "height", "radius"]);
    expect(grips.height!.way).toEqual({ along: [1, 0, 0] });
    expect(grips.radius!.from).toEqual([0.02, 0, 0]);
    expect(image(grips.radius!, 0.01, [0.013, 0.005, 0])).toEqual(near([0.013, 0.01, 0]));
    expect(image(grips.height!, 0.04, [0.03, 0.005, 0])).toEqual(near([0.05, 0.005, 0]));
  });

  it("a capsule moves with both of its ends", () => {
    const text = { kind: "capsule", start: [0, 0, 0], end: ["30 mm", 0, "2 mm"], radius: "5 mm" };
    const solved = { kind: "capsule", start: [0, 0, 0], end: [0.03, 0, 0.002], radius: 0.005 };
    expect(write(gripsOf(text, solved)["move-z"], 0.001)).toEqual([
      { path: ["shapes", "it", "start", 2], value: "1 mm" },
      { path: ["shapes", "it", "end", 2], value: "3 mm" },
    ]);
  });

  it("a sphere has one radius, a shape that is moved its way, and a union nothing of its own", () => {
    const ball = gripsOf(
      { kind: "sphere", radius: "5 mm" },
      { kind: "sphere", radius: 0.005, center: [0, 0, 0] },
    );
    expect(image(ball.radius!, 0.01, [0, 0.005, 0])).toEqual(near([0, 0.01, 0]));
    const moved = gripsOf(
      { kind: "translate", of: "a", by: ["1 mm", 0, 0] },
      { kind: "translate", by: [0.001, 0, 0] },
    );
    expect(write(moved["move-x"], 0.002)).toEqual([
      { path: ["shapes", "it", "by", 0], value: "2 mm" },
    ]);
    expect(gripsOf({ kind: "union", of: ["a"] }, { kind: "union" })).toEqual({});
    // While the kind was just changed, the values of the design are still of the other.
    expect(gripsOf({ kind: "sphere" }, SOLVED)).toEqual({});
  });
});

it("comes to whole steps, within its bounds", () => {
  const tube = { kind: "tube", radius: "5 mm", wall: "2 mm", height: "9 mm" };
  const solved = {
    kind: "tube",
    radius: 0.005,
    wall: 0.002,
    height: 0.009,
    base: [0, 0, 0],
    axis: "z",
  };
  const { radius } = gripsOf(tube, solved);
  expect(snappedValue(radius!, 0.00563, 5e-4)).toBe(0.0055);
  expect(snappedValue(radius!, 0.00563, 1e-4)).toBe(0.0056);
  // Its wall stays within it.
  expect(snappedValue(radius!, -1, 5e-4)).toBe(0.0021);
});

describe("a number that is typed", () => {
  const document = {
    source: { parameters: { length: "40 mm" } },
    valid: true,
    parameters: PARAMETERS,
  };
  const typed = (text: string) =>
    typedChanges(gripsOf(BOX, SOLVED)["size-x"]!, text, document as unknown as DocumentEvent);

  it("is in millimeters where it has no unit", () => {
    expect(typed("55")).toEqual({
      changes: [{ path: ["shapes", "it", "size", 0], value: "55 mm" }],
    });
    expect(typed("5.5 cm")).toEqual(typed("55"));
  });

  it("may be a formula of parameters", () => {
    expect(typed("length/2")).toEqual({
      changes: [{ path: ["shapes", "it", "size", 0], value: "= length/2" }],
    });
  });

  it("is refused with the reason", () => {
    expect(typed("5 kPa")).toMatchObject({ problem: expect.stringContaining("expected a length") });
    expect(typed("-5 mm")).toEqual({ problem: "must be at least 0.1 mm" });
  });
});
