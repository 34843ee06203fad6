// Layout of words beside their points, so that they lie neither over each other nor over buttons
// in the picture.

export interface Rect {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

export interface Word {
  /** Its point, in pixels. */
  readonly x: number;
  readonly y: number;
  readonly width: number;
  /** True if it may be left out where there is no room: its dot then stands for it. */
  readonly minor: boolean;
}

export interface Standing {
  /** Lines that it stands below its point. */
  readonly lines: number;
  /** Pixels that it stands to the left of where it would, to leave panels free; right if negative. */
  readonly left: number;
  readonly crowded: boolean;
}

export const LINE = 21;
// So many lines a word moves down to be read; a crowd beyond that shows its dots.
const MOST_MOVED = 3;
// So many a word moves down that would lie under a panel.
const MOST_LOWERED = 6;
// Sizes of .view-label: half the height of a word, and from its point to its left edge.
const HALF = 9;
const BESIDE = 9;
const GAP = 4;

function overlap(one: Rect, other: Rect): boolean {
  return (
    one.left < other.right &&
    other.left < one.right &&
    one.top < other.bottom &&
    other.top < one.bottom
  );
}

/**
 * A place for each word within a picture so many pixels wide, in their order: the first ones stand
 * at their points. Where a panel lies there they stand beside it or below it; a word that finds no
 * place clear of panels shows its dot.
 */
export function standWords(
  words: readonly Word[],
  pressed: readonly Rect[],
  width = Infinity,
): Standing[] {
  const taken: Rect[] = [];
  return words.map((word) => {
    const at = (lines: number, left: number): Rect => {
      const top = word.y - HALF + LINE * lines;
      const start = word.x + BESIDE - left;
      return { left: start, right: start + word.width, top, bottom: top + 2 * HALF };
    };
    const clear = (rect: Rect) => !pressed.some((one) => overlap(one, rect));
    const free = (rect: Rect) => !taken.some((one) => overlap(one, rect));
    const inside = (rect: Rect) => rect.left >= 0 && rect.right <= width;
    const covered = !clear(at(0, 0));
    // Beyond a few lines a word moves down only to leave a panel.
    const most = covered ? MOST_LOWERED : MOST_MOVED;
    const places = Array.from({ length: most + 1 }, (_, lines) => {
      const here = at(lines, 0);
      return clear(here) ? [[lines, 0]] : sideways(here, pressed).map((left) => [lines, left]);
    }).flat() as [number, number][];
    const near = places
      .filter(([lines, left]) => {
        const rect = at(lines, left);
        return (left === 0 || inside(rect)) && clear(rect) && free(rect);
      })
      .sort((a, b) => Math.hypot(LINE * a[0], a[1]) - Math.hypot(LINE * b[0], b[1]))[0];
    const last = MOST_MOVED + 1;
    if (!near && (word.minor || !clear(at(last, 0)))) return { lines: 0, left: 0, crowded: true };
    const [lines, left] = near ?? [last, 0];
    taken.push(at(lines, left));
    return { lines, left, crowded: false };
  });
}

/** Shifts to the left by which a word leaves the panels it lies under, the least first. */
function sideways(rect: Rect, pressed: readonly Rect[]): number[] {
  let [left, right] = [0, 0];
  for (const one of pressed) {
    const moved = (by: number) => ({ ...rect, left: rect.left - by, right: rect.right - by });
    if (overlap(moved(left), one)) left = rect.right - one.left + GAP;
    if (overlap(moved(right), one)) right = rect.left - one.right - GAP;
  }
  return [left, right].sort((a, b) => Math.abs(a) - Math.abs(b));
}
