// How fast time is shown: as fast as the clock, or so slow that a stiff body is seen to move.
// The same choice as in pace.py of the server.
import { PACES } from "../protocol";

/** A motion that lasts less than this on the screen is hardly seen, s. */
const SEEN = 1;
/** The span over which the real-time factor is measured, ms. */
const SPAN = 1000;

/** The fastest pace at which a motion of some seconds lasts long enough to be seen. */
export function paceFor(seconds: number): number {
  return PACES.find((pace) => seconds / pace >= SEEN) ?? (PACES.at(-1) as number);
}

/** "1×" for real time, "1/50" for fifty times slower. */
export function paceName(pace: number): string {
  return pace === 1 ? "1×" : `1/${Math.round(1 / pace)}`;
}

/** The next pace of the list: `steps` of 1 slower, of −1 faster. */
export function nextPace(pace: number, steps: number): number {
  const now = PACES.findIndex((one) => one <= pace * 1.001);
  const at = (now < 0 ? PACES.length - 1 : now) + steps;
  return PACES[Math.min(PACES.length - 1, Math.max(0, at))] as number;
}

/** What to say of a slow pace; `restIn` is why it is slow, where the motion chose it. */
export function slowed(pace: number, restIn: number | null): string {
  const why =
    restIn === null
      ? ""
      : `, as it comes to rest within ${Number((1000 * restIn).toPrecision(3))} ms`;
  return `Shown ${Math.round(1 / pace)} times slower than real time${why}.`;
}

/** The pace in force: the user's, or what the motion asks for. */
export class Pace {
  chosen: number | null = null;
  /** The time in which the body comes to rest if nobody touches it, where that is known, s. */
  restIn: number | null = null;

  get factor(): number {
    return this.chosen ?? (this.restIn === null ? 1 : paceFor(this.restIn));
  }

  /** What to say of it; nothing in real time. */
  get words(): string {
    return this.factor === 1 ? "" : slowed(this.factor, this.chosen === null ? this.restIn : null);
  }
}

/** Simulated over wall-clock time, measured over about the last second. */
export class RealTimeFactor {
  private marks: { simulated: number; clock: number }[] = [];

  /** Forget what was measured, as time begins to run or runs otherwise. */
  restart(): void {
    this.marks = [];
  }

  /** Note the simulated time in s, and the clock in ms. */
  mark(simulated: number, clock: number): void {
    this.marks.push({ simulated, clock });
    while (clock - this.marks[0]!.clock > SPAN) this.marks.shift();
  }

  get value(): number {
    const [first, last] = [this.marks[0], this.marks.at(-1)];
    if (!first || !last || last.clock <= first.clock) return 0;
    return (1000 * (last.simulated - first.simulated)) / (last.clock - first.clock);
  }
}
