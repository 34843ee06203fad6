import { describe, expect, it } from "vitest";
import { commonRange, stillOf } from "../../src/view/still/fetchStill";

const MAGIC = 0x31465856;

function head(bytes: number, kind: number, field = 0, id = 1): DataView {
  const view = new DataView(new ArrayBuffer(bytes));
  view.setUint32(0, MAGIC, true);
  view.setUint8(4, kind);
  view.setUint16(6, field, true);
  view.setUint32(8, id, true);
  return view;
}

// Three vertices and one triangle: one byte for its owner, and three to fill up.
function topology(id = 1): DataView {
  const view = head(64 + 36 + 12 + 8 + 4, 1, 0, id);
  view.setUint32(24, 3, true);
  view.setUint32(28, 1, true);
  view.setUint32(32, 1, true);
  for (const [i, vertex] of [0, 1, 2].entries()) view.setUint32(100 + 4 * i, vertex, true);
  view.setUint8(120, 128);
  return view;
}

function frame(field: number, max: number): DataView {
  const view = head(64 + 24, 2, field);
  view.setUint32(24, 3, true);
  view.setFloat32(60, max, true);
  view.setUint16(64 + 6, 7 * field, true);
  return view;
}

function joined(...parts: DataView[]): ArrayBuffer {
  const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.byteLength, 0));
  let at = 0;
  for (const part of parts) {
    bytes.set(new Uint8Array(part.buffer), at);
    at += part.byteLength;
  }
  return bytes.buffer;
}

describe("a body at rest", () => {
  it("is read as a surface and a frame for each field", () => {
    const still = stillOf(joined(topology(), frame(0, 0.5), frame(5, 2)));
    expect([...still.topology.triangles]).toEqual([0, 1, 2]);
    expect([...still.topology.owners]).toEqual([128]);
    expect([...still.frames.keys()]).toEqual([0, 5]);
    expect(still.frames.get(5)?.max).toBe(2);
    expect(still.frames.get(5)?.packed[3]).toBe(35);
  });

  it("has the objects around it, where there are any", () => {
    const alone = stillOf(joined(topology(), frame(0, 0.5)));
    expect(alone.objects).toBeNull();
    const beside = stillOf(joined(topology(), frame(0, 0.5), topology(2)));
    expect(beside.topology.id).toBe(1);
    expect(beside.objects?.id).toBe(2);
    expect([...(beside.objects?.triangles ?? [])]).toEqual([0, 1, 2]);
    // Objects alone are no body.
    expect(() => stillOf(joined(topology(2), frame(0, 1)))).toThrow("without a shape");
  });

  it("has the shape that cuts its voxels, before the objects", () => {
    expect(stillOf(joined(topology(), frame(0, 0.5))).smooth).toBeNull();
    // Three vertices and one triangle, with its owner.
    const shape = head(64 + 36 + 12 + 4, 3);
    shape.setUint32(24, 3, true);
    shape.setUint32(28, 1, true);
    shape.setFloat32(64, 0.25, true);
    const still = stillOf(joined(topology(), frame(0, 0.5), shape, topology(2)));
    expect(still.smooth?.vertices[0]).toBe(0.25);
    expect(still.objects?.id).toBe(2);
  });

  it("is refused where a part is missing", () => {
    expect(() => stillOf(joined(topology()))).toThrow("without a shape");
    expect(() => stillOf(joined(frame(0, 1)))).toThrow("without a shape");
    expect(() => stillOf(joined(topology(), frame(0, 1)).slice(0, -1))).toThrow("announced");
  });
});

it("shares one range of colors among all bodies", () => {
  const one = stillOf(joined(topology(), frame(5, 2)));
  const other = stillOf(joined(topology(), frame(5, 3), frame(6, 9)));
  expect(commonRange([one, other], 5)).toEqual({ low: 0, high: 3, clipped: false });
  expect(commonRange([one, other], 7)).toBeNull();
});
