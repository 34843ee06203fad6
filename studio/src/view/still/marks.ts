// Measured points in space: a ball at each, a thin line to the simulated station, a word with the
// error. They are drawn over the body, or those inside of it could not be seen.
import {
  BufferGeometry,
  type Camera,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import type { Triple } from "../../protocol";
import { themeColor } from "../drawing/theme";
import type { Label } from "../marks/labels";

export interface Mark {
  readonly key: string;
  readonly measured: Triple;
  readonly simulated: Triple;
  readonly text: string;
  readonly title: string;
  /** A color variable of theme.css. */
  readonly color: string;
}

// Radius of a ball over the size of the body.
const BALL = 0.009;

export class Marks {
  readonly group = new Group();
  readonly labels: readonly Label[];
  private readonly disposables: { dispose(): void }[] = [];

  constructor(
    private readonly marks: readonly Mark[],
    size: number,
  ) {
    const ball = new SphereGeometry(BALL * size, 16, 12);
    const over = { depthTest: false, transparent: true };
    const ends = marks.flatMap(({ measured, simulated }) => [
      new Vector3(...measured),
      new Vector3(...simulated),
    ]);
    const lines = new LineSegments(
      new BufferGeometry().setFromPoints(ends),
      new LineBasicMaterial({ ...over, color: themeColor("--bad") }),
    );
    lines.renderOrder = 8;
    this.group.add(lines);
    this.disposables.push(ball, lines.geometry, lines.material);
    for (const { measured, color } of marks) {
      const material = new MeshBasicMaterial({ ...over, color: themeColor(color) });
      const mesh = new Mesh(ball, material);
      mesh.position.set(...measured);
      mesh.renderOrder = 9;
      this.group.add(mesh);
      this.disposables.push(material);
    }
    this.labels = marks.map(({ key, measured, text, title, color }) => ({
      key,
      kind: "probe",
      text,
      title,
      color: `var(${color})`,
      at: (out) => out.set(...measured),
    }));
  }

  /**
   * Check if words stand better at the left of their points: toward the first of them, since a
   * specimen that bends leaves room on the side of its clamp.
   */
  leanLeft(camera: Camera): boolean {
    const [first, last] = [this.marks[0], this.marks.at(-1)];
    if (!first || !last) return false;
    return onScreen(first.measured, camera) < onScreen(last.measured, camera);
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const one of this.disposables) one.dispose();
  }
}

function onScreen(point: Triple, camera: Camera): number {
  return new Vector3(...point).project(camera).x;
}
