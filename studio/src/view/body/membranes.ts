// Layers on the body: a weave over their triangles, which move with it.
import {
  type BufferGeometry,
  Color,
  DoubleSide,
  GLSL3,
  type IUniform,
  Mesh,
  ShaderMaterial,
} from "three";
import { BODY_VERTEX, SHEET_FRAGMENT } from "../drawing/shaders";

export const LAYER_COLOR = "#c77dd6";

export type Membrane = Mesh<BufferGeometry, ShaderMaterial>;

/** A membrane on vertices of a body, whose uniforms place them. */
export function membraneOn(geometry: BufferGeometry, placing: Record<string, IUniform>): Membrane {
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: BODY_VERTEX,
    fragmentShader: SHEET_FRAGMENT,
    side: DoubleSide,
    transparent: true,
    depthWrite: false,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -1,
    uniforms: { ...placing, uOwn: { value: new Color(LAYER_COLOR) } },
  });
  const membrane = new Mesh(geometry, material);
  membrane.renderOrder = 3;
  membrane.frustumCulled = false;
  return membrane;
}
