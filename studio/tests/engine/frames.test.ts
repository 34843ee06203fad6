import { describe, expect, it } from "vitest";
import { FrameGate } from "../../src/engine/credits";
import {
  decode,
  type Frame,
  FrameError,
  positionIn,
  type Topology,
  valueIn,
} from "../../src/engine/frames";

const MAGIC = 0x31465856;

function frameBytes(positions: number[][], number = 7): ArrayBuffer {
  const buffer = new ArrayBuffer(64 + 8 * positions.length);
  const view = new DataView(buffer);
  view.setUint32(0, MAGIC, true);
  view.setUint8(4, 2);
  view.setUint8(5, 2 | 1);
  view.setUint16(6, 5, true);
  view.setUint32(8, 3, true);
  view.setUint32(12, number, true);
  view.setFloat64(16, 0.25, true);
  view.setUint32(24, positions.length, true);
  view.setUint32(28, 42, true);
  for (const [i, value] of [-0.01, 0, 0.5, 0.02, 0.1, 2].entries()) {
    view.setFloat32(32 + 4 * i, value, true);
  }
  view.setFloat32(56, -1, true);
  view.setFloat32(60, 3, true);
  positions.flat().forEach((q, i) => {
    view.setUint16(64 + 2 * i, q, true);
  });
  return buffer;
}

describe("decode", () => {
  it("reads a frame's header and places its vertices", () => {
    const frame = decode(
      frameBytes([
        [0, 65535, 32768, 65535],
        [65535, 0, 0, 0],
      ]),
    ) as Frame;
    expect(frame.kind).toBe("frame");
    expect([frame.topology, frame.number, frame.seq, frame.field]).toEqual([3, 7, 42, 5]);
    expect([frame.paused, frame.diverged, frame.atRest]).toEqual([true, true, false]);
    const [x, y, z] = positionIn(frame, 0);
    // Origin and scale travel as float32: seven digits.
    expect(x).toBeCloseTo(-0.01, 8);
    expect(y).toBeCloseTo(0.1, 8);
    expect(z).toBeCloseTo(0.5 + (2 * 32768) / 65535, 6);
    expect(valueIn(frame, 0)).toBe(3);
    expect(valueIn(frame, 1)).toBe(-1);
  });

  it("reads a topology with its owners behind odd lengths", () => {
    const [n, t, e] = [4, 3, 5];
    const buffer = new ArrayBuffer(64 + 12 * n + 12 * t + 8 * e + 4);
    const view = new DataView(buffer);
    view.setUint32(0, MAGIC, true);
    view.setUint8(4, 1);
    view.setUint8(5, 2);
    view.setUint32(8, 9, true);
    view.setFloat64(16, 0.005, true);
    view.setUint32(24, n, true);
    view.setUint32(28, t, true);
    view.setUint32(32, e, true);
    view.setFloat32(64 + 12 * n - 4, 1.5, true);
    view.setUint32(64 + 12 * n, 3, true);
    view.setUint32(64 + 12 * (n + t), 2, true);
    view.setUint8(64 + 12 * (n + t) + 8 * e + 2, 0x81);
    const topology = decode(buffer) as Topology;
    expect(topology.rest[3 * n - 1]).toBe(1.5);
    expect(topology.triangles[0]).toBe(3);
    expect(topology.edges[0]).toBe(2);
    expect([...topology.owners]).toEqual([0, 0, 0x81]);
    expect([topology.id, topology.tets, topology.voxelSize]).toEqual([9, true, 0.005]);
  });

  it("refuses short, foreign or unknown messages", () => {
    expect(() => decode(new ArrayBuffer(10))).toThrow(FrameError);
    expect(() => decode(new ArrayBuffer(64))).toThrow("not a message");
    const cut = frameBytes([[1, 2, 3, 4]]).slice(0, 68);
    expect(() => decode(cut)).toThrow("announced");
    const strange = frameBytes([]);
    new DataView(strange).setUint8(4, 9);
    expect(() => decode(strange)).toThrow("unknown kind 9");
  });
});

describe("FrameGate", () => {
  const frame = (number: number) => decode(frameBytes([], number)) as Frame;

  it("shows the newest frame and returns every credit when the page draws", () => {
    const gate = new FrameGate();
    const acknowledged: number[] = [];
    gate.offer(frame(1));
    gate.offer(frame(2));
    expect(acknowledged).toEqual([]);
    expect(gate.take((n) => acknowledged.push(n))?.number).toBe(2);
    expect(acknowledged).toEqual([1, 2]);
    expect(gate.take((n) => acknowledged.push(n))).toBeNull();
    expect(acknowledged).toEqual([1, 2]);
  });

  it("owes nothing after a new connection", () => {
    const gate = new FrameGate();
    gate.offer(frame(1));
    gate.clear();
    const acknowledged: number[] = [];
    expect(gate.take((n) => acknowledged.push(n))).toBeNull();
    expect(acknowledged).toEqual([]);
  });
});
