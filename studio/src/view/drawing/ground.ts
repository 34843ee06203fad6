// Background and ground grid.
import {
  type Box3,
  DoubleSide,
  GLSL3,
  Mesh,
  PlaneGeometry,
  ShaderMaterial,
  Vector2,
  Vector3,
} from "three";
import { GRID_FRAGMENT, GRID_VERTEX, SKY_FRAGMENT, SKY_VERTEX } from "./shaders";
import { themeColor } from "./theme";

/** The nearest of 1, 2 and 5 times a power of ten that is not larger than `length`. */
export function roundLength(length: number): number {
  if (!(length > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(length) + 1e-9);
  const lead = length / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

export class Sky {
  readonly mesh = new Mesh(
    new PlaneGeometry(2, 2),
    new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: SKY_VERTEX,
      fragmentShader: SKY_FRAGMENT,
      depthTest: false,
      depthWrite: false,
      uniforms: {
        uTop: { value: themeColor("--sky-top") },
        uBottom: { value: themeColor("--sky-bottom") },
      },
    }),
  );

  constructor() {
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -10;
  }

  recolor(): void {
    this.mesh.material.uniforms.uTop!.value = themeColor("--sky-top");
    this.mesh.material.uniforms.uBottom!.value = themeColor("--sky-bottom");
  }
}

export class Ground {
  /** Side of a cell, m. */
  cell = 0.01;
  readonly mesh = new Mesh(
    new PlaneGeometry(1, 1),
    new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: GRID_VERTEX,
      fragmentShader: GRID_FRAGMENT,
      transparent: true,
      depthWrite: false,
      side: DoubleSide,
      uniforms: {
        uCell: { value: 0.01 },
        uCenter: { value: new Vector2() },
        uReach: { value: 1 },
        uInk: { value: themeColor("--grid") },
        uFacing: { value: 1 },
      },
    }),
  );

  constructor() {
    this.mesh.renderOrder = -5;
  }

  recolor(): void {
    this.mesh.material.uniforms.uInk!.value = themeColor("--grid");
  }

  /** Lay the grid under the body at rest: on its floor, where that is near. */
  lay(box: Box3, floor: number | null = null): void {
    const size = box.getSize(new Vector3());
    const center = box.getCenter(new Vector3());
    const longest = Math.max(size.x, size.y, size.z);
    this.cell = roundLength(longest / 4);
    const { uCell, uCenter, uReach } = this.mesh.material.uniforms;
    uCell!.value = this.cell;
    (uCenter!.value as Vector2).set(center.x, center.y);
    uReach!.value = 4.5 * longest;
    const near = floor !== null && box.min.z - floor < longest;
    const height = near ? floor : box.min.z;
    this.mesh.position.set(center.x, center.y, height - 1e-4 * longest);
    this.mesh.scale.setScalar(9 * longest);
  }

  /** Seen from the side a grid is only a smear: it fades. */
  face(elevation: number): void {
    this.mesh.material.uniforms.uFacing!.value = Math.min(1, Math.abs(elevation) / 0.12);
  }
}
