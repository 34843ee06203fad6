// The body on the GPU: one set of vertex attributes, which frames replace, and a draw call for
// each part and cavity.
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  GLSL3,
  Group,
  type IUniform,
  LinearFilter,
  LineSegments,
  Mesh,
  ShaderMaterial,
  Vector2,
  Vector3,
  Vector4,
} from "three";
import type { Frame, Topology } from "../../engine/frames";
import { type BodyLayer, CAVITY } from "../../protocol";
import type { View } from "../../store/view";
import { BODY_FRAGMENT, BODY_VERTEX, EDGE_FRAGMENT, EDGE_VERTEX } from "../drawing/shaders";
import { texels } from "./colormaps";
import { type Membrane, membraneOn } from "./membranes";
import { stencilPair } from "./stencil";

/** Colors of cavities, after Okabe and Ito; the same as in body.css. */
export const CAVITY_COLORS = [
  "#56b4e9",
  "#e78ac3",
  "#2fc39b",
  "#e8dd55",
  "#b9a2f5",
  "#e8704a",
] as const;

interface Shell {
  readonly owner: number;
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  readonly stencils: readonly Mesh<BufferGeometry, ShaderMaterial>[];
}

type Uniforms = Record<string, IUniform>;

/** Sort triangles by owner, so that each owner is one range of the index. */
export function rangesByOwner(
  triangles: Uint32Array,
  owners: Uint8Array,
): { index: Uint32Array; ranges: { owner: number; start: number; count: number }[] } {
  const counts = new Uint32Array(256);
  for (const owner of owners) counts[owner]! += 1;
  const ranges: { owner: number; start: number; count: number }[] = [];
  const next = new Uint32Array(256);
  let start = 0;
  for (let owner = 0; owner < 256; owner++) {
    const count = counts[owner]!;
    next[owner] = start;
    if (count > 0) ranges.push({ owner, start: 3 * start, count: 3 * count });
    start += count;
  }
  const index = new Uint32Array(triangles.length);
  for (let t = 0; t < owners.length; t++) {
    const at = 3 * next[owners[t]!]!++;
    index[at] = triangles[3 * t]!;
    index[at + 1] = triangles[3 * t + 1]!;
    index[at + 2] = triangles[3 * t + 2]!;
  }
  return { index, ranges };
}

export class BodyMesh {
  readonly group = new Group();
  readonly topology: Topology;
  frame: Frame | null = null;
  triangles = 0;
  private readonly attribute: BufferAttribute;
  private readonly shells: Shell[] = [];
  private readonly edges: LineSegments<BufferGeometry, ShaderMaterial>;
  private readonly ghost: LineSegments<BufferGeometry, ShaderMaterial>;
  private readonly geometries: BufferGeometry[] = [];
  private readonly rest: BufferAttribute;
  private membranes: Membrane[] = [];
  private readonly shared: Uniforms;
  private readonly lut: DataTexture;
  private readonly bounds = new Box3();

  constructor(
    topology: Topology,
    lighting: { plane: IUniform<Vector4>; section: IUniform<number> },
  ) {
    this.topology = topology;
    const n = topology.rest.length / 3;
    const rest = new BufferAttribute(topology.rest, 3);
    this.rest = rest;
    this.attribute = new BufferAttribute(new Uint16Array(4 * n), 4, true);
    this.attribute.setUsage(35048); // DYNAMIC_DRAW
    this.lut = new DataTexture(texels("viridis", 0), 256, 1);
    this.lut.minFilter = this.lut.magFilter = LinearFilter;
    this.lut.needsUpdate = true;
    this.shared = {
      uOrigin: { value: new Vector3() },
      uScale: { value: new Vector3() },
      uExaggeration: { value: 0 },
      uPlane: lighting.plane,
      uSection: lighting.section,
      uLut: { value: this.lut },
      uFrameRange: { value: new Vector2(0, 1) },
      uRange: { value: new Vector2(0, 1) },
    };
    const { index, ranges } = rangesByOwner(topology.triangles, topology.owners);
    const attribute = new BufferAttribute(index, 1);
    for (const range of ranges) this.shells.push(this.shell(rest, attribute, range));
    this.edges = this.lines(rest, this.shared);
    this.edges.renderOrder = 4;
    // The ghost is the same edges with nothing added to the shape at rest.
    this.ghost = this.lines(rest, { ...this.shared, uExaggeration: { value: 0 } });
    this.ghost.renderOrder = 3;
    this.group.add(this.edges, this.ghost);
  }

