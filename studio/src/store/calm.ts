// Statistics come ten times a second. Where pictures are slow, writing them anew that often would
// take the time of every other picture: while time runs they are then told less often.
import type { StatEvent } from "../protocol";
import { ladder } from "../view/drawing/quality";

const BETWEEN = 300; // ms

/** Pass statistics on: the newest always arrives, and a change of state at once. */
export function calmed(tell: (stat: StatEvent) => void): (stat: StatEvent) => void {
  let told: StatEvent | null = null;
  let newest: StatEvent | null = null;
  let toldAt = Number.NEGATIVE_INFINITY;
  let timer: ReturnType<typeof setTimeout> | null = null;
  const flush = () => {
    if (timer !== null) clearTimeout(timer);
    timer = null;
    told = newest as StatEvent;
    toldAt = performance.now();
    tell(told);
  };
  return (stat) => {
    newest = stat;
    const runs = stat.state === "playing" && told?.state === "playing";
    const due = ladder.slow && runs ? toldAt + BETWEEN - performance.now() : 0;
    if (due <= 0) flush();
    else timer ??= setTimeout(flush, due);
  };
}
