// Where words stand beside their points, so that they lie neither over each other nor over what can
// be pressed in the picture.

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
  /** Whether it may be left out where there is no room: its dot then stands for it. */
  readonly minor: boolean;
}

export interface Standing {
  /** Lines that it stands below its point. */
  readonly lines: number;
  /** Pixels that it stands to the left of where it would, to leave what is pressed free. */
  readonly left: number;
  readonly crowded: boolean;
}

export const LINE = 21;
// So many lines a word moves down to be read; a crowd beyond that shows its dots.
const MOST_MOVED = 3;
// As .view-label has them: half the height of a word, and from its point to its left edge.
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

/** A place for each word, in their order: the first ones stand at their points. */
export function standWords(words: readonly Word[], pressed: readonly Rect[]): Standing[] {
  const taken: Rect[] = [];
  return words.map((word) => {
    const at = (lines: number): { rect: Rect; left: number } => {
      const top = word.y - HALF + LINE * lines;
      const rect = (left: number) => ({
        left: word.x + BESIDE - left,
        right: word.x + BESIDE - left + word.width,
        top,
        bottom: top + 2 * HALF,
      });
      let left = 0;
      // Beside the leftmost of what it would cover.
      for (const one of pressed) {
        const moved = rect(left);
        if (overlap(moved, one)) left += moved.right - one.left + GAP;
      }
      return { rect: rect(left), left };
    };
    const free = (rect: Rect) => !taken.some((one) => overlap(one, rect));
    for (let lines = 0; lines <= MOST_MOVED; lines++) {
      const { rect, left } = at(lines);
      if (!free(rect)) continue;
      taken.push(rect);
      return { lines, left, crowded: false };
    }
    if (word.minor) return { lines: 0, left: 0, crowded: true };
    const { rect, left } = at(MOST_MOVED + 1);
    taken.push(rect);
    return { lines: MOST_MOVED + 1, left, crowded: false };
  });
}
