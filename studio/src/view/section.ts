// A plane that cuts the body open, with the cut filled where there is material.
import {
  type Box3,
  BufferGeometry,
  DoubleSide,
  GLSL3,
  Group,
  type IUniform,
  LineBasicMaterial,
  LineLoop,
  Mesh,
  NotEqualStencilFunc,
  PlaneGeometry,
  ReplaceStencilOp,
  ShaderMaterial,
  Vector3,
  Vector4,
} from "three";
import type { View } from "../store/view";
import { CAP_FRAGMENT, CAP_VERTEX } from "./shaders";
import { themeColor } from "./theme";

const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) } as const;

export class Section {
  readonly group = new Group();
  readonly plane: IUniform<Vector4> = { value: new Vector4(0, 0, 1, 0) };
  readonly on: IUniform<number> = { value: 0 };
  private readonly cap: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly outline: LineLoop<BufferGeometry, LineBasicMaterial>;

  constructor() {
    this.cap = new Mesh(
      new PlaneGeometry(1, 1),
      new ShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: CAP_VERTEX,
        fragmentShader: CAP_FRAGMENT,
        side: DoubleSide,
        uniforms: { uCut: { value: themeColor("--cut") } },
        stencilWrite: true,
        stencilRef: 0,
        stencilFunc: NotEqualStencilFunc,
        stencilFail: ReplaceStencilOp,
        stencilZFail: ReplaceStencilOp,
        stencilZPass: ReplaceStencilOp,
      }),
    );
    this.cap.renderOrder = 1;
    const corners = [
      [-0.5, -0.5],
      [0.5, -0.5],
      [0.5, 0.5],
      [-0.5, 0.5],
    ].map(([x, y]) => new Vector3(x, y, 0));
    this.outline = new LineLoop(
      new BufferGeometry().setFromPoints(corners),
      new LineBasicMaterial({ transparent: true, opacity: 0.5 }),
    );
    this.outline.renderOrder = 6;
    this.group.add(this.cap, this.outline);
    this.group.visible = false;
    this.recolor();
  }

  recolor(): void {
    this.cap.material.uniforms.uCut!.value = themeColor("--cut");
    this.outline.material.color = themeColor("--accent");
  }

  /** Whether a point is on the side that is shown. */
  keeps(point: Vector3): boolean {
    const { x, y, z, w } = this.plane.value;
    return this.on.value === 0 || x * point.x + y * point.y + z * point.z <= w;
  }

  update(view: View, box: Box3, filled: boolean): void {
    this.on.value = view.section === "off" || box.isEmpty() ? 0 : 1;
    this.group.visible = this.on.value === 1;
    if (view.section === "off") return;
    const size = box.getSize(new Vector3());
    const center = box.getCenter(new Vector3());
    const axis = AXES[view.section];
    // A hair inside of the bounds, or the cap would fight with a flat end of the body.
    const share = Math.min(0.9995, Math.max(0.0005, view.sectionAt));
    const at = box.min.dot(axis) + share * size.dot(axis);
    const sign = view.sectionFlipped ? -1 : 1;
    this.plane.value.set(sign * axis.x, sign * axis.y, sign * axis.z, sign * at);
    const middle = center.clone().addScaledVector(axis, at - center.dot(axis));
    for (const part of [this.cap, this.outline]) {
      part.position.copy(middle);
      part.quaternion.setFromUnitVectors(AXES.z, axis);
      const reach = part === this.cap ? 6 : 1.25;
      const longest = Math.max(size.x, size.y, size.z);
      part.scale.setScalar(longest * reach);
    }
    this.cap.visible = filled;
  }
}
