// Binary messages of the engine: a 64-byte header, then arrays that go to the GPU as they are.
import { FrameFlag, HEADER, MAGIC, MessageKind, TopologyFlag } from "../protocol";

export type Triple = readonly [number, number, number];

/** A body's surface at rest, once for each new body or kind of view. */
export interface Topology {
  readonly kind: "topology";
  readonly id: number;
  /** Each tet has its own four vertices, to be drawn shrunk. */
  readonly tets: boolean;
  readonly voxelSize: number;
  /** x, y, z of each vertex, m. */
  readonly rest: Float32Array;
  readonly triangles: Uint32Array;
  /** Edges of voxels, without face diagonals. */
  readonly edges: Uint32Array;
  /** The corners of each voxel, x, y, z in bits 2, 1, 0, for sections; empty unless asked for. */
  readonly voxels: Uint32Array;
  /** Index of the part of each triangle, or CAVITY + the cavity's index. */
  readonly owners: Uint8Array;
}

/** Positions of the vertices at one time, with one field's value at each. */
export interface Frame {
  readonly kind: "frame";
  readonly topology: number;
  readonly number: number;
  readonly time: number;
  /** Last command that the frame knows of. */
  readonly seq: number;
  readonly field: number;
  readonly paused: boolean;
  readonly diverged: boolean;
  readonly atRest: boolean;
  readonly origin: Triple;
  readonly scale: Triple;
  readonly min: number;
  readonly max: number;
  /** x, y, z, field of each vertex: position = origin + scale q / 65535. */
  readonly packed: Uint16Array;
}

/** Number of points of the surface: they come before those that voxels alone have. */
export function surfacePoints(topology: Topology): number {
  let last = -1;
  for (const point of topology.triangles) if (point > last) last = point;
  return last + 1;
}

/** The smooth surface of the shapes, at rest. */
export interface Smooth {
  readonly kind: "smooth";
  readonly topology: number;
  readonly vertices: Float32Array;
  readonly triangles: Uint32Array;
  /** Index of the part of each triangle. */
  readonly owners: Uint8Array;
}

export class FrameError extends Error {}

/** Read a binary message. Throws a FrameError where lengths and header disagree. */
export function decode(buffer: ArrayBuffer): Topology | Frame | Smooth {
  if (buffer.byteLength < HEADER) throw new FrameError(`message of ${buffer.byteLength} bytes`);
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) throw new FrameError("not a message of VoxSoft");
  const kind = view.getUint8(4);
  if (kind === MessageKind.TOPOLOGY) return topology(buffer, view);
  if (kind === MessageKind.FRAME) return frame(buffer, view);
  if (kind === MessageKind.SMOOTH) return smooth(buffer, view);
  throw new FrameError(`unknown kind ${kind}`);
}

/** Read messages that stand one behind the other, as answers over HTTP have them. */
export function decodeAll(buffer: ArrayBuffer): (Topology | Frame | Smooth)[] {
  const messages: (Topology | Frame | Smooth)[] = [];
  for (let at = 0; at < buffer.byteLength; ) {
    // A copy, as the arrays of a message must begin at whole multiples of their numbers' size.
    const message = decode(buffer.slice(at));
    messages.push(message);
    at += lengthOf(message);
  }
  return messages;
}

function lengthOf(message: Topology | Frame | Smooth): number {
  if (message.kind === "frame") return HEADER + message.packed.byteLength;
  const { triangles, owners } = message;
  const parts =
    message.kind === "smooth"
      ? [message.vertices, triangles, owners]
      : [message.rest, triangles, message.edges, message.voxels, owners];
  const bytes = parts.reduce((sum, part) => sum + part.byteLength, 0);
  return HEADER + bytes + (-bytes & 3);
}

function topology(buffer: ArrayBuffer, view: DataView): Topology {
  const n = view.getUint32(24, true);
  const t = view.getUint32(28, true);
  const e = view.getUint32(32, true);
  const v = view.getUint32(36, true);
  need(buffer, HEADER + 12 * n + 12 * t + 8 * e + 32 * v + t);
  const trianglesAt = HEADER + 12 * n;
  const edgesAt = trianglesAt + 12 * t;
  const voxelsAt = edgesAt + 8 * e;
  return {
    kind: "topology",
    id: view.getUint32(8, true),
    tets: (view.getUint8(5) & TopologyFlag.SHRUNK_TETS) !== 0,
    voxelSize: view.getFloat64(16, true),
    rest: new Float32Array(buffer, HEADER, 3 * n),
    triangles: new Uint32Array(buffer, trianglesAt, 3 * t),
    edges: new Uint32Array(buffer, edgesAt, 2 * e),
    voxels: new Uint32Array(buffer, voxelsAt, 8 * v),
    owners: new Uint8Array(buffer, voxelsAt + 32 * v, t),
  };
}

function frame(buffer: ArrayBuffer, view: DataView): Frame {
  const n = view.getUint32(24, true);
  need(buffer, HEADER + 8 * n);
  const flags = view.getUint8(5);
  return {
    kind: "frame",
    topology: view.getUint32(8, true),
    number: view.getUint32(12, true),
    time: view.getFloat64(16, true),
    seq: view.getUint32(28, true),
    field: view.getUint16(6, true),
    paused: (flags & FrameFlag.PAUSED) !== 0,
    diverged: (flags & FrameFlag.DIVERGED) !== 0,
    atRest: (flags & FrameFlag.AT_REST) !== 0,
    origin: triple(view, 32),
    scale: triple(view, 44),
    min: view.getFloat32(56, true),
    max: view.getFloat32(60, true),
    packed: new Uint16Array(buffer, HEADER, 4 * n),
  };
}

function smooth(buffer: ArrayBuffer, view: DataView): Smooth {
  const n = view.getUint32(24, true);
  const t = view.getUint32(28, true);
  need(buffer, HEADER + 12 * n + 13 * t);
  return {
    kind: "smooth",
    topology: view.getUint32(8, true),
    vertices: new Float32Array(buffer, HEADER, 3 * n),
    triangles: new Uint32Array(buffer, HEADER + 12 * n, 3 * t),
    owners: new Uint8Array(buffer, HEADER + 12 * n + 12 * t, t),
  };
}

function triple(view: DataView, at: number): Triple {
  return [view.getFloat32(at, true), view.getFloat32(at + 4, true), view.getFloat32(at + 8, true)];
}

function need(buffer: ArrayBuffer, bytes: number): void {
  if (buffer.byteLength < bytes) {
    throw new FrameError(`${bytes} bytes announced, ${buffer.byteLength} came`);
  }
}

/** Position of a vertex in a frame, m. */
export function positionIn(frame: Frame, vertex: number): [number, number, number] {
  const at = 4 * vertex;
  const along = (axis: 0 | 1 | 2) =>
    frame.origin[axis] + (frame.scale[axis] * (frame.packed[at + axis] ?? 0)) / 65535;
  return [along(0), along(1), along(2)];
}

/** The field's value at a vertex of a frame. */
export function valueIn(frame: Frame, vertex: number): number {
  return frame.min + ((frame.max - frame.min) * (frame.packed[4 * vertex + 3] ?? 0)) / 65535;
}
