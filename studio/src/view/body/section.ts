// A plane that cuts the body open, with the cut filled where there is material.
import {
  Box3,
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
import { setView, useView, type View } from "../../store/view";
import { CAP_FRAGMENT, CAP_VERTEX } from "../drawing/shaders";
import { themeColor } from "../drawing/theme";

/** Within this angle of an axis, in radians, a plane that is turned by hand snaps to it. */
const SNAP = (7 * Math.PI) / 180;

const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) } as const;

/** A direction, turned about an axis by an angle. */
export function turned(direction: Vector3, axis: Vector3, angle: number): Vector3 {
  return direction.clone().applyAxisAngle(axis, angle);
}

/** Begin and end of a box along a direction. */
export function extent(box: Box3, along: Vector3): [number, number] {
  const center = box.getCenter(new Vector3()).dot(along);
  const size = box.getSize(new Vector3());
  const half =
    (Math.abs(along.x) * size.x + Math.abs(along.y) * size.y + Math.abs(along.z) * size.z) / 2;
  return [center - half, center + half];
}

/** A direction as it is kept: an axis and its side where it is one (nearly, if it snaps). */
export function kept(
  normal: Vector3,
  snaps: boolean,
): Pick<View, "section" | "sectionFlipped" | "sectionNormal"> {
  const { x, y, z } = normal.clone().normalize();
  const least = Math.cos(snaps ? SNAP : 1e-6);
  for (const [section, part] of [
    ["x", x],
    ["y", y],
    ["z", z],
  ] as const) {
    if (Math.abs(part) >= least) {
      return { section, sectionFlipped: part < 0, sectionNormal: AXES[section].toArray() };
    }
  }
  return { section: "free", sectionFlipped: false, sectionNormal: [x, y, z] };
}

export class Section {
  readonly group = new Group();
  readonly plane: IUniform<Vector4> = { value: new Vector4(0, 0, 1, 0) };
  readonly on: IUniform<number> = { value: 0 };
  /** Middle of the plane as it is drawn, and the direction to the side that is cut away. */
  readonly middle = new Vector3();
  readonly normal = new Vector3(0, 0, 1);
  /** Position, as a share of the body along `normal`. */
  share = 0.5;
  private readonly box = new Box3();
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

  /** Check if a point is on the side that is shown. */
  keeps(point: Vector3): boolean {
    const { x, y, z, w } = this.plane.value;
    return this.on.value === 0 || x * point.x + y * point.y + z * point.z <= w;
  }

  update(view: View, box: Box3, filled: boolean): void {
    this.on.value = view.section === "off" || box.isEmpty() ? 0 : 1;
    this.group.visible = this.on.value === 1;
    if (view.section === "off") return;
    this.box.copy(box);
    const size = box.getSize(new Vector3());
    const center = box.getCenter(new Vector3());
    const axis = view.section === "free" ? new Vector3(...view.sectionNormal) : AXES[view.section];
    // A hair inside of the bounds, or the cap would fight with a flat end of the body.
    const share = Math.min(0.9995, Math.max(0.0005, view.sectionAt));
    const [low, high] = extent(box, axis);
    const at = low + share * (high - low);
    const sign = view.sectionFlipped ? -1 : 1;
    this.share = sign > 0 ? share : 1 - share;
    this.normal.copy(axis).multiplyScalar(sign);
    this.middle.copy(center).addScaledVector(axis, at - center.dot(axis));
    this.plane.value.set(this.normal.x, this.normal.y, this.normal.z, sign * at);
    for (const part of [this.cap, this.outline]) {
      part.position.copy(this.middle);
      part.quaternion.setFromUnitVectors(AXES.z, axis);
      const reach = part === this.cap ? 6 : 1.25;
      const longest = Math.max(size.x, size.y, size.z);
      part.scale.setScalar(longest * reach);
    }
    this.cap.visible = filled;
  }

  /** Move it along its normal, by meters. */
  move(meters: number): void {
    const [low, high] = extent(this.box, this.normal);
    if (high > low) this.moveShare(meters / (high - low));
  }

  /** Move it along its normal, by a share of the body. */
  moveShare(share: number): void {
    const { sectionAt, sectionFlipped } = useView.getState();
    const next = sectionAt + (sectionFlipped ? -share : share);
    setView({ sectionAt: Math.min(1, Math.max(0, next)) });
  }

  /** Turn it to a normal, about a point that stays on it. */
  aim(normal: Vector3, about: Vector3, snaps: boolean): void {
    const next = kept(normal, snaps);
    const axis = new Vector3(...next.sectionNormal);
    const [low, high] = extent(this.box, axis);
    const share = high > low ? (about.dot(axis) - low) / (high - low) : 0.5;
    setView({ ...next, sectionAt: Math.min(1, Math.max(0, share)) });
  }
}
