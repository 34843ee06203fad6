// Cut of a plane through voxels: the polygons of the cut, with the field at their corners.
import type { Vector4 } from "three";

/** A voxel as six tetrahedra around its diagonal from corner 0 to corner 7. */
const TETS: readonly (readonly [number, number, number, number])[] = [
  [0, 7, 1, 3],
  [0, 7, 3, 2],
  [0, 7, 2, 6],
  [0, 7, 6, 4],
  [0, 7, 4, 5],
  [0, 7, 5, 1],
];

/** Triangles of a cut: x, y, z and the value at each corner. */
export interface Slice {
  readonly points: number[];
  readonly values: number[];
}

/**
 * Cut voxels by the plane where `x a + y b + z c = w`.
 *
 * `corners` are eight of `positions` (x, y, z each) for each voxel, `values` one for each position. Within a
 * tetrahedron both are linear, so that a field linear in space is cut exactly.
 */
export function slice(
  corners: Uint32Array,
  positions: Float32Array,
  values: Float32Array,
  plane: Vector4,
): Slice {
  const heights = new Float32Array(values.length);
  for (let i = 0; i < heights.length; i++) {
    const at = 3 * i;
    heights[i] =
      plane.x * positions[at]! +
      plane.y * positions[at + 1]! +
      plane.z * positions[at + 2]! -
      plane.w;
  }
  const found: Slice = { points: [], values: [] };
  for (let voxel = 0; voxel < corners.length; voxel += 8) {
    let [low, high] = [Infinity, -Infinity];
    for (let corner = 0; corner < 8; corner++) {
      const height = heights[corners[voxel + corner]!]!;
      low = Math.min(low, height);
      high = Math.max(high, height);
    }
    if (low >= 0 || high < 0) continue;
    for (const tet of TETS) {
      const own = tet.map((corner) => corners[voxel + corner]!);
      const below = own.filter((vertex) => heights[vertex]! < 0);
      const above = own.filter((vertex) => heights[vertex]! >= 0);
      if (below.length === 0 || above.length === 0) continue;
      // Around the cut: three crossings beside one corner alone, or four between two pairs.
      const [a, b] = [below, above];
      const ways: readonly (readonly [number, number])[] =
        a.length === 2
          ? [
              [a[0]!, b[0]!],
              [a[0]!, b[1]!],
              [a[1]!, b[1]!],
              [a[1]!, b[0]!],
            ]
          : a.length === 1
            ? b.map((other) => [a[0]!, other])
            : a.map((other) => [other, b[0]!]);
      for (let i = 1; i + 1 < ways.length; i++) {
        for (const [from, to] of [ways[0]!, ways[i]!, ways[i + 1]!]) {
          const share = heights[from]! / (heights[from]! - heights[to]!);
          for (let axis = 0; axis < 3; axis++) {
            const start = positions[3 * from + axis]!;
            found.points.push(start + share * (positions[3 * to + axis]! - start));
          }
          found.values.push(values[from]! + share * (values[to]! - values[from]!));
        }
      }
    }
  }
  return found;
}
