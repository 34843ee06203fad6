// Number of the present stroke of the hand: a drag, or a value that was typed and taken. Changes of
// one value in one stroke are undone together, however quick another stroke follows.
let count = 0;

/** Keys that take a typed value, or lead to another field. */
const TAKING: ReadonlySet<string> = new Set(["Enter", "Tab"]);

/** The number of the present stroke. */
export function stroke(): number {
  return count;
}

/** Count strokes from now on; called once. */
export function watchStrokes(): void {
  const next = () => {
    count += 1;
  };
  addEventListener("pointerdown", next, true);
  addEventListener("keydown", (event) => TAKING.has(event.key) && !event.repeat && next(), true);
}
