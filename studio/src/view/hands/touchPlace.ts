// Contact place of two surfaces: the mean of the points of the first that are near the second, the nearer the more.

/** Largest distance of a point of the first from one of the second, in voxels; twice that where none is. */
const REACH = 1.5;

export interface Near {
  /** Which points of the first, from 0, and the share of each; shares sum to one. */
  readonly points: readonly number[];
  readonly shares: readonly number[];
}

type Box = readonly [number, number, number, number, number, number];

function boxOf(points: Float32Array): Box {
  const box: [number, number, number, number, number, number] = [
    ...[Infinity, Infinity, Infinity],
    ...[-Infinity, -Infinity, -Infinity],
  ] as [number, number, number, number, number, number];
  for (let i = 0; i < points.length; i += 3)
    for (let axis = 0; axis < 3; axis++) {
      const x = points[i + axis]!;
      if (x < box[axis]!) box[axis] = x;
      if (x > box[axis + 3]!) box[axis + 3] = x;
    }
  return box;
}

function within(points: Float32Array, i: number, box: Box, reach: number): boolean {
  for (let axis = 0; axis < 3; axis++) {
    const x = points[i + axis]!;
    if (x < box[axis]! - reach || x > box[axis + 3]! + reach) return false;
  }
  return true;
}

/** The points of the first (x, y, z each) near those of the second, m; null where none are. */
export function nearOf(first: Float32Array, second: Float32Array, voxel: number): Near | null {
  return near(first, second, REACH * voxel) ?? near(first, second, 2 * REACH * voxel);
}

function near(first: Float32Array, second: Float32Array, reach: number): Near | null {
  // Only points in both boxes can be near: a few points of most bodies.
  const box = boxOf(second);
  const candidates: number[] = [];
  for (let i = 0; i < first.length; i += 3) if (within(first, i, box, reach)) candidates.push(i);
  const cells = new Map<string, number[]>();
  const cellOf = (x: number) => Math.floor(x / reach);
  const own = boxOf(Float32Array.from(candidates.flatMap((i) => [...first.subarray(i, i + 3)])));
  for (let i = 0; i < second.length; i += 3) {
    if (!within(second, i, own, reach)) continue;
    const key = `${cellOf(second[i]!)} ${cellOf(second[i + 1]!)} ${cellOf(second[i + 2]!)}`;
    const cell = cells.get(key);
    if (cell) cell.push(i);
    else cells.set(key, [i]);
  }
  return shared(candidates, (i) => {
    const [x, y, z] = [first[i]!, first[i + 1]!, first[i + 2]!];
    let least = reach;
    for (let a = -1; a <= 1; a++)
      for (let b = -1; b <= 1; b++)
        for (let c = -1; c <= 1; c++)
          for (const j of cells.get(`${cellOf(x) + a} ${cellOf(y) + b} ${cellOf(z) + c}`) ?? [])
            least = Math.min(
              least,
              Math.hypot(second[j]! - x, second[j + 1]! - y, second[j + 2]! - z),
            );
    return (1 - least / reach) ** 2;
  });
}

/** The lowest points: those that touch a floor. */
export function lowestOf(first: Float32Array, voxel: number): Near | null {
  const lowest = boxOf(first)[2];
  const all = Array.from({ length: first.length / 3 }, (_, i) => 3 * i);
  return shared(all, (i) => Math.max(0, 1 - (first[i + 2]! - lowest) / voxel) ** 2);
}

function shared(candidates: readonly number[], weight: (at: number) => number): Near | null {
  const points: number[] = [];
  const weights: number[] = [];
  let sum = 0;
  for (const i of candidates) {
    const own = weight(i);
    if (own <= 0) continue;
    points.push(i / 3);
    weights.push(own);
    sum += own;
  }
  return sum > 0 ? { points, shares: weights.map((one) => one / sum) } : null;
}
