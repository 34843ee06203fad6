// A box seen from a direction, drawn on a plane: enough for a few hundred points.

export interface Turn {
  /** About the vertical axis, radians. */
  readonly around: number;
  /** Above the horizon, radians. */
  readonly above: number;
  readonly zoom: number;
}

export interface Projected {
  readonly x: number;
  readonly y: number;
  /** Larger is nearer. */
  readonly near: number;
}

/** A point of the cube from -1 to 1, z up, in pixels of a picture of a given size. */
export function project(
  [x, y, z]: readonly [number, number, number],
  turn: Turn,
  width: number,
  height: number,
): Projected {
  const [ca, sa] = [Math.cos(turn.around), Math.sin(turn.around)];
  const [cb, sb] = [Math.cos(turn.above), Math.sin(turn.above)];
  const right = ca * x + sa * y;
  const back = -sa * x + ca * y;
  const up = cb * z + sb * back;
  const near = -cb * back + sb * z;
  // A camera at some distance: near things are larger.
  const scale = (0.25 * Math.min(width, height) * turn.zoom * 6) / (6 - near);
  return { x: width / 2 + right * scale, y: height / 2 - up * scale, near };
}

export const CORNERS: readonly (readonly [number, number, number])[] = [
  [-1, -1, -1],
  [1, -1, -1],
  [1, 1, -1],
  [-1, 1, -1],
  [-1, -1, 1],
  [1, -1, 1],
  [1, 1, 1],
  [-1, 1, 1],
];

export const EDGES: readonly (readonly [number, number])[] = [
  [0, 1],
  [1, 2],
  [2, 3],
  [3, 0],
  [4, 5],
  [5, 6],
  [6, 7],
  [7, 4],
  [0, 4],
  [1, 5],
  [2, 6],
  [3, 7],
];

/** The edge along an axis (0 to 2) that lies most to the outside, where its name is read best. */
export function labelEdge(
  axis: 0 | 1 | 2,
  corners: readonly Projected[],
): readonly [number, number] {
  const along = EDGES.filter(([a, b]) => CORNERS[a]?.[axis] !== CORNERS[b]?.[axis]);
  const score = ([a, b]: readonly [number, number]) => {
    const [p, q] = [corners[a], corners[b]];
    if (!p || !q) return -Infinity;
    // x and y are named at the bottom of the picture, z at its left.
    return axis === 2 ? -(p.x + q.x) : p.y + q.y;
  };
  return along.reduce((best, edge) => (score(edge) > score(best) ? edge : best));
}
