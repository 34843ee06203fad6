// Place and size of a new object to grip: beside the body, where nothing is yet.
import { bytesOf } from "../../../engine/base64";
import type { BodyEvent, Triple } from "../../../protocol";

/** A box along the axes, m. */
export interface Room {
  readonly low: Triple;
  readonly high: Triple;
}

export interface Surroundings {
  readonly body: Room;
  /** Other objects. */
  readonly taken: readonly Room[];
  /** Middle of the clamped vertices, if there are any. */
  readonly held: Triple | null;
  readonly floor: number | null;
  /** Gap between the two, m. */
  readonly gap: number;
}

/** Longest side of a new object, as a part of that of the body. */
const SHARE = 0.3;
/** Voxels across a new object at least: a smaller one is traced as a lump. */
const LEAST_VOXELS = 3;

const AXES = [0, 1, 2] as const;

const middleOf = ({ low, high }: Room): Triple =>
  AXES.map((axis) => (low[axis] + high[axis]) / 2) as Triple;

/** Surroundings of a new object; null before there is a body. */
export function surroundingsOf(body: BodyEvent | null, floor: unknown): Surroundings | null {
  if (!body) return null;
  const [low, high] = body.bounds;
  const { clamps } = body;
  const held = AXES.map(
    (axis) => clamps.reduce((sum, clamp) => sum + clamp.center[axis], 0) / clamps.length,
  ) as Triple;
  return {
    body: { low, high },
    taken: body.objects.map((object) => boxOf(new Float32Array(bytesOf(object.vertices)))),
    held: clamps.length > 0 ? held : null,
    floor: typeof floor === "number" ? floor : null,
    gap: body.voxel_size,
  };
}

/** The box of points x, y, z, m. */
export function boxOf(points: ArrayLike<number>): Room {
  const low: Triple = [Infinity, Infinity, Infinity];
  const high: Triple = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i++) {
    const axis = (i % 3) as 0 | 1 | 2;
    low[axis] = Math.min(low[axis], points[i] as number);
    high[axis] = Math.max(high[axis], points[i] as number);
  }
  return { low, high };
}

/** The side of a new object, m, to two digits. */
export function sideFor(around: Surroundings | null): number {
  if (!around) return 0.01;
  const { low, high } = around.body;
  const longest = Math.max(...AXES.map((axis) => high[axis] - low[axis]));
  return Number(Math.max(SHARE * longest, LEAST_VOXELS * around.gap).toPrecision(2));
}

/** The axis along which a new object stands beside the body, and its side: away from the clamps. */
function sideOfBody({ body, held, floor }: Surroundings): [0 | 1 | 2, 1 | -1] {
  const middle = middleOf(body);
  const away = held ? AXES.map((axis) => middle[axis] - held[axis]) : [0, 0, -1];
  const [axis] = [...AXES].sort(
    (a, b) => Math.abs(away[b] as number) - Math.abs(away[a] as number),
  );
  const along = axis as 0 | 1 | 2;
  const sign = (away[along] as number) < 0 ? -1 : 1;
  // Under a body that stands or lies on a floor there is no room.
  return along === 2 && sign < 0 && floor !== null ? [0, 1] : [along, sign];
}

/** The middle of a new object of some size, m, where it is in nothing. */
export function spotFor(size: Triple, around: Surroundings | null): Triple {
  if (!around) return [0, 0, 0];
  const [along, sign] = sideOfBody(around);
  const spot = middleOf(around.body);
  if (around.floor !== null && along !== 2) {
    spot[2] = around.floor + size[2] / 2 + 0.01 * around.gap;
  }
  const edges = [around.body, ...around.taken].map((room) =>
    sign > 0 ? room.high[along] : -room.low[along],
  );
  spot[along] = sign * (Math.max(...edges) + around.gap + size[along] / 2);
  return spot;
}

/** The way from an object into the body by a tenth of its longest side, m. */
export function wayInto(name: string, body: BodyEvent | null): Triple {
  const object = body?.objects.find((one) => one.name === name);
  if (!body || !object) return [0, 0, -0.001];
  const room: Room = { low: body.bounds[0], high: body.bounds[1] };
  const own = boxOf(new Float32Array(bytesOf(object.vertices)));
  // Along the axis that is between them.
  const apart = AXES.map((axis) =>
    Math.max(own.low[axis] - room.high[axis], room.low[axis] - own.high[axis]),
  );
  const widest = Math.max(...apart);
  const along = apart.indexOf(widest) as 0 | 1 | 2;
  const longest = Math.max(...AXES.map((axis) => room.high[axis] - room.low[axis]));
  const way: Triple = [0, 0, 0];
  const toward = own.low[along] >= room.high[along] ? -1 : 1;
  way[along] = toward * (Math.max(widest, 0) + 0.1 * longest);
  return way;
}

/** A length or a place as it is written, in mm. */
export const written = (meters: number): string => `${Number((1e3 * meters).toFixed(3))} mm`;
export const writtenPlace = (place: Triple): (string | number)[] =>
  place.map((x) => (Math.abs(x) < 5e-7 ? 0 : written(x)));
