// First values of a shape of each kind: lengths in sides of a cube, and places about its middle.
import type { Triple } from "../../../protocol";
import { type Room, written, writtenPlace } from "../bodies/placing";
import type { ShapeKind } from "./shapeKinds";
import STARTERS from "./shapeStarters.json";

type Table = Readonly<Record<string, unknown>>;

/** Place of a new shape, m: its side, its middle, and the shapes that it may be made of. */
export interface Spot {
  readonly side: number;
  /** None for the first shape, which begins at the origin as its kind does. */
  readonly middle: Triple | null;
  readonly operands: readonly string[];
}

/** A new shape as a part of the body beside which it stands. */
const SHARE = 0.5;
const LEAST_VOXELS = 2;
/** Lengths of new shapes are whole numbers of these, m. */
const STEP = 5e-4;
/** A shape that is made of others, where there are none. */
const ALONE: Table = { kind: "sphere", radius: "10 mm" };

const rounded = (meters: number) => Math.round(meters / STEP) * STEP;

/** The spot of a new shape on top of a body, half of it above, so that it is seen. */
export function spotOn(body: Room, voxel: number, operands: readonly string[]): Spot {
  const size = body.high.map((x, i) => x - body.low[i]!);
  const mean = Math.cbrt(size[0]! * size[1]! * size[2]!);
  const side = Math.max(Math.round(1e3 * SHARE * mean) / 1e3, LEAST_VOXELS * voxel);
  const [x, y] = [0, 1].map((i) => rounded((body.low[i]! + body.high[i]!) / 2));
  return { side, middle: [x!, y!, rounded(body.high[2])], operands };
}

export function shapeStarter(kind: ShapeKind, spot: Spot): Table {
  const entries = Object.entries(STARTERS[kind] as Table).flatMap(([key, value]) => {
    const filled = fill(value, spot);
    return filled === undefined ? [] : [[key, filled] as const];
  });
  return { kind, ...Object.fromEntries(entries) };
}

function fill(value: unknown, spot: Spot): unknown {
  if (Array.isArray(value)) return value.map((one) => fill(one, spot));
  if (typeof value !== "string") return value;
  const { side, middle, operands } = spot;
  const [first, second] = operands;
  const about = (x: number, z: number): (string | number)[] => {
    const [cx, cy, cz] = middle ?? [0, 0, 0];
    return writtenPlace([cx + x * side, cy, cz + z * side]);
  };
  switch (value) {
    case "middle":
      return middle ? about(0, 0) : undefined;
    case "foot":
      return middle ? about(0, -0.5) : undefined;
    case "left":
      return about(-0.5, 0);
    case "right":
      return about(0.5, 0);
    case "one":
      return first ?? ALONE;
    case "two":
      return [first ?? ALONE, second ?? first ?? ALONE];
    case "lattice":
      return shapeStarter("gyroid", spot);
  }
  const [, number] = /^(-?[\d.]+) side$/.exec(value) ?? [];
  return number === undefined ? value : length(Number(number) * side);
}

/** On whole steps, and never nothing. */
function length(meters: number): string {
  const whole = rounded(meters);
  return written(whole === 0 ? meters : whole);
}
