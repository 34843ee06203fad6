// Inside of the body in a section: the cut through the voxels, colored by the field as the surface is.
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  GLSL3,
  KeepStencilOp,
  Mesh,
  NotEqualStencilFunc,
  ShaderMaterial,
  Vector2,
  Vector3,
  Vector4,
} from "three";
import type { Frame } from "../../engine/frames";
import { FILL_FRAGMENT, FILL_VERTEX } from "../drawing/shaders";
import type { BodyMesh } from "./body";
import { slice } from "./slice";

export class SectionFill {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private of: { body: BodyMesh; frame: Frame | null; exaggeration: number } | null = null;
  private readonly plane = new Vector4(0, 0, 0, Number.NaN);

  constructor() {
    this.mesh = new Mesh(
      new BufferGeometry(),
      new ShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: FILL_VERTEX,
        fragmentShader: FILL_FRAGMENT,
        side: DoubleSide,
        uniforms: {
          uLut: { value: null },
          uFrameRange: { value: new Vector2(0, 1) },
          uRange: { value: new Vector2(0, 1) },
        },
        // Drawn only where the surface marks material, and in front of the hatching that fills the rest.
        stencilWrite: true,
        stencilRef: 0,
        stencilFunc: NotEqualStencilFunc,
        stencilFail: KeepStencilOp,
        stencilZFail: KeepStencilOp,
        stencilZPass: KeepStencilOp,
        polygonOffset: true,
        polygonOffsetFactor: -1,
        polygonOffsetUnits: -4,
      }),
    );
    this.mesh.renderOrder = 0.5;
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** Number of drawn triangles of the cut. */
  get triangles(): number {
    const count = this.mesh.geometry.getAttribute("position")?.count ?? 0;
    return this.mesh.visible ? count / 3 : 0;
  }

  /** Cut the voxels of a body as it is drawn; no body hides the cut. */
  update(body: BodyMesh | null, plane: Vector4, exaggeration: number): void {
    const shown = body?.frame;
    // If the field is the same everywhere, a map shows nothing.
    this.mesh.visible =
      body !== null && body.topology.voxels.length > 0 && !!shown && shown.max > shown.min;
    if (!this.mesh.visible || !body) return;
    const { lut, frame, range } = body.coloring;
    const { uniforms } = this.mesh.material;
    uniforms.uLut!.value = lut;
    (uniforms.uFrameRange!.value as Vector2).copy(frame);
    (uniforms.uRange!.value as Vector2).copy(range);
    const known = this.of;
    const same =
      known?.body === body && known.frame === body.frame && known.exaggeration === exaggeration;
    if (same && this.plane.equals(plane)) return;
    this.of = { body, frame: body.frame, exaggeration };
    this.plane.copy(plane);
    const { positions, values } = placed(body, exaggeration);
    const cut = slice(body.topology.voxels, positions, values, plane);
    const { geometry } = this.mesh;
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(cut.points), 3));
    geometry.setAttribute("field", new BufferAttribute(new Float32Array(cut.values), 1));
  }
}

/** Positions where the points of a body are drawn, and the value of the field at each as a part of its range. */
function placed(
  body: BodyMesh,
  exaggeration: number,
): { positions: Float32Array; values: Float32Array } {
  const packed = body.frame?.packed ?? new Uint16Array(0);
  const positions = new Float32Array(body.topology.rest.length);
  const values = new Float32Array(positions.length / 3);
  const at = new Vector3();
  for (let i = 0; i < values.length; i++) {
    body.place(i, exaggeration, at).toArray(positions, 3 * i);
    values[i] = packed[4 * i + 3]! / 65535;
  }
  return { positions, values };
}
