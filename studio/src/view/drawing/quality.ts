// Time that the graphics take for a picture decides the details left out of moving pictures. A picture
// that stands still is always whole, so a machine with a graphics card never sees any of this.

export interface Quality {
  /** True if edges of surfaces are smoothed (four samples a pixel). */
  readonly smooth: boolean;
  /** Pixels along a side, as a share of those of the screen. */
  readonly share: number;
}

export const WHOLE: Quality = { smooth: true, share: 1 };

const RUNGS: readonly Quality[] = [
  WHOLE,
  { smooth: false, share: 1 },
  { smooth: false, share: 0.75 },
  { smooth: false, share: 0.5 },
];
// Milliseconds of a picture; far enough apart that one rung down never asks for the way back.
const SLOW = 40;
const QUICK = 9;
/** Pictures whose median decides: one alone may compile, upload, or be held up by others. */
const PICTURES = 3;

export class Ladder {
  private rung = 0;
  private times: number[] = [];

  /** Quality of a moving picture. */
  get quality(): Quality {
    return RUNGS[this.rung] as Quality;
  }

  /** True if whole pictures take too long to move: other drawing should hold back as well. */
  get slow(): boolean {
    return this.rung > 0;
  }

  /** Hear how long a picture of the present quality took, in milliseconds. */
  took(time: number): void {
    this.times.push(time);
    if (this.times.length < PICTURES) return;
    const median = this.times.sort((a, b) => a - b)[PICTURES >> 1] as number;
    this.times = [];
    // Each rung about halves the work: go as far down as it takes at once.
    const down = median > SLOW ? Math.ceil(Math.log2(median / SLOW)) : 0;
    if (down > 0) this.rung = Math.min(this.rung + down, RUNGS.length - 1);
    else if (median < QUICK) this.rung = Math.max(this.rung - 1, 0);
  }
}

/** Ladder of this page: all of it shares one way to the screen. */
export const ladder = new Ladder();
