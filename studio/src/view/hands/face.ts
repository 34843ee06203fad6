// The flat face of the unloaded body that was pressed: its triangles, its plane, its surroundings.
import { Ray, Vector3 } from "three";
import type { Topology } from "../../engine/frames";
import { CAVITY } from "../../protocol";
import { pick } from "./pick";
import { type Seat, seatOf } from "./seat";

export type Axis = 0 | 1 | 2;
type Triple = readonly [number, number, number];

/** Cosine from which on two triangles lie in one plane: positions are single precision. */
const SAME_PLANE = 1 - 1e-6;
/** Cosine from which on a plane lies across an axis. */
const ACROSS = 1 - 1e-9;

export interface Face {
  readonly topology: number;
  /** Vertices of its triangles, three each. */
  readonly triangles: readonly number[];
  /** Its box, m. */
  readonly low: Triple;
  readonly high: Triple;
  /** Away from the material. */
  readonly normal: Triple;
  /** The axis that it lies across; null where it is oblique. */
  readonly axis: Axis | null;
  /** True if its plane holds vertices of the surface that are not its own. */
  readonly shared: boolean;
  /** The cavity that it bounds; null on the outside. */
  readonly cavity: number | null;
  /** The middle of the triangle that was pressed, m. */
  readonly point: Triple;
  /** Distance from there to the surface straight opposite, m; null where there is none. */
  readonly opposite: number | null;
  /** Seat of a plate on it; null where it is oblique. */
  readonly seat: Seat | null;
  readonly voxelSize: number;
}

function vertexOf(rest: Float32Array, i: number): Triple {
  return [rest[3 * i]!, rest[3 * i + 1]!, rest[3 * i + 2]!];
}

function normalOf(topology: Topology, triangle: number): Triple {
  const [a, b, c] = [0, 1, 2].map((i) =>
    vertexOf(topology.rest, topology.triangles[3 * triangle + i]!),
  ) as [Triple, Triple, Triple];
  const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]] as const;
  const v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]] as const;
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const size = Math.hypot(...n) || 1;
  return n.map((x) => x / size) as unknown as Triple;
}

const dot = (a: Triple, b: Triple) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The triangle of the surface with these corners, or else the one at the first that faces a way most. */
export function triangleAt(
  topology: Topology,
  corners: readonly [number, number, number],
  toEye: Triple,
): number | null {
  const { triangles } = topology;
  let best: number | null = null;
  let most = Number.NEGATIVE_INFINITY;
  for (let t = 0; 3 * t < triangles.length; t++) {
    const own = [triangles[3 * t]!, triangles[3 * t + 1]!, triangles[3 * t + 2]!];
    if (corners.every((corner, i) => corner === own[i])) return t;
    if (!own.includes(corners[0])) continue;
    const facing = dot(normalOf(topology, t), toEye);
    if (facing > most) [best, most] = [t, facing];
  }
  return best;
}

/**
 * All of the plane around a triangle that edges join to it.
 *
 * `smooth` are the vertices of the smooth surface, x, y, z of each in m, where there is one.
 */
export function faceAt(
  topology: Topology,
  triangle: number,
  smooth: ArrayLike<number> | null = null,
): Face {
  const { triangles, rest, owners, voxelSize } = topology;
  const normal = normalOf(topology, triangle);
  const inside = (owners[triangle]! & CAVITY) !== 0;
  const fits = (t: number) =>
    ((owners[t]! & CAVITY) !== 0) === inside && dot(normalOf(topology, t), normal) >= SAME_PLANE;
  const byEdge = new Map<string, number[]>();
  const edgesOf = (t: number) =>
    [0, 1, 2].map((i) => {
      const [a, b] = [triangles[3 * t + i]!, triangles[3 * t + ((i + 1) % 3)]!];
      return a < b ? `${a} ${b}` : `${b} ${a}`;
    });
  const height = (t: number) => dot(normal, vertexOf(rest, triangles[3 * t]!));
  const level = height(triangle);
  for (let t = 0; 3 * t < triangles.length; t++) {
    // Only triangles in the plane can belong to it.
    if (Math.abs(height(t) - level) > 1e-3 * voxelSize || !fits(t)) continue;
    for (const edge of edgesOf(t)) byEdge.set(edge, [...(byEdge.get(edge) ?? []), t]);
  }
  const found = new Set([triangle]);
  const open = [triangle];
  for (let t = open.pop(); t !== undefined; t = open.pop()) {
    for (const edge of edgesOf(t)) {
      for (const other of byEdge.get(edge) ?? []) {
        if (found.has(other)) continue;
        found.add(other);
        open.push(other);
      }
    }
  }
  const vertices = [...found].flatMap((t) => [0, 1, 2].map((i) => triangles[3 * t + i]!));
  const own = new Set(vertices);
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const vertex of own) {
    vertexOf(rest, vertex).forEach((x, axis) => {
      low[axis] = Math.min(low[axis]!, x);
      high[axis] = Math.max(high[axis]!, x);
    });
  }
  const axis = ([0, 1, 2] as const).find((one) => Math.abs(normal[one]) >= ACROSS) ?? null;
  let shared = false;
  for (let vertex = 0; 3 * vertex < rest.length && !shared; vertex++) {
    // A region catches vertices within half a voxel of it.
    const near = Math.abs(dot(normal, vertexOf(rest, vertex)) - level) <= 0.5 * voxelSize;
    shared = near && !own.has(vertex);
  }
  const corners = [0, 1, 2].map((i) => vertexOf(rest, triangles[3 * triangle + i]!));
  const point = [0, 1, 2].map((i) => corners.reduce((sum, one) => sum + one[i]! / 3, 0));
  // From a little off the face, which is not opposite itself.
  const off = 1e-3 * voxelSize;
  const from = new Vector3(...(point as [number, number, number]));
  const way = new Vector3(...normal);
  const hit = pick(new Ray(from.addScaledVector(way, off), way), rest, triangles);
  const seat = axis === null ? null : seatOf({ low, high, normal, voxelSize }, axis, rest, smooth);
  return {
    topology: topology.id,
    triangles: vertices,
    ...{ low, high, normal, axis, seat },
    shared,
    cavity: inside ? owners[triangle]! & ~CAVITY : null,
    point: point as unknown as Triple,
    opposite: hit && hit.distance + off,
    voxelSize,
  };
}
