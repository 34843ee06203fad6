// The grip that sizes a chosen object about its middle: dragged outward or inward, or moved by keys.
import type { Vector3 } from "three";
import type { CameraRig } from "../drawing/camera";
import type { Rect } from "../marks/labelLayout";
import { drags, GRIP, grip, keys, put } from "./grips";

/** Least distance from the middle, pixels: the grips that move stand farther out. */
const NEAR = 44;
/** Down and to the left, where in the usual view no axis points. */
const WAY = { x: -Math.SQRT1_2, y: Math.SQRT1_2 };
/** Half the size changes in these steps, m; with Shift by the fine ones. */
const STEP = 5e-4;
const FINE_STEP = 1e-4;
const SIGNS: Readonly<Record<string, number>> = {
  ...{ ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 },
};

/** Factor on the size of something of half a size after a change of that, m; never turned inside out. */
export function factorFor(half: number, change: number): number {
  return Math.max(half + Math.round(change / FINE_STEP) * FINE_STEP, FINE_STEP) / half;
}

export class SizeHandle {
  readonly element = document.createElement("div");
  /** Part of the picture that it takes; nothing while it is not shown. */
  grips: readonly Rect[] = [];
  /** Factor on the drawn size of the object while it is dragged. */
  factor = 1;
  private half = 0;
  private readonly button = grip("size-object", "Size: drag, or arrow keys", "⤢");

  /** `changed` is called while it is dragged, and `done` with how many times as large it shall be. */
  constructor(
    private readonly rig: CameraRig,
    changed: () => void,
    done: (factor: number) => void,
  ) {
    this.element.className = "section-handle";
    this.element.hidden = true;
    this.element.append(this.button);
    drags(
      this.button,
      () => {
        let pixels = 0;
        return (dx, dy) => {
          pixels += dx * WAY.x + dy * WAY.y;
          this.factor = factorFor(this.half, pixels / this.rig.pixelsPerMeter);
          changed();
        };
      },
      () => {
        const { factor } = this;
        this.factor = 1;
        if (factor !== 1) done(factor);
        changed();
      },
    );
    keys(this.button, (event) => {
      const sign = SIGNS[event.key];
      if (sign !== undefined)
        done(factorFor(this.half, sign * (event.shiftKey ? FINE_STEP : STEP)));
      return sign !== undefined;
    });
  }

  /** Put it at the edge of an object with its middle there and half a size, m; hide it for null. */
  place(middle: Vector3 | null, half: number, width: number, height: number): void {
    this.element.hidden = middle === null;
    this.grips = [];
    if (!middle) return;
    this.half = half;
    const at = middle.clone().project(this.rig.camera);
    const reach = Math.max(half * this.factor * this.rig.pixelsPerMeter, NEAR);
    const x = ((at.x + 1) / 2) * width + reach * WAY.x;
    const y = ((1 - at.y) / 2) * height + reach * WAY.y;
    put(this.button, { x, y }, 0);
    this.grips = [{ left: x - GRIP, right: x + GRIP, top: y - GRIP, bottom: y + GRIP }];
  }
}
