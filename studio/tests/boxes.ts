// Surfaces of boxes for tests.
import type { Topology } from "../src/engine/frames";

/** Faces of boxes as two triangles each, outward; vertices of one box are shared. */
export function boxes(...all: { low: number[]; high: number[]; owner?: number }[]): Topology {
  const rest: number[] = [];
  const triangles: number[] = [];
  const owners: number[] = [];
  for (const { low, high, owner = 0 } of all) {
    const base = rest.length / 3;
    for (let i = 0; i < 8; i++)
      for (let axis = 0; axis < 3; axis++)
        rest.push(((i >> axis) & 1 ? high : low)[axis] as number);
    const quads = [
      [0, 4, 6, 2],
      [1, 3, 7, 5],
      [0, 1, 5, 4],
      [2, 6, 7, 3],
      [0, 2, 3, 1],
      [4, 5, 7, 6],
    ];
    for (const [a, b, c, d] of quads as [number, number, number, number][]) {
      triangles.push(...[a, b, c, a, c, d].map((one) => base + one));
      owners.push(owner, owner);
    }
  }
  return {
    kind: "topology",
    id: 7,
    tets: false,
    voxelSize: 0.005,
    rest: new Float32Array(rest),
    triangles: new Uint32Array(triangles),
    edges: new Uint32Array(),
    voxels: new Uint32Array(0),
    owners: new Uint8Array(owners),
  };
}
