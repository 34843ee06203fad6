// Pulling on the body with the mouse: springs between vertices and points.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Line,
  LineBasicMaterial,
  Plane,
  type Ray,
  Vector3,
} from "three";
import { formatNumber } from "../../controls/units";
import type { GrabState } from "../../protocol";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { useView } from "../../store/view";
import type { Label } from "../marks/labels";
import type { Places } from "./target";

interface Pull {
  readonly id: number;
  readonly vertex: number;
  /** The object that is held by its middle instead of a vertex. */
  readonly object: number | null;
  readonly target: Vector3;
  readonly stiffness: number;
  readonly line: Line<BufferGeometry, LineBasicMaterial>;
}

const PULL_COLOR = "#f2a33a";

export class Grabs {
  readonly group = new Group();
  private pulls = new Map<number, Pull>();
  private held: Pull | null = null;
  private readonly plane = new Plane();
  /** Offset from the mouse's grip on something to the reported point. */
  private readonly offset = new Vector3();
  private nextId = 1;
  private sent: Vector3 | null = null;

  get holding(): boolean {
    return this.held !== null;
  }

  begin(vertex: number, at: Vector3, toEye: Vector3): void {
    const { stiffness } = useView.getState();
    this.held = this.spring(this.nextId++, vertex, at.clone(), stiffness);
    this.offset.set(0, 0, 0);
    this.plane.setFromNormalAndCoplanarPoint(toEye, at);
    this.tell(this.held);
  }

  /** Take an object with the middle `middle` at a point of it. */
  beginObject(object: number, at: Vector3, middle: Vector3, toEye: Vector3): void {
    const { stiffness } = useView.getState();
    this.held = this.spring(this.nextId++, 0, middle.clone(), stiffness, object);
    this.offset.copy(middle).sub(at);
    this.plane.setFromNormalAndCoplanarPoint(toEye, at);
    this.tell(this.held);
  }

  /** Draw the springs that the engine has; a body that is meshed anew keeps them. */
  adopt(states: readonly GrabState[]): void {
    for (const { id, vertex, target, stiffness, object } of states) {
      if (!this.pulls.has(id)) this.spring(id, vertex, new Vector3(...target), stiffness, object);
      this.nextId = Math.max(this.nextId, id + 1);
    }
  }

  private spring(
    id: number,
    vertex: number,
    target: Vector3,
    stiffness: number,
    object: number | null = null,
  ): Pull {
    const line = new Line(
      new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6), 3)),
      new LineBasicMaterial({ color: new Color(PULL_COLOR), depthTest: false, transparent: true }),
    );
    line.frustumCulled = false;
    line.renderOrder = 8;
    this.group.add(line);
    const pull = { id, vertex, object, target, stiffness, line };
    this.pulls.set(id, pull);
    return pull;
  }

  /** Move the held thing to where a ray meets the plane of the grab. */
  move(ray: Ray): void {
    if (!this.held) return;
    if (ray.intersectPlane(this.plane, this.held.target)) this.held.target.add(this.offset);
  }

  /** Move the plane of the grab toward the eye, or away from it. */
  deeper(meters: number, ray: Ray): void {
    if (!this.held) return;
    this.plane.constant += meters;
    this.move(ray);
  }

  /** Send the target where it has moved; called once for each picture. */
  flush(): void {
    if (this.held && !(this.sent?.equals(this.held.target) ?? false)) this.tell(this.held);
  }

  private tell(pull: Pull): void {
    const { id, vertex, object, target, stiffness } = pull;
    send({ t: "grab", id, vertex, object, target: [target.x, target.y, target.z], stiffness });
    this.sent = target.clone();
  }

  end(pin: boolean): void {
    if (!this.held) return;
    this.flush();
    if (!pin) this.release(this.held.id);
    this.held = null;
    this.sent = null;
  }

  release(id: number): void {
    const pull = this.pulls.get(id);
    if (!pull) return;
    this.pulls.delete(id);
    pull.line.removeFromParent();
    pull.line.geometry.dispose();
    pull.line.material.dispose();
    send({ t: "release", id });
  }

  /** Forget pinned springs that the engine knows no more, as after a reset. */
  forgetPinned(): void {
    for (const [id, pull] of this.pulls) {
      if (pull === this.held) continue;
      pull.line.removeFromParent();
      this.pulls.delete(id);
    }
  }

  /** Forget all springs, as when the body is another. */
  clear(): void {
    for (const pull of this.pulls.values()) pull.line.removeFromParent();
    this.pulls.clear();
    this.held = null;
    this.sent = null;
  }

  /** Draw the springs, and give their words. */
  update(mesh: Places, middleOf: (object: number) => Vector3 | undefined): Label[] {
    const states = useStudio.getState().stat?.grabs ?? [];
    const labels: Label[] = [];
    const from = new Vector3();
    for (const pull of this.pulls.values()) {
      const middle = pull.object === null ? undefined : middleOf(pull.object);
      if (middle) from.copy(middle);
      else mesh.place(pull.vertex, 1, from);
      const places = pull.line.geometry.getAttribute("position") as BufferAttribute;
      places.setXYZ(0, from.x, from.y, from.z);
      places.setXYZ(1, pull.target.x, pull.target.y, pull.target.z);
      places.needsUpdate = true;
      const state = states.find((one) => one.id === pull.id);
      const force = state
        ? Math.hypot(...state.force)
        : pull.stiffness * from.distanceTo(pull.target);
      const rest = mesh.topology.rest;
      const moved = Math.hypot(
        from.x - rest[3 * pull.vertex]!,
        from.y - rest[3 * pull.vertex + 1]!,
        from.z - rest[3 * pull.vertex + 2]!,
      );
      labels.push({
        key: `force-${pull.id}`,
        kind: "force",
        text: `${formatNumber(force, 3)} N · moved ${formatNumber(moved * 1000, 3)} mm`,
        title: pull === this.held ? "" : "Take this spring away",
        at: (out) => out.copy(pull.target),
        ...(pull === this.held ? {} : { onClick: () => this.release(pull.id) }),
      });
    }
    return labels;
  }
}
