// The paces that can be chosen, by name and by step; which one a motion asks for is the player's to say.
import { PACES } from "../protocol";

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
