import { expect, it } from "vitest";
import {
  frictionEdit,
  frictionOf,
  meshShape,
  motionOf,
  newShape,
  withMotion,
} from "../../../src/panes/design/bodies/gripped";
import {
  boxOf,
  type Room,
  type Surroundings,
  spotFor,
} from "../../../src/panes/design/bodies/placing";
import type { Triple } from "../../../src/protocol";

const FINGER: Room = { low: [0, 0, -0.06], high: [0.02, 0.01, 0] };
const HANGING: Surroundings = {
  ...{ body: FINGER, taken: [], held: [0.01, 0.005, 0], floor: null, gap: 0.002 },
};
/** A design of one body. */
const ALONE = ["body"];
const CUBE: Triple = [0.01, 0.01, 0.01];

function roomAt(spot: Triple, size: Triple): Room {
  const end = (sign: number) => spot.map((x, axis) => x + (sign * size[axis]!) / 2) as Triple;
  return { low: end(-1), high: end(1) };
}

const meet = (a: Room, b: Room) =>
  [0, 1, 2].every((axis) => a.low[axis]! < b.high[axis]! && b.low[axis]! < a.high[axis]!);

it("puts an object at the end that is not held, a voxel away", () => {
  const spot = spotFor(CUBE, HANGING);
  expect(spot).toEqual([0.01, 0.005, expect.closeTo(-0.067, 9)]);
});

it("puts it beside a body on a floor, above that", () => {
  const spot = spotFor(CUBE, { ...HANGING, floor: -0.06 });
  expect(spot[0]).toBeCloseTo(0.027, 9);
  expect(spot[2]).toBeGreaterThan(-0.055);
  expect(spot[2]).toBeLessThan(-0.0549);
});

it("puts the next ones into nothing that is there", () => {
  const taken: Room[] = [];
  for (let count = 0; count < 4; count++) {
    const room = roomAt(spotFor(CUBE, { ...HANGING, taken }), CUBE);
    for (const other of [FINGER, ...taken]) expect(meet(room, other)).toBe(false);
    taken.push(room);
  }
});

it("writes primitives about one middle, and a mesh moved there", () => {
  const middle = ["10 mm", "5 mm", "-71 mm"]; // 18 mm wide: three tenths of 60 mm
  expect(newShape("sphere", HANGING)).toEqual({ kind: "sphere", radius: "9 mm", center: middle });
  expect(newShape("box", HANGING).center).toEqual(middle);
  expect(newShape("cylinder", HANGING)).toMatchObject({
    ...{ base: ["10 mm", "5 mm", "-80 mm"], height: "18 mm", radius: "9 mm" },
  });
  const mesh = { kind: "mesh", path: "/a.stl", unit: "mm" };
  expect(meshShape(mesh, [0.1, 0, 0], [0.11, 0.01, 0.01], HANGING)).toEqual({
    kind: "translate",
    of: mesh,
    by: ["-95 mm", 0, "-72 mm"],
  });
});

it("gives free objects a mass, and takes it from others", () => {
  const fixed = { name: "ball", shape: "ball", motion: "fixed" };
  const free = withMotion(fixed, "free", null);
  expect(free).toEqual({ ...fixed, motion: "free", mass: "50 g" });
  expect(withMotion(free, "moved", null)).toEqual({
    ...fixed,
    motion: { displacement: [0, 0, "-1 mm"] },
  });
  const dense = { ...fixed, motion: "free", density: "1 g/cm^3" };
  expect(withMotion(dense, "free", null)).toEqual(dense);
  expect(["fixed", "moved", "free"]).toEqual([
    motionOf(fixed),
    motionOf(withMotion(free, "moved", null)),
    motionOf(free),
  ]);
});

it("writes the friction of one object for all, and of several for each pair", () => {
  expect(frictionEdit(undefined, "a", 1, 0.5, ALONE)).toEqual([
    {
      path: ["contact"],
      value: { friction: 0.5 },
    },
  ]);
  expect(frictionEdit({ friction: 0.1 }, "a", 1, 0.5, ALONE)[0]?.path).toEqual([
    "contact",
    "friction",
  ]);
  const pair = { of: ["body", "a"], friction: 0.5 };
  expect(frictionEdit({ friction: 0.1 }, "a", 2, 0.5, ALONE)).toEqual([
    {
      path: ["contact", "pairs"],
      value: [pair],
    },
  ]);
  const pairs = [{ of: ["b", "body"], friction: 0.3 }, pair];
  expect(frictionEdit({ pairs }, "b", 2, 0.4, ALONE)).toEqual([
    {
      path: ["contact", "pairs", 0, "friction"],
      value: 0.4,
    },
  ]);
  expect(frictionOf({ friction: 0.1, pairs }, "a", ALONE)).toBe(0.5);
  expect(frictionOf({ friction: 0.1, pairs }, "c", ALONE)).toBe(0.1);
  expect(frictionOf(undefined, "c", ALONE)).toBe(0);
});

it("writes the friction of an object with several bodies for each of them", () => {
  const both = ["left", "right"];
  const pair = (body: string, friction: number) => ({ of: [body, "ball"], friction });
  expect(frictionEdit(undefined, "ball", 2, 0.5, both)).toEqual([
    {
      path: ["contact"],
      value: { pairs: [pair("left", 0.5), pair("right", 0.5)] },
    },
  ]);
  const pairs = [{ of: ["left", "right"], friction: 0.1 }, pair("right", 0.3)];
  expect(frictionEdit({ pairs }, "ball", 1, 0.5, both)).toEqual([
    {
      path: ["contact", "pairs"],
      value: [pairs[0], pair("right", 0.5), pair("left", 0.5)],
    },
  ]);
  expect(frictionEdit({ friction: 0.1 }, "ball", 1, 0.5, both)[0]?.path).toEqual([
    "contact",
    "friction",
  ]);
  expect(frictionOf({ friction: 0.2, pairs }, "ball", both)).toBe(0.3);
});

it("finds the box of points", () => {
  expect(boxOf([1, 2, 3, -1, 5, 0])).toEqual({ low: [-1, 2, 0], high: [1, 5, 3] });
});
