// Trials and generations come by the thousand, and each costs its plots and tables a drawing:
// the page takes them up a few times per second, all that came meanwhile at once.
import type { AnyEvent, GenerationEvent, TrialEvent } from "../protocol";

export type Gathered = TrialEvent | GenerationEvent;

/** Milliseconds between two times that they are taken up. */
const EVERY = 150;

/** Takes events one by one, and passes on gathered ones together; their order stays. */
export function gathering(
  apply: (event: Exclude<AnyEvent, Gathered>) => void,
  applyAll: (events: readonly Gathered[]) => void,
): (event: AnyEvent) => void {
  let waiting: Gathered[] = [];
  let timer: ReturnType<typeof setTimeout> | null = null;
  const takeUp = () => {
    if (timer !== null) clearTimeout(timer);
    timer = null;
    if (waiting.length === 0) return;
    const events = waiting;
    waiting = [];
    applyAll(events);
  };
  return (event) => {
    if (event.t === "trial" || event.t === "generation") {
      waiting.push(event);
      timer ??= setTimeout(takeUp, EVERY);
      return;
    }
    // Progress of a job may be reported before its last trials are drawn; all else waits for them.
    if (event.t !== "job" || event.state !== "running") takeUp();
    apply(event);
  };
}
