// Grips in the picture: buttons over it that are dragged, or moved by keys.

/** Half the size of a grip, as .section-grip has it. */
export const GRIP = 12;

export function grip(testId: string, label: string, sign: string): HTMLButtonElement {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "section-grip";
  button.dataset.testid = testId;
  button.title = label;
  button.setAttribute("aria-label", label);
  const glyph = document.createElement("span");
  glyph.textContent = sign;
  button.append(glyph);
  return button;
}

export function put(button: HTMLButtonElement, at: { x: number; y: number }, angle: number): void {
  button.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  (button.firstChild as HTMLElement).style.transform = `rotate(${angle.toFixed(3)}rad)`;
}

/** While a grip is held, call the result of `begin` with the pixels of each move and the state of Shift; then `ended`. */
export function drags(
  button: HTMLButtonElement,
  begin: () => (dx: number, dy: number, fine: boolean) => void,
  ended: () => void = () => {},
): void {
  let held: { move: ReturnType<typeof begin>; x: number; y: number } | null = null;
  button.addEventListener("pointerdown", (event) => {
    button.setPointerCapture(event.pointerId);
    held = { move: begin(), x: event.clientX, y: event.clientY };
  });
  button.addEventListener("pointermove", (event) => {
    if (!held) return;
    held.move(event.clientX - held.x, event.clientY - held.y, event.shiftKey);
    held = { ...held, x: event.clientX, y: event.clientY };
  });
  const end = () => {
    if (held) ended();
    held = null;
  };
  button.addEventListener("pointerup", end);
  button.addEventListener("pointercancel", end);
}

/** Keys that a grip handles do not reach the page, which has other uses for them. */
export function keys(button: HTMLButtonElement, handle: (event: KeyboardEvent) => boolean): void {
  button.addEventListener("keydown", (event) => {
    if (!handle(event)) return;
    event.preventDefault();
    event.stopPropagation();
  });
}
