// Forces of contact as arrows: each on the first of a pair where it touches the second, to scale, colored
// by whether the surfaces hold.
import {
  Color,
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  MeshBasicMaterial,
  Vector3,
} from "three";
import { formatQuantity } from "../../controls/units";
import { isOf } from "../../panes/design/bodies/several";
import type { BodyEvent, Moment, Touch } from "../../protocol";
import { FEW, holdOf } from "../../run/hold";
import { showPane } from "../../shell/actions";
import type { BodyMesh } from "../body/body";
import { lowestOf, type Near, nearOf } from "../hands/touchPlace";
import type { Label } from "./labels";
import type { RigidObjects } from "./objects";

/** Names in contact of the only body of a design, and of its floor. */
const BODY = "body";
const FLOOR = "floor";
/** Length of the longest arrow, as a part of the size of the body. */
const LONGEST = 0.3;
/** Arrows shorter than this part of the longest one that there may be are not drawn. */
const SHORTEST = 0.01;
/** Colors by hold: it sticks, slips in part, slips. They differ for color-blind eyes too. */
export const HOLD_COLORS = { sticks: "#2fc39b", partly: "#d9a21b", slips: "#e0457b" } as const;

export function holdColor(slipping: number): string {
  if (slipping < FEW) return HOLD_COLORS.sticks;
  return slipping > 1 - FEW ? HOLD_COLORS.slips : HOLD_COLORS.partly;
}

/** The length of a newton, m: 1, 2 or 5 of a power of ten, so that the largest force is not longer than `longest`. */
export function scaleOf(largest: number, longest: number): number {
  if (!(largest > 0) || !(longest > 0)) return 0;
  const exact = longest / largest;
  const power = 10 ** Math.floor(Math.log10(exact));
  const digit = [5, 2, 1].find((one) => one * power <= exact * (1 + 1e-9)) ?? 1;
  return Number((digit * power).toPrecision(1));
}

const sizeOf = (touch: Touch) => Math.hypot(...touch.force);

/** The largest force between two different things in all moments, N. */
export function largestForce(moments: Iterable<Moment>): number {
  let largest = 0;
  for (const moment of moments)
    for (const touch of moment.contacts)
      if (touch.of[0] !== touch.of[1]) largest = Math.max(largest, sizeOf(touch));
  return largest;
}

interface Arrow {
  readonly group: Group;
  readonly material: MeshBasicMaterial;
}

interface Shown {
  readonly touch: Touch;
  readonly tip: Vector3;
  readonly tail: Vector3;
}

export class ContactForces {
  readonly group = new Group();
  private readonly arrows: Arrow[] = [];
  private readonly shaft = new CylinderGeometry(0.028, 0.028, 0.75, 12).translate(0, -0.625, 0);
  private readonly head = new ConeGeometry(0.09, 0.25, 20).translate(0, -0.125, 0);
  private shown: Shown[] = [];
  private drawn: unknown[] = [];
  private longest = 0;
  /** Length of a newton, m; 0 where no force is drawn. */
  scale = 0;

  /** Draw the forces of a moment; none where it is not known. */
  place(
    body: BodyEvent | null,
    moments: ReadonlyMap<number, Moment>,
    moment: Moment | undefined,
    surface: BodyMesh | null,
    objects: RigidObjects,
    exaggeration: number,
  ): void {
    const key = [body, moments, moment, surface, surface?.frame, exaggeration];
    if (key.every((one, i) => one === this.drawn[i])) return;
    this.drawn = key;
    this.shown = [];
    this.scale = 0;
    if (body && moment && surface?.frame && body.topology === surface.topology.id) {
      const size = Math.hypot(...body.bounds[1].map((high, i) => high - body.bounds[0][i]!));
      this.longest = LONGEST * size;
      const scale = scaleOf(largestForce(moments.values()), this.longest);
      const places = new Places(body, moment, surface, objects, exaggeration);
      for (const touch of moment.contacts) {
        const way = new Vector3(...touch.force).multiplyScalar(scale);
        if (touch.of[0] === touch.of[1] || way.length() < SHORTEST * this.longest) continue;
        const tip = places.of(touch);
        if (tip) this.shown.push({ touch, tip, tail: tip.clone().sub(way) });
      }
      if (this.shown.length > 0) this.scale = scale;
    }
    this.draw();
  }

