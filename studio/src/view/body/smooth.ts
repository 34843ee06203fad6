// The smooth surface of the shapes, with normals of its own; it follows the voxels as they move.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  GLSL3,
  Group,
  type IUniform,
  Mesh,
  ShaderMaterial,
  Vector2,
  Vector3,
  type Vector4,
} from "three";
import { type Frame, type Smooth, surfacePoints } from "../../engine/frames";
import type { View } from "../../store/view";
import { COLORED, CUT } from "../drawing/shaders";
import { type BodyMesh, rangesByOwner } from "./body";
import { normalsOf, Skin } from "./skin";
import { type StencilMesh, stencilPair } from "./stencil";

const VERTEX = /* glsl */ `
in float field;
out vec3 vNormal;
out vec3 vWorld;
out float vField;
void main() {
  vWorld = position;
  vNormal = normalMatrix * normal;
  vField = field;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
precision highp float;
${CUT}
${COLORED}
in vec3 vNormal;
in vec3 vWorld;
in float vField;
uniform vec3 uOwn;
uniform float uByField;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  vec3 normal = normalize(vNormal);
  if (!gl_FrontFacing) normal = -normal;
  float key = max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  if (uByField > 0.5) {
    // Mostly ambient: the map's colors must stay those of the legend.
    vec3 base = stripedOf(shareOf(vField), gl_FragCoord.xy);
    color = vec4(base * (0.74 + 0.26 * key) * (gl_FrontFacing ? 1.0 : 0.82), 1.0);
    return;
  }
  float rim = pow(1.0 - max(0.0, normal.z), 3.0);
  vec3 base = gl_FrontFacing ? uOwn : uOwn * 0.55;
  color = vec4(base * (0.58 + 0.46 * key) + 0.10 * rim, 1.0);
}
`;

type Part = { owner: number; mesh: Mesh<BufferGeometry, ShaderMaterial> };

export class SmoothMesh {
  readonly group = new Group();
  /** All of it, for normals and stencils; the parts are drawn from its attributes. */
  private readonly geometry = new BufferGeometry();
  private readonly parts: Part[];
  private readonly stencils: readonly StencilMesh[];

  /** x, y, z of each vertex unloaded, m. */
  readonly vertices: Float32Array;
  readonly triangles: Uint32Array;
  /** Points as they are drawn. */
  readonly drawn: Float32Array;
  private readonly field: Float32Array;
  private skin: Skin | null = null;
  private followed: { frame: Frame | null; exaggeration: number } | null = null;

  constructor(smooth: Smooth, section: { plane: IUniform<Vector4>; section: IUniform<number> }) {
    const { index, ranges } = rangesByOwner(smooth.triangles, smooth.owners);
    this.vertices = smooth.vertices;
    this.triangles = index;
    this.drawn = smooth.vertices.slice();
    this.field = new Float32Array(smooth.vertices.length / 3);
    this.geometry.setAttribute("position", new BufferAttribute(this.drawn, 3));
    this.geometry.setAttribute("field", new BufferAttribute(this.field, 1));
    this.geometry.setIndex(new BufferAttribute(index, 1));
    this.geometry.computeVertexNormals();
    const cut = { uPlane: section.plane, uSection: section.section };
    this.parts = ranges.map(({ owner, start, count }) => {
      const geometry = new BufferGeometry();
      for (const name of ["position", "normal", "field"])
        geometry.setAttribute(name, this.geometry.getAttribute(name));
      geometry.setIndex(this.geometry.getIndex());
      geometry.setDrawRange(start, count);
      const material = new ShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        side: DoubleSide,
        uniforms: {
          ...cut,
          uOwn: { value: new Color("#e8b88a") },
          uByField: { value: 0 },
          uLut: { value: null },
          uFrameRange: { value: new Vector2(0, 1) },
          uRange: { value: new Vector2(0, 1) },
        },
      });
      const mesh = new Mesh(geometry, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = 2;
      return { owner, mesh };
    });
    this.stencils = stencilPair(this.geometry, VERTEX, cut);
    this.group.visible = false;
    this.group.add(...this.parts.map((part) => part.mesh), ...this.stencils);
  }

  /** Color it as the surface of voxels is colored: by the same field over the same range. */
  style(view: View, colors: { parts: readonly string[] }, visible: boolean, by: BodyMesh): void {
    const { lut, frame, range } = by.coloring;
    const flat = !by.frame || by.frame.max <= by.frame.min;
    for (const { owner, mesh } of this.parts) {
      const { uniforms } = mesh.material;
      (uniforms.uOwn!.value as Color).set(colors.parts[owner] ?? "#e8b88a");
      uniforms.uByField!.value = view.coloring === "field" && !flat ? 1 : 0;
      uniforms.uLut!.value = lut;
      (uniforms.uFrameRange!.value as Vector2).copy(frame);
      (uniforms.uRange!.value as Vector2).copy(range);
    }
    this.group.visible = visible;
    for (const stencil of this.stencils) stencil.visible = view.section !== "off";
  }

  /** Number of drawn triangles. */
  get count(): number {
    return this.group.visible ? this.triangles.length / 3 : 0;
  }

  /** Move it and give it the values of the field as the surface has them. */
  follow(surface: BodyMesh, exaggeration: number): void {
    const { frame, topology } = surface;
    if (this.followed?.frame === frame && this.followed.exaggeration === exaggeration) return;
    this.followed = { frame, exaggeration };
    const skinned = topology.rest.subarray(0, 3 * surfacePoints(topology));
    this.skin ??= new Skin(
      { points: this.vertices, normals: normalsOf(this.vertices, this.triangles) },
      { points: skinned, normals: normalsOf(skinned, topology.triangles) },
      topology.voxelSize || 1e-3,
    );
    const moved = new Float32Array(topology.rest.length);
    const at = new Vector3();
    for (let i = 0; i < moved.length; i += 3) {
      surface.place(i / 3, exaggeration, at);
      moved[i] = at.x - topology.rest[i]!;
      moved[i + 1] = at.y - topology.rest[i + 1]!;
      moved[i + 2] = at.z - topology.rest[i + 2]!;
    }
    this.skin.move(this.vertices, moved, this.drawn);
    if (frame) this.skin.values(frame.packed, 4, 3, this.field);
    for (let i = 0; i < this.field.length; i++) this.field[i]! /= 65535;
    this.geometry.getAttribute("position").needsUpdate = true;
    this.geometry.getAttribute("field").needsUpdate = true;
    this.geometry.computeVertexNormals();
  }

  dispose(): void {
    this.group.removeFromParent();
    this.geometry.dispose();
    for (const { mesh } of this.parts) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    for (const stencil of this.stencils) stencil.material.dispose();
  }
}
