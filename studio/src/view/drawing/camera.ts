// The camera: turns about a target, moves, zooms to the pointer, flies to standard views.
// z is up. It never moves by itself, also when the body is meshed anew, but after one that comes
// to rest outside of the picture.
import { type Box3, OrthographicCamera, PerspectiveCamera, type Quaternion, Vector3 } from "three";

const FIELD_OF_VIEW = 32;
const FLIGHT = 260;
const STEEPEST = Math.PI / 2 - 1e-4;

export type StandardView = "front" | "back" | "left" | "right" | "top" | "bottom" | "corner";

/** Azimuth and elevation of the direction from the target to the eye. */
const STANDARD_VIEWS: Readonly<Record<StandardView, readonly [number, number]>> = {
  front: [-Math.PI / 2, 0],
  back: [Math.PI / 2, 0],
  left: [Math.PI, 0],
  right: [0, 0],
  top: [-Math.PI / 2, STEEPEST],
  bottom: [-Math.PI / 2, -STEEPEST],
  corner: [-Math.PI / 3.4, 0.42],
};

interface Pose {
  target: Vector3;
  azimuth: number;
  elevation: number;
  distance: number;
}

export class CameraRig {
  readonly perspective = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.001, 10);
  readonly orthographic = new OrthographicCamera(-1, 1, 1, -1, -10, 10);
  private pose: Pose = { target: new Vector3(), azimuth: 0, elevation: 0, distance: 0.3 };
  private flight: { from: Pose; to: Pose; start: number } | null = null;
  private width = 1;
  private height = 1;
  private reach = 0.1;
  flat = false;
  /** True if it was placed by hand since it last was fitted to a body. */
  steered = false;
  /** Grows whenever the camera is placed anew. */
  places = 0;

  constructor() {
    [this.pose.azimuth, this.pose.elevation] = STANDARD_VIEWS.corner;
    this.perspective.up.set(0, 0, 1);
    this.orthographic.up.set(0, 0, 1);
    this.place();
  }

  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.flat ? this.orthographic : this.perspective;
  }

  get target(): Vector3 {
    return this.pose.target;
  }

  /** From the target to the eye. */
  get toEye(): Vector3 {
    return direction(this.pose.azimuth, this.pose.elevation);
  }

  /** Pose at the end of the flight, from which the next one starts out. */
  private get aim(): Pose {
    const { target, ...rest } = this.flight?.to ?? this.pose;
    return { ...rest, target: target.clone() };
  }

  /** From the target to the eye, at the end of the flight. */
  get aimedEye(): Vector3 {
    return direction(this.aim.azimuth, this.aim.elevation);
  }

  get orientation(): Quaternion {
    return this.camera.quaternion;
  }

  /** Pixels that a meter at the target takes. */
  get pixelsPerMeter(): number {
    return this.height / (2 * this.pose.distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360));
  }

  resize(width: number, height: number): void {
    this.width = width;
    this.height = height;
    this.place();
  }

  /** Set the reach of the scene, so that nothing of it is clipped away. */
  setReach(reach: number): void {
    this.reach = reach;
    this.place();
  }

  turn(dx: number, dy: number): void {
    this.steered = true;
    this.flight = null;
    this.pose.azimuth -= dx * 0.0075;
    this.pose.elevation = clampElevation(this.pose.elevation + dy * 0.0075);
    this.place();
  }

  move(dx: number, dy: number): void {
    this.steered = true;
    this.flight = null;
    const meter = 1 / this.pixelsPerMeter;
    const right = new Vector3(1, 0, 0).applyQuaternion(this.orientation);
    const up = new Vector3(0, 1, 0).applyQuaternion(this.orientation);
    this.pose.target.addScaledVector(right, -dx * meter).addScaledVector(up, dy * meter);
    this.place();
  }

  /** Zoom so that the point under the pointer (in -1 to 1) stays under it. */
  zoom(factor: number, x: number, y: number): void {
    this.steered = true;
    this.flight = null;
    const before = this.pose.distance;
    const next = Math.min(100, Math.max(1e-4, before * factor));
    const meter = 1 / this.pixelsPerMeter;
    const right = new Vector3(1, 0, 0).applyQuaternion(this.orientation);
    const up = new Vector3(0, 1, 0).applyQuaternion(this.orientation);
    const offset = right
      .multiplyScalar((x * this.width * meter) / 2)
      .addScaledVector(up, (y * this.height * meter) / 2);
    this.pose.target.addScaledVector(offset, 1 - next / before);
    this.pose.distance = next;
    this.place();
  }

  look(view: StandardView): void {
    this.steered = true;
    const [azimuth, elevation] = STANDARD_VIEWS[view];
    this.fly({ ...this.aim, azimuth, elevation });
  }

  turnAbout(point: Vector3): void {
    this.steered = true;
    this.fly({ ...this.aim, target: point.clone() });
  }

  /** Turn about a point, from no farther than some meters. */
  closeTo(point: Vector3, most: number): void {
    this.steered = true;
    const aim = this.aim;
    const distance = most > 0 ? Math.min(aim.distance, most) : aim.distance;
    this.fly({ ...aim, target: point.clone(), distance });
  }

  fit(box: Box3, at_once = false): void {
    if (box.isEmpty()) return;
    this.steered = false;
    const radius = Math.max(1e-5, box.getSize(new Vector3()).length() / 2);
    const narrow = Math.min(1, this.width / this.height);
    const distance = (1.12 * radius) / Math.sin((FIELD_OF_VIEW * Math.PI) / 360) / narrow;
    const to: Pose = { ...this.aim, target: box.getCenter(new Vector3()), distance };
    if (at_once) {
      this.flight = null;
      this.pose = to;
      this.place();
    } else this.fly(to);
  }

  /** Check if all of a box is in the picture. */
  holds(box: Box3): boolean {
    const corner = new Vector3();
    for (let i = 0; i < 8; i++) {
      corner.set(
        (i & 1 ? box.max : box.min).x,
        (i & 2 ? box.max : box.min).y,
        (i & 4 ? box.max : box.min).z,
      );
      corner.project(this.camera);
      if (Math.abs(corner.x) > 1 || Math.abs(corner.y) > 1) return false;
    }
    return true;
  }

  /** Go on with a flight; whether the camera has moved. */
  advance(now: number): boolean {
    if (!this.flight) return false;
    const { from, to, start } = this.flight;
    const share = Math.min(1, (now - start) / FLIGHT);
    const eased = 1 - (1 - share) ** 3;
    this.pose = {
      target: from.target.clone().lerp(to.target, eased),
      azimuth: from.azimuth + shortest(from.azimuth, to.azimuth) * eased,
      elevation: from.elevation + (to.elevation - from.elevation) * eased,
      distance: from.distance * (to.distance / from.distance) ** eased,
    };
    if (share === 1) this.flight = null;
    this.place();
    return true;
  }

  private fly(to: Pose): void {
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const from = { ...this.pose, target: this.pose.target.clone() };
    this.flight = { from, to, start: still ? -Infinity : performance.now() };
  }

  private place(): void {
    this.places += 1;
    const { target, distance } = this.pose;
    const eye = target.clone().addScaledVector(this.toEye, distance);
    const aspect = this.width / this.height;
    const far = distance + this.reach * 12 + 1e-3;
    this.perspective.aspect = aspect;
    this.perspective.near = Math.max(distance / 200, distance - this.reach * 12);
    this.perspective.far = far;
    const half = distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    this.orthographic.top = half;
    this.orthographic.bottom = -half;
    this.orthographic.left = -half * aspect;
    this.orthographic.right = half * aspect;
    this.orthographic.near = -far;
    this.orthographic.far = far;
    for (const camera of [this.perspective, this.orthographic]) {
      camera.position.copy(eye);
      camera.lookAt(target);
      camera.updateProjectionMatrix();
      camera.updateMatrixWorld();
    }
  }
}

function direction(azimuth: number, elevation: number): Vector3 {
  const flat = Math.cos(elevation);
  return new Vector3(flat * Math.cos(azimuth), flat * Math.sin(azimuth), Math.sin(elevation));
}

function clampElevation(angle: number): number {
  return Math.min(STEEPEST, Math.max(-STEEPEST, angle));
}

function shortest(from: number, to: number): number {
  const turn = 2 * Math.PI;
  return ((((to - from + Math.PI) % turn) + turn) % turn) - Math.PI;
}
