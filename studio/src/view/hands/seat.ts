// Seat of a plate on a face: the height of the body's surface there, and the room around it.
import type { Axis } from "./face";

type Triple = readonly [number, number, number];

/** A face across an axis. */
interface Flat {
  readonly low: Triple;
  readonly high: Triple;
  readonly normal: Triple;
  readonly voxelSize: number;
}

export interface Seat {
  /** Begin of a plate on the face along its axis, m. */
  readonly level: number;
  /** True if nothing of the body stands up beside the face. */
  readonly free: boolean;
}

/** Width of the plate over that of the face it is on, where there is room. */
export const WIDER = 1.25;
/** Distance of the smooth surface from the face, and height of the searched room beside it, in voxels. */
const NEAR = 1;
const HIGH = 3;

/**
 * The seat of a face across an axis.
 *
 * `rest` are the vertices of the voxels, x, y, z of each in m. Contact is at the smooth surface of the
 * shapes, `smooth` likewise, which is up to half a voxel off the face; without it at the face itself.
 */
export function seatOf(
  { low, high, normal, voxelSize }: Flat,
  axis: Axis,
  rest: ArrayLike<number>,
  smooth: ArrayLike<number> | null,
): Seat {
  const sign = normal[axis] > 0 ? 1 : -1;
  const across = [0, 1, 2].filter((one) => one !== axis) as [Axis, Axis];
  const heightOf = (points: ArrayLike<number>, i: number) => sign * (points[i + axis]! - low[axis]);
  const isOver = (points: ArrayLike<number>, i: number, wide: number) =>
    across.every((one) => {
      const more = ((wide - 1) * (high[one] - low[one])) / 2;
      const x = points[i + one]!;
      return x > low[one] - more && x < high[one] + more;
    });
  let free = true;
  for (let i = 0; i < rest.length && free; i += 3) {
    const height = heightOf(rest, i);
    free = height < 0.5 * voxelSize || height > HIGH * voxelSize || !isOver(rest, i, WIDER);
  }
  let reach = Number.NEGATIVE_INFINITY;
  for (let i = 0; smooth && i < smooth.length; i += 3) {
    const height = heightOf(smooth, i);
    if (Math.abs(height) <= NEAR * voxelSize && isOver(smooth, i, free ? WIDER : 1))
      reach = Math.max(reach, height);
  }
  return { level: low[axis] + sign * (Number.isFinite(reach) ? reach : 0), free };
}
