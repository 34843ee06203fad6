import type { Frame } from "./frames";

/**
 * Newest frame wins. Frames are offered as they arrive and taken when the page draws; every
 * frame that arrived is acknowledged then, shown or overtaken. A hidden tab draws nothing, so
 * it acknowledges nothing, and the server stops sending after its credits are spent.
 */
export class FrameGate {
  private newest: Frame | null = null;
  private owed: number[] = [];

  offer(frame: Frame): void {
    this.newest = frame;
    this.owed.push(frame.number);
  }

  /** The newest frame that was not taken yet, or null; returns all credits that are owed. */
  take(acknowledge: (frame: number) => void): Frame | null {
    const frame = this.newest;
    this.newest = null;
    const owed = this.owed;
    this.owed = [];
    for (const number of owed) acknowledge(number);
    return frame;
  }

  /** Forget everything: a new connection starts with fresh credits. */
  clear(): void {
    this.newest = null;
    this.owed = [];
  }
}
