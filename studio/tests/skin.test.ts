import { describe, expect, it } from "vitest";
import { Skin } from "../src/view/skin";

// Corners of a grid of 4 x 4 x 4 voxels of 5 mm.
const surface = new Float32Array(
  Array.from({ length: 125 }, (_, i) => [i % 5, Math.floor(i / 5) % 5, Math.floor(i / 25)])
    .flat()
    .map((one) => 0.005 * one),
);
const points = new Float32Array([0.0071, 0.0093, 0.0112, 0.013, 0.0101, 0.0062, 0.5, 0.5, 0.5]);

function moved(by: (x: number, y: number, z: number) => [number, number, number]): Float32Array {
  const out = new Float32Array(points.length);
  const far = new Float32Array(surface.length);
  for (let i = 0; i < surface.length; i += 3)
    far.set(by(surface[i]!, surface[i + 1]!, surface[i + 2]!), i);
  new Skin(points, surface, 0.005).move(points, far, out);
  return out;
}

describe("the smooth shape", () => {
  it("stays where nothing moves, and goes along where all does", () => {
    expect([...moved(() => [0, 0, 0])]).toEqual([...points]);
    const along = moved(() => [0.001, -0.002, 0.003]);
    for (let i = 0; i < points.length; i++) {
      expect(along[i]! - points[i]!).toBeCloseTo([0.001, -0.002, 0.003][i % 3]!, 7);
    }
  });

  it("is stretched as the voxels are, to a tenth of a voxel", () => {
    const stretched = moved((x) => [0.2 * x, 0, 0]);
    for (const i of [0, 3]) expect(Math.abs(stretched[i]! - 1.2 * points[i]!)).toBeLessThan(0.0005);
  });

  it("is moved by the nearest vertex where none is in reach", () => {
    const corner = moved((x, y, z) => (x + y + z > 0.059 ? [0.01, 0, 0] : [0, 0, 0]));
    expect(corner[6]).toBeCloseTo(0.51, 6);
    expect(corner[0]).toBe(points[0]);
  });
});
