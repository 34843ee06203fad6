// Which plane shows a shape best, and how to fit it into a box at one scale for both axes.
import type { Triple } from "../../protocol";

export const AXES = ["x", "y", "z"] as const;

/** The two axes along which points are spread most; the vertical one second where it is there. */
export function bestPlane(points: readonly Triple[]): readonly [number, number] {
  const spread = [0, 1, 2].map((axis) => {
    const values = points.map((point) => point[axis] ?? 0);
    return { axis, size: values.length ? Math.max(...values) - Math.min(...values) : 0 };
  });
  const [first, second] = spread.sort((a, b) => b.size - a.size).map((one) => one.axis);
  const [a, b] = [first ?? 0, second ?? 2];
  return a < b ? [a, b] : [b, a];
}

export interface Fitted {
  readonly scale: number;
  toX(value: number): number;
  toY(value: number): number;
  readonly low: readonly [number, number];
  readonly high: readonly [number, number];
}

/** Fit points into a box, `margin` pixels from its sides, lengths equal along both axes. */
export function fitPlane(
  points: readonly (readonly [number, number])[],
  width: number,
  height: number,
  margin: { left: number; right: number; top: number; bottom: number },
): Fitted {
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const [x, y] of points) {
    [x0, x1, y0, y1] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, y), Math.max(y1, y)];
  }
  if (x0 > x1) [x0, x1, y0, y1] = [0, 1, 0, 1];
  const [w, h] = [width - margin.left - margin.right, height - margin.top - margin.bottom];
  const least = Math.max(x1 - x0, y1 - y0, 1e-9) * 1e-3;
  const scale = Math.min(w / Math.max(x1 - x0, least), h / Math.max(y1 - y0, least));
  const [mx, my] = [(x0 + x1) / 2, (y0 + y1) / 2];
  const [cx, cy] = [margin.left + w / 2, margin.top + h / 2];
  return {
    scale,
    toX: (value) => cx + (value - mx) * scale,
    toY: (value) => cy - (value - my) * scale,
    low: [mx - w / 2 / scale, my - h / 2 / scale],
    high: [mx + w / 2 / scale, my + h / 2 / scale],
  };
}
