// Motion of the smooth shape with the voxels: each of its points is moved as the vertices of the
// surface near by are, the nearer the more, and so are its values. Vertices that face another way
// are of another side: of the wall across a slit, or of the other side of a thin wall.
import { nearest } from "../hands/target";

/**
 * Reach of vertices, in voxels. The smooth shape is never a voxel away from the surface; less
 * than this shows the stairs of coarse voxels, and more lets the walls of a slit pull each other.
 */
const REACH = 1.75;
/** Cosine between the normals of a point and a vertex from which on they are of one side. */
const SAME_SIDE = -0.3;

/** A surface: x, y, z of its vertices, and their normals of any length. */
export interface Side {
  readonly points: Float32Array;
  readonly normals: Float32Array;
}

/** Normals at the vertices of triangles, the larger the triangles are. */
export function normalsOf(points: Float32Array, triangles: Uint32Array): Float32Array {
  const normals = new Float32Array(points.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t]!, 3 * triangles[t + 1]!, 3 * triangles[t + 2]!];
    const along = (from: number, to: number, axis: number) =>
      points[to + axis]! - points[from + axis]!;
    for (let axis = 0; axis < 3; axis++) {
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      const normal = along(a, b, u) * along(a, c, v) - along(a, b, v) * along(a, c, u);
      for (const at of [a, b, c]) normals[at + axis]! += normal;
    }
  }
  return normals;
}

export class Skin {
  /** Vertices and shares of point i are at `starts[i]` to `starts[i + 1]`. */
  private readonly starts: Uint32Array;
  private readonly vertices: number[] = [];
  private readonly shares: number[] = [];

  /** Both as they are unloaded; `voxel` is the size of a voxel. */
  constructor(shape: Side, surface: Side, voxel: number) {
    const reach = REACH * voxel;
    const cells = cellsOf(surface.points, reach);
    this.starts = new Uint32Array(shape.points.length / 3 + 1);
    for (let i = 0; i < shape.points.length; i += 3) {
      this.bind(shape, i, surface, reach, cells);
      this.starts[i / 3 + 1] = this.vertices.length;
    }
  }

  private bind(
    shape: Side,
    at: number,
    { points: surface, normals }: Side,
    reach: number,
    cells: Map<string, number[]>,
  ): void {
    const [x, y, z] = shape.points.subarray(at, at + 3) as unknown as Cell;
    const first = this.vertices.length;
    let sum = 0;
    const [cx, cy, cz] = [x, y, z].map((one) => Math.floor(one / reach)) as Cell;
    for (let i = cx - 1; i <= cx + 1; i++)
      for (let j = cy - 1; j <= cy + 1; j++)
        for (let k = cz - 1; k <= cz + 1; k++)
          for (const vertex of cells.get(`${i} ${j} ${k}`) ?? []) {
            const to = 3 * vertex;
            const far = Math.hypot(surface[to]! - x, surface[to + 1]! - y, surface[to + 2]! - z);
            if (far >= reach || cosine(shape.normals, at, normals, to) < SAME_SIDE) continue;
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

  /** Take the shares of values at the vertices of the surface, each `stride` numbers apart. */
  values(of: Uint16Array, stride: number, offset: number, out: Float32Array): void {
    for (let point = 0; point < this.starts.length - 1; point++) {
      let sum = 0;
      for (let i = this.starts[point]!; i < this.starts[point + 1]!; i++)
        sum += this.shares[i]! * of[stride * this.vertices[i]! + offset]!;
      out[point] = sum;
    }
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

/** The cosine between two vectors of lists; 1 where one of them is nothing. */
function cosine(a: Float32Array, i: number, b: Float32Array, j: number): number {
  const [ax, ay, az] = [a[i]!, a[i + 1]!, a[i + 2]!];
  const [bx, by, bz] = [b[j]!, b[j + 1]!, b[j + 2]!];
  const lengths = Math.hypot(ax, ay, az) * Math.hypot(bx, by, bz);
  return lengths > 0 ? (ax * bx + ay * by + az * bz) / lengths : 1;
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