  private geometry(rest: BufferAttribute, index: BufferAttribute): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", rest);
    geometry.setAttribute("packed", this.attribute);
    geometry.setIndex(index);
    this.geometries.push(geometry);
    return geometry;
  }

  private shell(
    rest: BufferAttribute,
    index: BufferAttribute,
    range: { owner: number; start: number; count: number },
  ): Shell {
    const geometry = this.geometry(rest, index);
    geometry.setDrawRange(range.start, range.count);
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: BODY_VERTEX,
      fragmentShader: BODY_FRAGMENT,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      uniforms: {
        ...this.shared,
        uByField: { value: 1 },
        uOwn: { value: new Color("#e8b88a") },
        uAlpha: { value: 1 },
      },
    });
    const mesh = new Mesh(geometry, material);
    mesh.renderOrder = 2;
    mesh.frustumCulled = false;
    const stencils = [...stencilPair(geometry, BODY_VERTEX, this.shared)];
    this.group.add(mesh, ...stencils);
    return { owner: range.owner, mesh, stencils };
  }

  private lines(
    rest: BufferAttribute,
    uniforms: Uniforms,
  ): LineSegments<BufferGeometry, ShaderMaterial> {
    const geometry = this.geometry(rest, new BufferAttribute(this.topology.edges, 1));
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: EDGE_VERTEX,
      fragmentShader: EDGE_FRAGMENT,
      transparent: true,
      depthWrite: false,
      uniforms: {
        ...uniforms,
        uVoxelSize: { value: this.topology.voxelSize || 1 },
        uPixels: { value: 1 },
        uFade: { value: 1 },
        uByField: { value: 0 },
        uInk: { value: new Vector4(0, 0, 0, 0.4) },
      },
    });
    const lines = new LineSegments(geometry, material);
    lines.frustumCulled = false;
    return lines;
  }

  /** Draws the layers of the body, if they are not there yet. */
  cover(layers: readonly BodyLayer[]): void {
    if (this.membranes.length > 0) return;
    this.membranes = layers.map((layer) => {
      const index = new BufferAttribute(new Uint32Array(layer.triangles), 1);
      return membraneOn(this.geometry(this.rest, index), this.shared);
    });
    for (const membrane of this.membranes) this.group.add(membrane);
  }

  /** The map of colors, and the range of the field in the frame and in the map. */
  get coloring(): { lut: DataTexture; frame: Vector2; range: Vector2 } {
    const { uFrameRange, uRange } = this.shared;
    return { lut: this.lut, frame: uFrameRange!.value, range: uRange!.value };
  }

  /** Check if a frame is one of this body in this kind of view. */
  suits(frame: Frame): boolean {
    return (
      frame.topology === this.topology.id && frame.packed.length === this.attribute.array.length
    );
  }

  setFrame(frame: Frame): void {
    this.frame = frame;
    this.attribute.array = frame.packed as Uint16Array<ArrayBuffer>;
    this.attribute.needsUpdate = true;
    (this.shared.uOrigin!.value as Vector3).fromArray(frame.origin);
    (this.shared.uScale!.value as Vector3).fromArray(frame.scale);
    (this.shared.uFrameRange!.value as Vector2).set(frame.min, frame.max);
  }

  setRange(low: number, high: number): void {
    (this.shared.uRange!.value as Vector2).set(low, high);
  }

  /** Height of the picture in device pixels, halved: the measure for the fading of edges. */
  setPixels(half_height: number): void {
    this.edges.material.uniforms.uPixels!.value = half_height;
    this.ghost.material.uniforms.uPixels!.value = half_height;
  }

  private lutKey = "";

  /** `covered` is true where the smooth shape is drawn in place of the voxels. */
  style(
    view: View,
    colors: { parts: readonly string[]; ink: Color },
    visible: boolean,
    covered = false,
  ): void {
    const key = `${view.colormap} ${view.bands}`;
    if (key !== this.lutKey) {
      this.lutKey = key;
      (this.lut.image.data as Uint8Array).set(texels(view.colormap, view.bands));
      this.lut.minFilter = this.lut.magFilter = LinearFilter;
      this.lut.needsUpdate = true;
    }
    this.shared.uExaggeration!.value = this.frame ? view.exaggeration : 0;
    const wire = view.appearance === "wireframe";
    const cut = view.section !== "off";
    this.triangles = 0;
    for (const { owner, mesh, stencils } of this.shells) {
      const cavity = (owner & CAVITY) !== 0;
      const { uniforms } = mesh.material;
      const through = view.cavities && !cavity;
      // If the field is the same everywhere, as before the first step, a map shows nothing.
      const flat = !this.frame || this.frame.max <= this.frame.min;
      const by_field = view.coloring === "field" && !flat && !(view.cavities && cavity);
      uniforms.uByField!.value = by_field ? 1 : 0;
      uniforms.uAlpha!.value = through ? 0.16 : 1;
      const own = cavity
        ? view.cavities
          ? CAVITY_COLORS[(owner & 0x7f) % CAVITY_COLORS.length]!
          : (colors.parts[0] ?? "#e8b88a")
        : (colors.parts[owner] ?? "#e8b88a");
      (uniforms.uOwn!.value as Color).set(own);
      if (mesh.material.transparent !== through) {
        mesh.material.transparent = through;
        mesh.material.depthWrite = !through;
        mesh.material.needsUpdate = true;
      }
      mesh.renderOrder = through ? 5 : 2;
      mesh.visible = visible && !covered && !wire;
      if (mesh.visible) this.triangles += mesh.geometry.drawRange.count / 3;
      for (const stencil of stencils) stencil.visible = mesh.visible && cut && !this.topology.tets;
    }
    const ink = this.edges.material.uniforms.uInk!.value as Vector4;
    if (wire) ink.set(colors.ink.r, colors.ink.g, colors.ink.b, 0.75);
    else ink.set(0, 0, 0, view.cavities ? 0.12 : 0.42);
    this.edges.material.uniforms.uFade!.value = wire ? 0 : 1;
    const flatField = !this.frame || this.frame.max <= this.frame.min;
    this.edges.material.uniforms.uByField!.value =
      wire && view.coloring === "field" && !flatField ? 1 : 0;
    this.edges.visible = visible && !covered && (wire || view.edges);
    const ghost = this.ghost.material.uniforms;
    (ghost.uInk!.value as Vector4).set(colors.ink.r, colors.ink.g, colors.ink.b, 0.3);
    ghost.uFade!.value = 0;
    this.ghost.visible = visible && view.ghost;
    for (const membrane of this.membranes) membrane.visible = visible && view.symbols;
  }

  /** Bounds as drawn. */
  box(exaggeration: number): Box3 {
    if (!this.frame) return this.bounds.setFromArray(this.topology.rest);
    const low = new Vector3().fromArray(this.frame.origin);
    const high = low.clone().add(new Vector3().fromArray(this.frame.scale));
    this.bounds.set(low, high);
    if (exaggeration !== 1) {
      this.bounds.makeEmpty();
      const at = new Vector3();
      const n = this.topology.rest.length / 3;
      for (let i = 0; i < n; i++) this.bounds.expandByPoint(this.place(i, exaggeration, at));
    }
    return this.bounds;
  }

  /** Position where a vertex is drawn. */
  place(vertex: number, exaggeration: number, out = new Vector3()): Vector3 {
    const { rest } = this.topology;
    out.set(rest[3 * vertex]!, rest[3 * vertex + 1]!, rest[3 * vertex + 2]!);
    const frame = this.frame;
    if (!frame) return out;
    const q = frame.packed;
    const along = (axis: 0 | 1 | 2, from: number) =>
      from +
      exaggeration *
        (frame.origin[axis] + (frame.scale[axis] * q[4 * vertex + axis]!) / 65535 - from);
    return out.set(along(0, out.x), along(1, out.y), along(2, out.z));
  }

  dispose(): void {
    this.lut.dispose();
    for (const geometry of this.geometries) geometry.dispose();
    for (const { mesh, stencils } of this.shells) {
      mesh.material.dispose();
      for (const stencil of stencils) stencil.material.dispose();
    }
    this.edges.material.dispose();
    this.ghost.material.dispose();
    for (const membrane of this.membranes) membrane.material.dispose();
  }
}
