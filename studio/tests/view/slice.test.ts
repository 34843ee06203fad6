import { Vector4 } from "three";
import { describe, expect, it } from "vitest";
import { slice } from "../../src/view/body/slice";

// Corner c of a cube of edge 2 at (c >> 2, c >> 1, c) & 1.
const corners = new Uint32Array([0, 1, 2, 3, 4, 5, 6, 7]);
const cube = new Float32Array(
  Array.from({ length: 8 }, (_, c) => [2 * ((c >> 2) & 1), 2 * ((c >> 1) & 1), 2 * (c & 1)]).flat(),
);
const field = (x: number, y: number, z: number) => 3 * x - y + 0.5 * z;
const values = new Float32Array(8);
for (let c = 0; c < 8; c++) values[c] = field(cube[3 * c]!, cube[3 * c + 1]!, cube[3 * c + 2]!);

function areaOf(points: readonly number[]): number {
  let sum = 0;
  for (let t = 0; t < points.length; t += 9) {
    const [a, b] = [3, 6].map((from) =>
      [0, 1, 2].map((k) => points[t + from + k]! - points[t + k]!),
    );
    const [u, v] = [a!, b!];
    const across = [0, 1, 2].map(
      (k) => u[(k + 1) % 3]! * v[(k + 2) % 3]! - u[(k + 2) % 3]! * v[(k + 1) % 3]!,
    );
    sum += Math.hypot(...across) / 2;
  }
  return sum;
}

describe("a cut through a voxel", () => {
  it("has the area of the plane within it", () => {
    expect(areaOf(slice(corners, cube, values, new Vector4(0, 0, 1, 0.5)).points)).toBeCloseTo(4);
    // Through the middles of six edges: a regular hexagon of side sqrt 2.
    const third = 1 / Math.sqrt(3);
    const hexagon = slice(corners, cube, values, new Vector4(third, third, third, 3 * third));
    expect(areaOf(hexagon.points)).toBeCloseTo(3 * Math.sqrt(3));
  });
  it("lies in the plane and has the field exactly where that is linear", () => {
    const plane = new Vector4(0.6, 0, 0.8, 1.1);
    const { points, values: cut } = slice(corners, cube, values, plane);
    expect(cut.length).toBeGreaterThan(5);
    for (let i = 0; i < cut.length; i++) {
      const [x, y, z] = [points[3 * i]!, points[3 * i + 1]!, points[3 * i + 2]!];
      expect(0.6 * x + 0.8 * z).toBeCloseTo(1.1);
      expect(cut[i]).toBeCloseTo(field(x, y, z), 5);
    }
  });
  it("is nothing beside it", () => {
    expect(slice(corners, cube, values, new Vector4(0, 0, 1, 2.5)).points).toEqual([]);
    expect(slice(corners, cube, values, new Vector4(0, 0, 1, -0.5)).points).toEqual([]);
  });
});
