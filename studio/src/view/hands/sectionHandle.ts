// The section plane's handle in the picture: one grip moves the plane along its normal, the other
// turns it. Both are buttons over the picture, so that the keyboard reaches them too.
import { Vector3 } from "three";
import { type Section, turned } from "../body/section";
import type { CameraRig } from "../drawing/camera";
import type { Rect } from "../marks/labelLayout";
import { drags, GRIP, grip, keys, put } from "./grips";

/** Least distance of the two grips, pixels: they stay apart also where the normal meets the eye. */
const APART = 48;
const LONGEST = 110;
/** Radians for each pixel, and for each press of a key. */
const TURN = 0.01;
const KEY_TURN = Math.PI / 36;
const FINE_TURN = Math.PI / 180;
/** Shares of the body for each press of a key. */
const KEY_MOVE: Readonly<Record<string, number>> = {
  ArrowUp: 0.01,
  ArrowRight: 0.01,
  ArrowDown: -0.01,
  ArrowLeft: -0.01,
  PageUp: 0.1,
  PageDown: -0.1,
  End: 1,
  Home: -1,
};
const KEY_TURNS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const UP = new Vector3(0, 0, 1);

export class SectionHandle {
  readonly element = document.createElement("div");
  /** Part of the picture that its two grips take; nothing while there is no section. */
  grips: readonly Rect[] = [];
  private readonly line = document.createElementNS("http://www.w3.org/2000/svg", "line");
  private readonly mover = grip("section-move", "Move the section: drag, or arrow keys", "↕");
  private readonly turner = grip("section-turn", "Turn the section: drag, or arrow keys", "⟳");
  /** Direction on the page in which the plane moves, and pixels for each meter along it. */
  private along = { x: 0, y: -1, pixels: 1 };

  constructor(
    private readonly section: Section,
    private readonly rig: CameraRig,
  ) {
    this.element.className = "section-handle";
    const drawing = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    drawing.append(this.line);
    this.element.append(drawing, this.mover, this.turner);
    this.mover.setAttribute("role", "slider");
    drags(this.mover, () => (dx, dy) => {
      const { x, y, pixels } = this.along;
      this.section.move((dx * x + dy * y) / pixels);
    });
    drags(this.turner, () => {
      const [start, about] = [this.section.normal.clone(), this.section.middle.clone()];
      const right = new Vector3(1, 0, 0).applyQuaternion(this.rig.orientation);
      const up = new Vector3(0, 1, 0).applyQuaternion(this.rig.orientation);
      let [x, y] = [0, 0];
      return (dx, dy) => {
        [x, y] = [x + dx * TURN, y + dy * TURN];
        this.section.aim(turned(turned(start, up, x), right, y), about, true);
      };
    });
    keys(this.mover, (event) => {
      const share = KEY_MOVE[event.key];
      if (share !== undefined) this.section.moveShare(share);
      return share !== undefined;
    });
    keys(this.turner, (event) => {
      const turns = KEY_TURNS[event.key];
      if (turns) this.turnBy(turns, event.shiftKey ? FINE_TURN : KEY_TURN);
      return turns !== undefined;
    });
  }

  private turnBy([around, over]: readonly [number, number], angle: number): void {
    const { normal, middle } = this.section;
    const level = new Vector3().crossVectors(normal, UP);
    if (level.lengthSq() < 1e-6) level.set(1, 0, 0);
    const aimed = turned(turned(normal, UP, around * angle), level.normalize(), over * angle);
    this.section.aim(aimed, middle.clone(), false);
  }

  /** Put it where the plane is drawn, in a picture of some pixels. */
  place(width: number, height: number): void {
    const { on, middle, normal } = this.section;
    this.element.hidden = on.value === 0;
    this.grips = [];
    if (this.element.hidden) return;
    const page = (point: Vector3) => {
      const at = point.project(this.rig.camera);
      return { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height };
    };
    const reach = LONGEST / this.rig.pixelsPerMeter;
    const from = page(middle.clone());
    const tip = page(middle.clone().addScaledVector(normal, reach));
    const [dx, dy] = [tip.x - from.x, tip.y - from.y];
    const long = Math.hypot(dx, dy);
    // If the normal points at the eye there is no way along it: up stands for toward the eye.
    const toward = normal.dot(this.rig.toEye) < 0 ? 1 : -1;
    this.along =
      long > 0.2 * LONGEST
        ? { x: dx / long, y: dy / long, pixels: long / reach }
        : { x: 0, y: toward, pixels: this.rig.pixelsPerMeter };
    const far = Math.max(APART, long);
    const to = { x: from.x + this.along.x * far, y: from.y + this.along.y * far };
    for (const [name, value] of Object.entries({ x1: from.x, y1: from.y, x2: to.x, y2: to.y }))
      this.line.setAttribute(name, value.toFixed(1));
    const angle = Math.atan2(this.along.x, -this.along.y);
    put(this.mover, from, angle);
    put(this.turner, to, 0);
    this.grips = [from, to].map(({ x, y }) => ({
      ...{ left: x - GRIP, right: x + GRIP },
      ...{ top: y - GRIP, bottom: y + GRIP },
    }));
    this.mover.setAttribute("aria-valuenow", String(Math.round(100 * this.section.share)));
  }
}