  private draw(): void {
    while (this.arrows.length < this.shown.length) this.arrows.push(this.arrow());
    for (const [i, { group, material }] of this.arrows.entries()) {
      const one = this.shown[i];
      group.visible = one !== undefined;
      if (!one) continue;
      const way = one.tip.clone().sub(one.tail);
      const length = way.length();
      group.position.copy(one.tip);
      group.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
      // Short ones are as thick as those of half the length, or they could not be seen.
      const across = Math.max(length, 0.5 * this.longest);
      group.scale.set(across, length, across);
      material.color.set(new Color(holdColor(one.touch.slipping)));
    }
  }

  private arrow(): Arrow {
    // The touching body hides the contact: the arrow is drawn over it.
    const material = new MeshBasicMaterial({ depthTest: false, transparent: true });
    const group = new Group();
    for (const geometry of [this.shaft, this.head]) {
      const mesh = new Mesh(geometry, material);
      mesh.renderOrder = 9;
      mesh.frustumCulled = false;
      group.add(mesh);
    }
    this.group.add(group);
    return { group, material };
  }

  labels(): Label[] {
    return this.shown.map(({ touch, tail }) => ({
      key: `force-${touch.of.join("-")}`,
      kind: "touch",
      text: `${formatQuantity(sizeOf(touch), "N", 3)}, ${holdOf(touch.slipping)}`,
      title: `Force of ${touch.of[1]} on ${touch.of[0]}`,
      color: holdColor(touch.slipping),
      at: (out) => out.copy(tail),
      onClick: () => showPane("run"),
    }));
  }
}

const UP = new Vector3(0, 1, 0);

/** Points of touching things in one frame, as they are and as they are drawn. */
class Places {
  constructor(
    private readonly body: BodyEvent,
    private readonly moment: Moment,
    private readonly surface: BodyMesh,
    private readonly objects: RigidObjects,
    private readonly exaggeration: number,
  ) {}

  /** Contact place of a pair, as it is drawn. */
  of({ of: [first, second] }: Touch): Vector3 | null {
    const own = this.points(first, 1);
    if (!own) return null;
    const voxel = this.body.voxel_size;
    const other = second === FLOOR ? null : this.points(second, 1);
    const near = second === FLOOR ? lowestOf(own, voxel) : other && nearOf(own, other, voxel);
    if (!near) return null;
    const drawn = this.exaggeration === 1 ? own : this.points(first, this.exaggeration);
    return drawn && mean(drawn, near);
  }

  private points(name: string, exaggeration: number): Float32Array | null {
    const object = this.objects.pointsOf(name, this.moment, exaggeration);
    if (object) return object;
    const { bodies } = this.body;
    const own = bodies.filter((one) => isOf(one.name, name));
    if (name !== BODY && own.length === 0) return null;
    const first = own.length ? Math.min(...own.map((one) => one.vertices[0])) : 0;
    const last = own.length
      ? Math.max(...own.map((one) => one.vertices[1]))
      : this.surface.topology.rest.length / 3 - 1;
    const points = new Float32Array(3 * (last - first + 1));
    const at = new Vector3();
    for (let vertex = first; vertex <= last; vertex++)
      this.surface.place(vertex, exaggeration, at).toArray(points, 3 * (vertex - first));
    return points;
  }
}

function mean(points: Float32Array, { points: chosen, shares }: Near): Vector3 {
  const sum = new Vector3();
  for (const [i, point] of chosen.entries()) {
    const share = shares[i] as number;
    sum.x += share * points[3 * point]!;
    sum.y += share * points[3 * point + 1]!;
    sum.z += share * points[3 * point + 2]!;
  }
  return sum;
}
