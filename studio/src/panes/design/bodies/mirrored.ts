// The mirror image of all that a design is made of, opposite a face: a second finger from one.
import { parseQuantity } from "../../../controls/units";
import type { Parameter } from "../../../protocol";
import type { Face } from "../../../view/hands/face";
import type { Change } from "../edits";
import { freeName } from "../fields/starters";
import { coordinate } from "../here/here";
import { written, writtenPlace } from "./placing";

type Table = Readonly<Record<string, unknown>>;
type Triple = readonly [number, number, number];

/** The room between the two as a part of the mirrored body, across the plane. */
const SHARE = 1.25;
/** Keys of directions or lines that this does not turn over. */
const UNKNOWN = ["bodies", "symmetry", "springs", "tendons", "supplies", "connections"] as const;
const DIRECTED = ["fibers", "remanence"] as const;

const tableOf = (source: Table, section: string) => (source[section] as Table | undefined) ?? {};
const listOf = (source: Table, section: string) =>
  (source[section] as readonly Table[] | undefined) ?? [];
const isTable = (value: unknown): value is Table =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/** The plane halfway to the image, which moves with the room between the two. */
interface Plane {
  readonly axis: number;
  /** Position of the face: m where it is a number, and as it is written. */
  readonly face: number | null;
  readonly formula: string;
  /** 1 where the image lies at larger coordinates. */
  readonly sign: 1 | -1;
  /** The name of the parameter that is the room between the two. */
  readonly apart: string;
}

const inner = (value: unknown): string => String(value).trim().replace(/^=\s*/, "");
const isFormula = (value: unknown) => typeof value === "string" && value.trim().startsWith("=");

/** A coordinate in meters, where it is a number. */
function metersOf(value: unknown): number | null {
  if (isFormula(value)) return null;
  const read = parseQuantity(String(value), "m");
  return "value" in read ? read.value : null;
}

/** A sum as a formula: its number first, unless it is 0. */
function sum(constant: number, sign: 1 | -1, name: string): string {
  const first = Math.abs(constant) < 5e-7 ? "" : `${written(constant)} `;
  if (first) return `= ${first}${sign > 0 ? "+" : "-"} ${name}`;
  return sign > 0 ? `= ${name}` : `= -${name}`;
}

/** Position of the plane itself. */
function middle({ face, formula, sign, apart }: Plane): string {
  if (face !== null) return sum(face, sign, `${apart}/2`);
  return `= ${formula} ${sign > 0 ? "+" : "-"} ${apart}/2`;
}

/** The image of a coordinate across the plane. */
function imageOf(value: unknown, plane: Plane): unknown {
  if (value === "inf") return "-inf";
  if (value === "-inf") return "inf";
  const meters = metersOf(value);
  if (plane.face !== null && meters !== null) {
    return sum(2 * plane.face - meters, plane.sign, plane.apart);
  }
  const twice = `2*(${plane.formula})`;
  return `= ${twice} - (${inner(value)}) ${plane.sign > 0 ? "+" : "-"} ${plane.apart}`;
}

function placeImage(value: unknown, plane: Plane): unknown {
  return Array.isArray(value)
    ? value.map((one, i) => (i === plane.axis ? imageOf(one, plane) : one))
    : value;
}

/** A direction turned over. */
function turned(value: unknown, plane: Plane): unknown {
  const opposite = (one: unknown) => {
    if (typeof one === "number") return one === 0 ? 0 : -one;
    if (isFormula(one)) return `= -(${inner(one)})`;
    const text = String(one).trim();
    return text.startsWith("-") ? text.slice(1).trim() : `-${text}`;
  };
  return Array.isArray(value)
    ? value.map((one, i) => (i === plane.axis ? opposite(one) : one))
    : value;
}

/** A shape of the same kind as `of` at both places, or at the other alone. */
function mirrorShape(of: unknown, plane: Plane, keep: boolean): Table {
  const point = [0, 1, 2].map((i) => (i === plane.axis ? middle(plane) : 0));
  const image = { kind: "mirror", of, normal: "xyz"[plane.axis], point };
  return keep ? { ...image, keep } : image;
}

/** The image of a region, or null where the region holds its own image already. */
function regionImage(region: Table, plane: Plane, both: ReadonlySet<string>): Table | null {
  const key = "xyz"[plane.axis]!;
  const range = region[key];
  const { shape } = region;
  const ofBoth = shape === undefined || (typeof shape === "string" && both.has(shape));
  if (range === undefined && region.center === undefined && ofBoth) return null;
  return {
    ...region,
    ...(Array.isArray(range)
      ? { [key]: [imageOf(range[1], plane), imageOf(range[0], plane)] }
      : {}),
    ...(region.center === undefined ? {} : { center: placeImage(region.center, plane) }),
    ...(ofBoth ? {} : { shape: mirrorShape(shape, plane, false) }),
  };
}

/** Check if all of a design can be mirrored. */
export function canMirror(source: Table): boolean {
  const lines = UNKNOWN.some((section) => listOf(source, section).length > 0);
  const parts = listOf(source, "parts");
  const directed = parts.some((part) => DIRECTED.some((key) => part[key] !== undefined));
  return !lines && !directed && parts.length > 0;
}

/** The room that is left between a body and its image, m: a whole number of voxels. */
export function roomBetween(face: Face, size: Triple): number {
  const thick = size[face.axis ?? 0]!;
  return Math.max(1, Math.round((SHARE * thick) / face.voxelSize)) * face.voxelSize;
}

/**
 * Changes that add the image of a design opposite a face of it, across one axis.
 *
 * `size` is that of the body in m, and `cavities` how many it has. A pressure in the only one becomes that of all,
 * so that one number drives both.
 */
