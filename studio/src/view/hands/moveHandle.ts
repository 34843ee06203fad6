// The handle that moves a chosen body or object: a grip for each axis, dragged or moved by keys.
import { Vector3 } from "three";
import type { Triple } from "../../protocol";
import type { CameraRig } from "../drawing/camera";
import type { Rect } from "../marks/labelLayout";
import { drags, GRIP, grip, keys, put } from "./grips";

/** Distance of the grips from the middle, pixels. */
const LONG = 86;
/** A grip whose axis points at the eye is not shown: there is no way along it. */
const SHORT = 20;
/** Drags end at a tenth of a millimeter; keys move by one, with Shift by a tenth, m. */
const SNAP = 1e-4;
const KEY_MOVE = 1e-3;
const FINE_MOVE = 1e-4;
const SIGNS: Readonly<Record<string, number>> = {
  ArrowUp: 1,
  ArrowRight: 1,
  ArrowDown: -1,
  ArrowLeft: -1,
};

const AXES = ["x", "y", "z"] as const;

interface Way {
  x: number;
  y: number;
  pixels: number;
}

/** A distance as a drag takes it, m. */
export const snapped = (distance: number): number =>
  Number((Math.round(distance / SNAP) * SNAP).toFixed(4)) + 0;

export class MoveHandle {
  readonly element = document.createElement("div");
  /** Part of the picture that its grips take; nothing while it is not shown. */
  grips: readonly Rect[] = [];
  /** The way of the drag that goes on, m. */
  shift: Triple = [0, 0, 0];
  private readonly parts = AXES.map((axis, i) => {
    const label = `Move along ${axis}: drag, or arrow keys`;
    const button = grip(`move-${axis}`, label, axis);
    button.classList.add("move-grip", axis);
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    line.classList.add(axis);
    const way: Way = { x: 0, y: -1, pixels: 1 };
    return { index: i, button, line, way };
  });

  /** `changed` is called while it is dragged, and `done` with the whole way, m. */
  constructor(
    private readonly rig: CameraRig,
    changed: () => void,
    done: (by: Triple) => void,
  ) {
    this.element.className = "section-handle move-handle";
    this.element.hidden = true;
    const drawing = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    drawing.append(...this.parts.map((part) => part.line));
    this.element.append(drawing, ...this.parts.map((part) => part.button));
    for (const { index, button, way } of this.parts) {
      const along = (distance: number): Triple =>
        AXES.map((_, i) => (i === index ? distance : 0)) as Triple;
      drags(
        button,
        () => {
          let pixels = 0;
          return (dx, dy) => {
            pixels += dx * way.x + dy * way.y;
            this.shift = along(snapped(pixels / way.pixels));
            changed();
          };
        },
        () => {
          const by = this.shift;
          this.shift = [0, 0, 0];
          if (by[index] !== 0) done(by);
          changed();
        },
      );
      keys(button, (event) => {
        const sign = SIGNS[event.key];
        if (sign !== undefined) done(along(sign * (event.shiftKey ? FINE_MOVE : KEY_MOVE)));
        return sign !== undefined;
      });
    }
  }

  /** Put it where the middle of the chosen entry is drawn, in a picture of some pixels; hide it for null. */
  place(middle: Vector3 | null, width: number, height: number): void {
    this.element.hidden = middle === null;
    this.grips = [];
    if (!middle) return;
    const page = (point: Vector3) => {
      const at = point.project(this.rig.camera);
      return { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height };
    };
    const center = middle.clone().add(new Vector3(...this.shift));
    const from = page(center.clone());
    const reach = LONG / this.rig.pixelsPerMeter;
    const grips: Rect[] = [];
    for (const { index, button, line, way } of this.parts) {
      const axis = new Vector3().setComponent(index, reach);
      const tip = page(center.clone().add(axis));
      const [dx, dy] = [tip.x - from.x, tip.y - from.y];
      const long = Math.hypot(dx, dy);
      const shown = long > SHORT;
      button.hidden = !shown;
      line.style.display = shown ? "" : "none";
      if (!shown) continue;
      Object.assign(way, { x: dx / long, y: dy / long, pixels: long / reach });
      for (const [name, value] of Object.entries({ x1: from.x, y1: from.y, x2: tip.x, y2: tip.y }))
        line.setAttribute(name, value.toFixed(1));
      put(button, tip, 0);
      grips.push({
        ...{ left: tip.x - GRIP, right: tip.x + GRIP },
        ...{ top: tip.y - GRIP, bottom: tip.y + GRIP },
      });
    }
    this.grips = grips;
  }
}
