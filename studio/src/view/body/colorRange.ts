// Between which values colors run: all, or those of 99 % of the area where a few lie far beyond. At a sharp
// corner a stress has no bound, and its one vertex would leave the rest of the body one color. Pictures of
// `voxsoft.plot` follow the same rule (python/voxsoft/plot/color_range.py).
import { type Frame, type Topology, valueIn } from "../../engine/frames";

/** The part of the area whose values the colors tell apart. */
export const CLIP = 0.99;
/** Distance beyond it at which a value is clipped: this part of the range of the others. */
const FAR = 0.1;
const LEVELS = 65536;
/** Displacements and speed (fields of crates/solid/src/fields) have no sharp corners: none is clipped. */
const OF_MOTION: ReadonlySet<number> = new Set([0, 1, 2, 3, 8]);

/** A value beyond the colors, and where it is on the body at rest, m. */
export interface Clipped {
  readonly end: "min" | "max";
  readonly value: number;
  readonly at: readonly [number, number, number];
}

export interface ColorRange {
  readonly low: number;
  readonly high: number;
  readonly clipped: readonly Clipped[];
}

const areasOf = new WeakMap<Topology, Float64Array>();
const area = new Float64Array(LEVELS);

/** The range of colors for a frame of a topology. */
export function colorRange(frame: Frame, topology: Topology): ColorRange {
  const whole = { low: frame.min, high: frame.max, clipped: [] };
  if (frame.max <= frame.min || OF_MOTION.has(frame.field)) return whole;
  const weights = areas(topology);
  area.fill(0);
  let total = 0;
  for (let vertex = 0; vertex < weights.length; vertex++) {
    area[frame.packed[4 * vertex + 3]!]! += weights[vertex]!;
    total += weights[vertex]!;
  }
  if (total === 0) return whole;
  const low = valueAt(frame, levelAt((1 - CLIP) * total));
  const high = valueAt(frame, levelAt(CLIP * total));
  const reach = FAR * (high - low);
  const clips = { min: frame.min < low - reach, max: frame.max > high + reach };
  const clipped: Clipped[] = [];
  if (clips.max) clipped.push(farthest(frame, topology, "max"));
  if (clips.min) clipped.push(farthest(frame, topology, "min"));
  return {
    low: clips.min ? low : frame.min,
    high: clips.max ? high : frame.max,
    clipped,
  };
}

/** A third of the triangles around each vertex at rest, m². */
function areas(topology: Topology): Float64Array {
  const known = areasOf.get(topology);
  if (known) return known;
  const { rest, triangles } = topology;
  const found = new Float64Array(rest.length / 3);
  const along = (from: number, to: number, axis: number) =>
    rest[3 * to + axis]! - rest[3 * from + axis]!;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!];
    const [ux, uy, uz] = [along(a, b, 0), along(a, b, 1), along(a, b, 2)];
    const [vx, vy, vz] = [along(a, c, 0), along(a, c, 1), along(a, c, 2)];
    const third = Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 6;
    for (const vertex of [a, b, c]) found[vertex]! += third;
  }
  areasOf.set(topology, found);
  return found;
}

/** The level that so much of the area is at or below. */
function levelAt(due: number): number {
  let below = 0;
  for (let level = 0; level < LEVELS; level++) {
    below += area[level]!;
    if (below >= due * (1 - 1e-9) && below > 0) return level;
  }
  return LEVELS - 1;
}

function valueAt(frame: Frame, level: number): number {
  return frame.min + ((frame.max - frame.min) * level) / (LEVELS - 1);
}

function farthest(frame: Frame, topology: Topology, end: "min" | "max"): Clipped {
  const sign = end === "max" ? 1 : -1;
  let found = 0;
  for (let vertex = 1; 4 * vertex < frame.packed.length; vertex++) {
    const farther = frame.packed[4 * vertex + 3]! - frame.packed[4 * found + 3]!;
    if (sign * farther > 0) found = vertex;
  }
  const { rest } = topology;
  const at = [rest[3 * found]!, rest[3 * found + 1]!, rest[3 * found + 2]!] as const;
  return { end, value: valueIn(frame, found), at };
}
