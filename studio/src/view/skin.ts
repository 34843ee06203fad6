// How the smooth shape follows the voxels: each of its points is moved as the vertices of the
// surface near by are, the nearer the more.
import { nearest } from "./target";

/**
 * How far vertices reach, in voxels. The smooth shape is never a voxel away from the surface; less
 * than this shows the stairs of coarse voxels, and more lets the walls of a slit pull each other.
 */
const REACH = 1.75;

export class Skin {
  /** Of point i the vertices and shares `starts[i]` to `starts[i + 1]`. */
  private readonly starts: Uint32Array;
  private readonly vertices: number[] = [];
  private readonly shares: number[] = [];

  /** Both as x, y, z of each at rest; `voxel` is the size of a voxel. */
  constructor(points: Float32Array, surface: Float32Array, voxel: number) {
    const reach = REACH * voxel;
    const cells = cellsOf(surface, reach);
    this.starts = new Uint32Array(points.length / 3 + 1);
    for (let i = 0; i < points.length; i += 3) {
      this.bind(points[i]!, points[i + 1]!, points[i + 2]!, surface, reach, cells);
      this.starts[i / 3 + 1] = this.vertices.length;
    }
  }

  private bind(
    x: number,
    y: number,
    z: number,
    surface: Float32Array,
    reach: number,
    cells: Map<string, number[]>,
  ): void {
    const first = this.vertices.length;
    let sum = 0;
    const [cx, cy, cz] = [x, y, z].map((one) => Math.floor(one / reach)) as Cell;
    for (let i = cx - 1; i <= cx + 1; i++)
      for (let j = cy - 1; j <= cy + 1; j++)
        for (let k = cz - 1; k <= cz + 1; k++)
          for (const vertex of cells.get(`${i} ${j} ${k}`) ?? []) {
            const at = 3 * vertex;
            const far = Math.hypot(surface[at]! - x, surface[at + 1]! - y, surface[at + 2]! - z);
            if (far >= reach) continue;
            const share = (1 - far / reach) ** 2;
            this.vertices.push(vertex);
            this.shares.push(share);
            sum += share;
          }
    if (sum === 0) {
      this.vertices.push(nearest(surface, x, y, z));
      this.shares.push(1);
      sum = 1;
    }
    for (let i = first; i < this.shares.length; i++) this.shares[i]! /= sum;
  }

  /** Put `points`, moved as the surface has been, into `out`. */
  move(points: Float32Array, moved: Float32Array, out: Float32Array): void {
    for (let point = 0; point < this.starts.length - 1; point++) {
      let [x, y, z] = [points[3 * point]!, points[3 * point + 1]!, points[3 * point + 2]!];
      for (let i = this.starts[point]!; i < this.starts[point + 1]!; i++) {
        const [at, share] = [3 * this.vertices[i]!, this.shares[i]!];
        x += share * moved[at]!;
        y += share * moved[at + 1]!;
        z += share * moved[at + 2]!;
      }
      out[3 * point] = x;
      out[3 * point + 1] = y;
      out[3 * point + 2] = z;
    }
  }
}

type Cell = [number, number, number];

function cellsOf(vertices: Float32Array, size: number): Map<string, number[]> {
  const cells = new Map<string, number[]>();
  for (let i = 0; i < vertices.length; i += 3) {
    const key = `${Math.floor(vertices[i]! / size)} ${Math.floor(vertices[i + 1]! / size)} ${Math.floor(vertices[i + 2]! / size)}`;
    const cell = cells.get(key);
    if (cell) cell.push(i / 3);
    else cells.set(key, [i / 3]);
  }
  return cells;
}