export function mirrored(
  face: Face,
  size: Triple,
  cavities: number,
  source: Table,
  parameters: readonly Parameter[],
): Change[] {
  if (face.axis === null || !canMirror(source)) return [];
  const { axis } = face;
  const at = coordinate(face.low[axis]!, parameters, face.voxelSize);
  const apart = freeName("apart", Object.keys(tableOf(source, "parameters")));
  const plane: Plane = {
    ...{ axis, face: metersOf(at), formula: inner(at), apart: apart.replaceAll("-", "_") },
    sign: face.normal[axis]! > 0 ? 1 : -1,
  };
  const room = roomBetween(face, size);
  const [least, most] = [room / 2, 2 * room].map(written);
  const changes: Change[] = [
    {
      path: ["parameters", plane.apart],
      value: {
        ...{ value: written(room), min: least, max: most },
        description: "between the body and its mirror image",
      },
    },
  ];
  const shapes = tableOf(source, "shapes");
  const names = new Set(Object.keys(shapes));
  const both = new Set<string>();
  listOf(source, "parts").forEach(({ shape }, i) => {
    if (typeof shape !== "string" || !(shape in shapes)) {
      changes.push({ path: ["parts", i, "shape"], value: mirrorShape(shape, plane, true) });
    } else if (!both.has(shape)) {
      // The shape keeps its name, so that all that speak of it go on with both.
      both.add(shape);
      const whole = freeName(`${shape}-one`, names);
      names.add(whole);
      changes.push(
        { path: ["shapes", whole], value: shapes[shape] },
        { path: ["shapes", shape], value: mirrorShape(whole, plane, true) },
      );
    }
  });
  for (const section of ["clamps", "layers"]) {
    changes.push(...listImages(source, section, plane, both));
  }
  const chambers = tableOf(source, "chambers");
  const called = new Map(
    Object.keys(chambers).map((name) => [name, freeName(name, Object.keys(chambers))]),
  );
  for (const section of ["chambers", "probes"]) {
    const all = tableOf(source, section);
    const taken = Object.keys(all);
    for (const [name, value] of Object.entries(all)) {
      if (!isTable(value)) continue;
      const point = "point" in value ? { ...value, point: placeImage(value.point, plane) } : null;
      const image = point ?? regionImage(value, plane, both);
      if (!image) continue;
      const free = freeName(name, taken);
      taken.push(free);
      changes.push({ path: [section, free], value: image });
    }
  }
  changes.push(...loadImages(source, plane, both, cavities, called));
  return changes;
}

/** Images of clamps and layers, behind those that there are. */
function listImages(
  source: Table,
  section: string,
  plane: Plane,
  both: ReadonlySet<string>,
): Change[] {
  const all = listOf(source, section);
  const taken = all.map((one) => String(one.name ?? ""));
  return all
    .flatMap((one) => {
      const region = isTable(one.region) ? regionImage(one.region, plane, both) : null;
      if (!region) return [];
      const name = typeof one.name === "string" ? freeName(one.name, taken) : null;
      if (name) taken.push(name);
      const motion = isTable(one.motion)
        ? { motion: { ...one.motion, displacement: turned(one.motion.displacement, plane) } }
        : {};
      return [{ ...one, ...(name ? { name } : {}), region, ...motion }];
    })
    .map((value, i) => ({ path: [section, all.length + i], value }));
}

/** Images of loads; pressures go by their chambers. */
function loadImages(
  source: Table,
  plane: Plane,
  both: ReadonlySet<string>,
  cavities: number,
  called: ReadonlyMap<string, string>,
): Change[] {
  const loads = listOf(source, "loads");
  const changes: Change[] = [];
  let next = loads.length;
  loads.forEach((load, i) => {
    if (isTable(load.region)) {
      const region = regionImage(load.region, plane, both);
      if (!region) return;
      const value = turned(load.value, plane);
      changes.push({ path: ["loads", next], value: { ...load, region, value } });
      next += 1;
    } else if (load.cavity !== undefined && load.cavity !== "all") {
      if (cavities === 1) {
        changes.push({ path: ["loads", i, "cavity"], value: "all" });
        return;
      }
      const cavity = called.get(String(load.cavity));
      if (cavity === undefined) return;
      changes.push({ path: ["loads", next], value: { ...load, cavity } });
      next += 1;
    }
  });
  return changes;
}

/** Middle between a body and its image, as it is written; null where there is none at a place. */
export function planeAt(
  axis: number,
  meters: number,
  tolerance: number,
  source: Table,
  design: Table | null,
): unknown {
  const solved = tableOf(design ?? {}, "shapes");
  for (const [name, shape] of Object.entries(tableOf(source, "shapes"))) {
    if (!isTable(shape) || shape.kind !== "mirror" || shape.normal !== "xyz"[axis]) continue;
    const point = (solved[name] as Table | undefined)?.point;
    const at = Array.isArray(point) ? (point[axis] as unknown) : undefined;
    if (typeof at === "number" && Math.abs(at - meters) < tolerance) {
      return (shape.point as readonly unknown[])[axis];
    }
  }
  return null;
}

/** A place between a body and its image: the written position of the plane, and the rest in mm. */
export function placeBetween(
  axis: number,
  center: Triple,
  tolerance: number,
  source: Table,
  design: Table | null,
): unknown[] {
  const plane = planeAt(axis, center[axis]!, tolerance, source, design);
  const place: unknown[] = writtenPlace([...center]);
  if (plane !== null) place[axis] = plane;
  return place;
}
