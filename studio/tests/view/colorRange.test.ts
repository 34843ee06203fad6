import { describe, expect, it } from "vitest";
import type { Frame, Topology } from "../../src/engine/frames";
import { colorRange } from "../../src/view/body/colorRange";

/** A strip of `count` squares along x, and a frame with given levels of 0 to 65535. */
function strip(count: number, level: (vertex: number) => number, range: [number, number]) {
  const rest = new Float32Array(6 * (count + 1));
  const triangles = new Uint32Array(6 * count);
  for (let i = 0; i <= count; i++) rest.set([i, 0, 0, i, 1, 0], 6 * i);
  for (let i = 0; i < count; i++) {
    const a = 2 * i;
    triangles.set([a, a + 2, a + 1, a + 1, a + 2, a + 3], 6 * i);
  }
  const packed = new Uint16Array(8 * (count + 1));
  for (let v = 0; v < 2 * (count + 1); v++) packed[4 * v + 3] = level(v);
  const topology = { rest, triangles } as unknown as Topology;
  const frame = { packed, field: 5, min: range[0], max: range[1] } as unknown as Frame;
  return { topology, frame };
}

describe("colorRange", () => {
  it("takes all values of a field without outliers", () => {
    const { topology, frame } = strip(100, (v) => Math.floor(v / 2) * 655, [0, 10]);
    expect(colorRange(frame, topology)).toEqual({ low: 0, high: 10, clipped: [] });
  });

  it("ends where 99 % of the area do, and says where the largest is", () => {
    // One vertex of 402 at 12.5 MPa, the others up to 15 kPa: levels of 191 Pa.
    const level = (v: number) => (v === 80 ? 65535 : Math.floor((v / 402) * 78));
    const { topology, frame } = strip(200, level, [0, 12.5e6]);
    const found = colorRange(frame, topology);
    expect(found.high).toBeLessThan(15e3);
    expect(found.high).toBeGreaterThan(14e3);
    expect(found.low).toBe(0);
    expect(found.clipped).toEqual([{ end: "max", value: 12.5e6, at: [40, 0, 0] }]);
  });

  it("clips the lower end likewise", () => {
    const level = (v: number) => (v === 81 ? 0 : 65134 + v);
    const { topology, frame } = strip(200, level, [-50, 1]);
    const found = colorRange(frame, topology);
    expect(found.clipped).toEqual([{ end: "min", value: -50, at: [40, 1, 0] }]);
    expect(found.low).toBeGreaterThan(-1);
  });

  it("weighs by area, not by vertices", () => {
    // The half with the high values is a thousand times as fine.
    const { topology, frame } = strip(100, (v) => (v < 104 ? 0 : 65535), [0, 1]);
    for (let v = 100; v < 202; v++) topology.rest[3 * v] = 50 + (topology.rest[3 * v]! - 50) / 1e3;
    expect(colorRange(frame, topology).clipped.map((one) => one.end)).toEqual(["max"]);
  });

  it("never clips the tip that moves most", () => {
    const { topology, frame } = strip(200, (v) => (v === 80 ? 65535 : 0), [0, 1]);
    const whole = { low: 0, high: 1, clipped: [] };
    expect(colorRange({ ...frame, field: 0 }, topology)).toEqual(whole);
  });

  it("leaves a field of one value alone", () => {
    const { topology, frame } = strip(3, () => 0, [2, 2]);
    expect(colorRange(frame, topology)).toEqual({ low: 2, high: 2, clipped: [] });
  });
});
