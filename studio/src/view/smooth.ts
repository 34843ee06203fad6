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
  Vector3,
  type Vector4,
} from "three";
import type { Smooth } from "../engine/frames";
import type { View } from "../store/view";
import type { BodyMesh } from "./body";
import { Skin } from "./skin";
import { type StencilMesh, stencilPair } from "./stencil";

const VERTEX = /* glsl */ `
out vec3 vNormal;
out vec3 vWorld;
void main() {
  vWorld = position;
  vNormal = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
precision highp float;
in vec3 vNormal;
in vec3 vWorld;
uniform vec3 uOwn;
uniform vec4 uPlane;
uniform float uSection;
out vec4 color;
void main() {
  if (uSection > 0.5 && dot(uPlane.xyz, vWorld) > uPlane.w) discard;
  vec3 normal = normalize(vNormal);
  if (!gl_FrontFacing) normal = -normal;
  float key = max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  float rim = pow(1.0 - max(0.0, normal.z), 3.0);
  vec3 base = gl_FrontFacing ? uOwn : uOwn * 0.55;
  color = vec4(base * (0.58 + 0.46 * key) + 0.10 * rim, 1.0);
}
`;

export class SmoothMesh {
  readonly group = new Group();
  private readonly geometry = new BufferGeometry();
  private readonly material: ShaderMaterial;
  private readonly stencils: readonly StencilMesh[];

  /** x, y, z of each vertex at rest, m. */
  readonly vertices: Float32Array;
  readonly triangles: Uint32Array;
  /** The same as they are drawn. */
  readonly drawn: Float32Array;
  private skin: Skin | null = null;
  private followed = "";

  constructor(smooth: Smooth, section: { plane: IUniform<Vector4>; section: IUniform<number> }) {
    this.vertices = smooth.vertices;
    this.triangles = smooth.triangles;
    this.drawn = smooth.vertices.slice();
    this.geometry.setAttribute("position", new BufferAttribute(this.drawn, 3));
    this.geometry.setIndex(new BufferAttribute(smooth.triangles, 1));
    this.geometry.computeVertexNormals();
    this.material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      uniforms: {
        uPlane: section.plane,
        uSection: section.section,
        uOwn: { value: new Color("#e8b88a") },
      },
    });
    const mesh = new Mesh(this.geometry, this.material);
    mesh.frustumCulled = false;
    mesh.renderOrder = 2;
    const { uPlane, uSection } = this.material.uniforms as Record<string, IUniform>;
    this.stencils = stencilPair(this.geometry, VERTEX, { uPlane: uPlane!, uSection: uSection! });
    this.group.add(mesh, ...this.stencils);
  }

  style(view: View, colors: { parts: readonly string[] }, visible: boolean): void {
    (this.material.uniforms.uOwn!.value as Color).set(colors.parts[0] ?? "#e8b88a");
    this.group.visible = visible;
    for (const stencil of this.stencils) stencil.visible = view.section !== "off";
  }

  /** Move it as the surface is moved. */
  follow(surface: BodyMesh, exaggeration: number): void {
    const { frame, topology } = surface;
    const key = `${topology.id} ${frame?.number} ${frame?.time} ${exaggeration}`;
    if (key === this.followed) return;
    this.followed = key;
    this.skin ??= new Skin(this.vertices, topology.rest, topology.voxelSize || 1e-3);
    const moved = new Float32Array(topology.rest.length);
    const at = new Vector3();
    for (let i = 0; i < moved.length; i += 3) {
      surface.place(i / 3, exaggeration, at);
      moved[i] = at.x - topology.rest[i]!;
      moved[i + 1] = at.y - topology.rest[i + 1]!;
      moved[i + 2] = at.z - topology.rest[i + 2]!;
    }
    this.skin.move(this.vertices, moved, this.drawn);
    this.geometry.getAttribute("position").needsUpdate = true;
    this.geometry.computeVertexNormals();
  }

  dispose(): void {
    this.group.removeFromParent();
    this.geometry.dispose();
    this.material.dispose();
    for (const stencil of this.stencils) stencil.material.dispose();
  }
}
