// Behind a section plane the stencil counts how deep inside of a closed surface each pixel is:
// back faces count up and front faces down. Where the count is not zero the cut is filled.
import {
  AlwaysStencilFunc,
  BackSide,
  type BufferGeometry,
  DecrementWrapStencilOp,
  FrontSide,
  GLSL3,
  IncrementWrapStencilOp,
  type IUniform,
  Mesh,
  ShaderMaterial,
} from "three";
import { STENCIL_FRAGMENT } from "../drawing/shaders";

export type StencilMesh = Mesh<BufferGeometry, ShaderMaterial>;

/** The two passes over a surface; they draw nothing that can be seen. */
export function stencilPair(
  geometry: BufferGeometry,
  vertexShader: string,
  uniforms: Record<string, IUniform>,
): [StencilMesh, StencilMesh] {
  const pass = (side: typeof BackSide | typeof FrontSide): StencilMesh => {
    const operation = side === BackSide ? IncrementWrapStencilOp : DecrementWrapStencilOp;
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader: STENCIL_FRAGMENT,
      uniforms,
      side,
      colorWrite: false,
      depthWrite: false,
      depthTest: false,
      stencilWrite: true,
      stencilFunc: AlwaysStencilFunc,
      stencilFail: operation,
      stencilZFail: operation,
      stencilZPass: operation,
    });
    const mesh = new Mesh(geometry, material);
    mesh.renderOrder = 0;
    mesh.frustumCulled = false;
    mesh.visible = false;
    return mesh;
  };
  return [pass(BackSide), pass(FrontSide)];
}
