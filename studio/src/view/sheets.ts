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
import { BODY_VERTEX, SHEET_FRAGMENT } from "./shaders";

export const LAYER_COLOR = "#c77dd6";

export type Sheet = Mesh<BufferGeometry, ShaderMaterial>;

/** A sheet on vertices of a body, whose uniforms place them. */
export function sheetOn(geometry: BufferGeometry, placing: Record<string, IUniform>): Sheet {
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
  const sheet = new Mesh(geometry, material);
  sheet.renderOrder = 3;
  sheet.frustumCulled = false;
  return sheet;
}
