import { describe, expect, it } from "vitest";
import { normalsOf, Skin } from "../../src/view/body/skin";

// Corners of a grid of 4 x 4 x 4 voxels of 5 mm.
const surface = new Float32Array(
  Array.from({ length: 125 }, (_, i) => [i % 5, Math.floor(i / 5) % 5, Math.floor(i / 25)])
    .flat()
    .map((one) => 0.005 * one),
);
const points = new Float32Array([0.0071, 0.0093, 0.0112, 0.013, 0.0101, 0.0062, 0.5, 0.5, 0.5]);

/** Points whose normals are unknown: all of them count. */
const side = (of: Float32Array, normals = new Float32Array(of.length)) => ({ points: of, normals });

function moved(by: (x: number, y: number, z: number) => [number, number, number]): Float32Array {
  const out = new Float32Array(points.length);
  const far = new Float32Array(surface.length);
  for (let i = 0; i < surface.length; i += 3)
    far.set(by(surface[i]!, surface[i + 1]!, surface[i + 2]!), i);
  new Skin(side(points), side(surface), 0.005).move(points, far, out);
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

  it("does not take the far wall of a slit for its own", () => {
    // Two walls that face each other over a voxel of 5 mm; only the right one moves.
    const walls = new Float32Array(
      [0, 0.005].flatMap((x) => [0, 1, 2].flatMap((j) => [0, 1, 2].flatMap((k) => [x, j, k]))),
    ).map((one, i) => (i % 3 === 0 ? one : 0.005 * one));
    const normals = walls.map((_, i) => (i % 3 === 0 ? (walls[i] === 0 ? 1 : -1) : 0));
    const on = new Float32Array([0, 0.0061, 0.0047, 0.005, 0.0061, 0.0047]);
    const facing = new Float32Array([1, 0, 0, -1, 0, 0]);
    const far = walls.map((_, i) => (i % 3 === 0 && walls[i]! > 0 ? 0.004 : 0));
    const skin = new Skin(side(on, facing), side(walls, normals), 0.005);
    const out = new Float32Array(6);
    skin.move(on, far, out);
    expect(out[0]).toBeCloseTo(0, 9);
    expect(out[3]).toBeCloseTo(0.009, 9);
    // Values come from the own wall as well.
    const values = new Uint16Array(walls.map((_, i) => (walls[i - (i % 3)] === 0 ? 100 : 900)));
    const found = new Float32Array(2);
    skin.values(values, 3, 0, found);
    expect(found[0]).toBeCloseTo(100, 3);
    expect(found[1]).toBeCloseTo(900, 3);
  });

  it("has normals that point out of its triangles", () => {
    const corner = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
    expect([...normalsOf(corner, new Uint32Array([0, 1, 2]))]).toEqual([0, 0, 1, 0, 0, 1, 0, 0, 1]);
  });
});
