// A measuring tape between two points that stay on the body as it moves.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Line,
  LineBasicMaterial,
  Points,
  PointsMaterial,
  Vector3,
} from "three";
import { formatQuantity } from "../../controls/units";
import type { Hit } from "../hands/pick";
import type { Places } from "../hands/target";
import type { Label } from "./labels";

type Anchor = Pick<Hit, "triangle" | "weights">;

export class Tape {
  readonly group = new Group();
  private anchors: Anchor[] = [];
  private readonly geometry = new BufferGeometry();

  constructor() {
    this.geometry.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
    const color = new Color("#e8dd55");
    const options = { color, depthTest: false, transparent: true };
    const line = new Line(this.geometry, new LineBasicMaterial(options));
    const ends = new Points(
      this.geometry,
      new PointsMaterial({ ...options, size: 8, sizeAttenuation: false }),
    );
    for (const part of [line, ends]) {
      part.frustumCulled = false;
      part.renderOrder = 8;
      this.group.add(part);
    }
    this.group.visible = false;
  }

  /** Put down an end; a third one starts over. */
  add(hit: Hit): void {
    if (this.anchors.length >= 2) this.anchors = [];
    this.anchors.push({ triangle: hit.triangle, weights: hit.weights });
  }

  clear(): void {
    this.anchors = [];
  }

  /** Draw it; gives its length as drawn without exaggeration, and its words. */
  update(mesh: Places, exaggeration: number): { length: number | null; labels: Label[] } {
    this.group.visible = this.anchors.length > 0;
    if (!this.group.visible) return { length: null, labels: [] };
    const places = this.geometry.getAttribute("position") as BufferAttribute;
    const drawn = this.anchors.map((anchor) => at(mesh, anchor, exaggeration));
    const [first = new Vector3(), second = first] = drawn;
    places.setXYZ(0, first.x, first.y, first.z);
    places.setXYZ(1, second.x, second.y, second.z);
    places.needsUpdate = true;
    if (this.anchors.length < 2) return { length: null, labels: [] };
    const [a, b] = this.anchors.map((anchor) => at(mesh, anchor, 1));
    const length = (a as Vector3).distanceTo(b as Vector3);
    const middle = first.clone().add(second).multiplyScalar(0.5);
    return {
      length,
      labels: [
        {
          key: "tape",
          kind: "tape",
          text: formatQuantity(length, "m", 4),
          at: (out) => out.copy(middle),
        },
      ],
    };
  }
}

function at(mesh: Places, anchor: Anchor, exaggeration: number): Vector3 {
  const sum = new Vector3();
  const one = new Vector3();
  for (const [i, vertex] of anchor.triangle.entries()) {
    sum.addScaledVector(mesh.place(vertex, exaggeration, one), anchor.weights[i] as number);
  }
  return sum;
}
