// Places of times and factors in the rows of the timeline, in pixels.

export interface Axis {
  readonly width: number;
  /** The time at the right end, s. */
  readonly end: number;
}

export const MARGIN = { left: 40, right: 14, top: 8, bottom: 6 } as const;
export const ROW = 84;

export function xOf(time: number, { width, end }: Axis): number {
  return MARGIN.left + ((width - MARGIN.left - MARGIN.right) * time) / end;
}

export function timeAt(x: number, { width, end }: Axis): number {
  return ((x - MARGIN.left) * end) / (width - MARGIN.left - MARGIN.right);
}

export function yOf(factor: number, [low, high]: readonly [number, number]): number {
  const height = ROW - MARGIN.top - MARGIN.bottom;
  return MARGIN.top + (height * (high - factor)) / (high - low);
}

export function factorAt(y: number, [low, high]: readonly [number, number]): number {
  const height = ROW - MARGIN.top - MARGIN.bottom;
  return high - ((y - MARGIN.top) * (high - low)) / height;
}
