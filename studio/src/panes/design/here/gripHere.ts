// An object to grip at a face that was pressed: between two fingers, or in front of one.
import type { Face } from "../../../view/hands/face";
import type { Primitive } from "../bodies/gripped";
import { placeBetween } from "../bodies/mirrored";
import { written, writtenPlace } from "../bodies/placing";
import type { Change } from "../edits";
import { freeName } from "../fields/starters";

type Table = Readonly<Record<string, unknown>>;
type Triple = [number, number, number];

/** Share of the room between two walls that an object there takes. */
const FILLED = 0.9;
/** A guess for silicone on dry surfaces, as in the gripper's tutorial: everyone has to measure their own. */
export const FIRST_FRICTION = 0.8;
/** Density of water, kg/m³. */
const DENSITY = 1000;
/** Rounding of positions in single precision, as a part of a voxel. */
const NEAR = 1e-3;
/** Places along a face are rounded to this, m. */
const SNAP = 1e-3;

/** Names by kind: a sphere to grip is a ball. */
export const nameOf = (kind: Primitive): string => (kind === "sphere" ? "ball" : kind);

/** The middle of an object that stands at the face, m: at the press along its longer side, else in its middle. */
function standing(face: Face, reach: number): Triple {
  const { axis, point, normal, low, high } = face;
  if (axis === null) return point.map((x, i) => x + reach * normal[i]!) as Triple;
  const [a, b] = [0, 1, 2].filter((i) => i !== axis) as [number, number];
  const longer = high[a]! - low[a]! > high[b]! - low[b]! ? a : b;
  return point.map((x, i) => {
    if (i === axis) return x + reach * normal[i]!;
    return i === longer ? Math.round(x / SNAP) * SNAP : (low[i]! + high[i]!) / 2;
  }) as Triple;
}

/** A mass as it is written, to one digit. */
function mass(volume: number): string {
  return `${Number((1e3 * DENSITY * volume).toPrecision(1))} g`;
}

/** The changes that add a free object at a face, `alone` m wide where nothing is opposite. */
export function gripHere(
  kind: Primitive,
  face: Face,
  alone: number,
  source: Table,
  design: Table | null,
): { readonly name: string; readonly changes: Change[] } {
  const between = face.opposite;
  // To a whole number of millimeters across the radius, so that numbers stay short.
  const side =
    between === null ? alone : Math.max(2e-3 * Math.floor(500 * FILLED * between + 1e-6), 1e-3);
  const reach = between === null ? face.voxelSize + side / 2 : between / 2;
  const center = standing(face, reach);
  const axis = between === null ? null : face.axis;
  const place =
    axis === null
      ? writtenPlace(center)
      : placeBetween(axis, center, NEAR * face.voxelSize, source, design);
  const objects = (source.objects as readonly Table[] | undefined) ?? [];
  const name = freeName(
    nameOf(kind),
    objects.map((one) => String(one.name)),
  );
  const base = placeLowered(place, center, side / 2);
  const shape = {
    sphere: { kind, radius: written(side / 2), center: place },
    box: { kind, size: [side, side, side].map(written), center: place },
    cylinder: { kind, radius: written(side / 2), height: written(side), base },
  }[kind];
  const volume = {
    sphere: (Math.PI / 6) * side ** 3,
    box: side ** 3,
    cylinder: (Math.PI / 4) * side ** 3,
  }[kind];
  const object = { name, shape, motion: "free", mass: mass(volume) };
  const changes: Change[] = [{ path: ["objects", objects.length], value: object }];
  if (source.contact === undefined) {
    changes.push({ path: ["contact"], value: { friction: FIRST_FRICTION } });
  }
  return { name, changes };
}

/** Lower a place by a distance, as a cylinder stands on its base. */
function placeLowered(place: readonly unknown[], center: Triple, by: number): unknown[] {
  const [low] = writtenPlace([center[2] - by, 0, 0]);
  return [place[0], place[1], low];
}
