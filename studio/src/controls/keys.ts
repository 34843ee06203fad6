// Keys after Enter: a field that took its text gives them to the picture under the pointer.

const canvas = (): HTMLElement | null => document.querySelector(".viewport canvas");

/**
 * Give the keys to the picture: now if the pointer is there, else once it gets there, unless the
 * field is typed into again or left before.
 */
export function keysToPicture(field: HTMLInputElement): void {
  const picture = canvas();
  if (!picture) return;
  if (picture.matches(":hover")) {
    picture.focus({ preventScroll: true });
    return;
  }
  const waiting = new AbortController();
  const { signal } = waiting;
  const stop = () => waiting.abort();
  picture.addEventListener(
    "pointerenter",
    () => {
      stop();
      picture.focus({ preventScroll: true });
    },
    { signal },
  );
  for (const event of ["input", "blur"]) field.addEventListener(event, stop, { signal });
}
