// Which point of the body is under the pointer. All triangles are tried, on the positions that
// are drawn: a few milliseconds for bodies of some 30,000 triangles, once for each press.
import { type Ray, Vector3 } from "three";

// Shares of a triangle by which a ray may pass beside it: none slips through between two.
const SLACK = 1e-9;

export interface Hit {
  readonly vertex: number;
  readonly triangle: readonly [number, number, number];
  /** Shares of the triangle's corners. */
  readonly weights: readonly [number, number, number];
  readonly point: Vector3;
  readonly distance: number;
}

/**
 * First point of a ray on triangles whose vertices lie at `positions` (x, y, z of each).
 * Triangles that `keep` refuses, such as on the side that a section cuts away, are passed through.
 */
export function pick(
  ray: Ray,
  positions: Float32Array,
  triangles: Uint32Array,
  keep: (point: Vector3) => boolean = () => true,
): Hit | null {
  const { x: ox, y: oy, z: oz } = ray.origin;
  const { x: dx, y: dy, z: dz } = ray.direction;
  let best = Number.POSITIVE_INFINITY;
  let found = -1;
  let [bu, bv] = [0, 0];
  const point = new Vector3();
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t]!;
    const b = 3 * triangles[t + 1]!;
    const c = 3 * triangles[t + 2]!;
    const ax = positions[a]!;
    const ay = positions[a + 1]!;
    const az = positions[a + 2]!;
    const e1x = positions[b]! - ax;
    const e1y = positions[b + 1]! - ay;
    const e1z = positions[b + 2]! - az;
    const e2x = positions[c]! - ax;
    const e2y = positions[c + 1]! - ay;
    const e2z = positions[c + 2]! - az;
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const det = e1x * px + e1y * py + e1z * pz;
    if (det === 0) continue;
    const inverse = 1 / det;
    const sx = ox - ax;
    const sy = oy - ay;
    const sz = oz - az;
    const u = (sx * px + sy * py + sz * pz) * inverse;
    if (u < -SLACK || u > 1 + SLACK) continue;
    const qx = sy * e1z - sz * e1y;
    const qy = sz * e1x - sx * e1z;
    const qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) * inverse;
    if (v < -SLACK || u + v > 1 + SLACK) continue;
    const distance = (e2x * qx + e2y * qy + e2z * qz) * inverse;
    if (distance <= 0 || distance >= best) continue;
    if (!keep(ray.at(distance, point))) continue;
    best = distance;
    found = t;
    [bu, bv] = [u, v];
  }
  if (found < 0) return null;
  const corners = [triangles[found]!, triangles[found + 1]!, triangles[found + 2]!] as const;
  const weights = [1 - bu - bv, bu, bv] as const;
  const nearest = weights.indexOf(Math.max(...weights));
  return {
    vertex: corners[nearest] as number,
    triangle: corners,
    weights,
    point: ray.at(best, new Vector3()),
    distance: best,
  };
}
