import { type RefObject, useEffect } from "react";

/**
 * Calls `close` on Escape and on a press outside of the element, as long as that is open; the
 * button that opened it closes it itself.
 */
export function useAway(
  box: RefObject<HTMLElement | null>,
  open: boolean,
  close: (by: "escape" | "press") => void,
  opener: HTMLElement | null = null,
): void {
  useEffect(() => {
    if (!open) return;
    const press = (event: PointerEvent) => {
      const at = event.target as Node;
      if (!box.current?.contains(at) && !opener?.contains(at)) close("press");
    };
    const key = (event: KeyboardEvent) => {
      if (event.key !== "Escape") return;
      // One Escape does one thing: cards over the picture close before its tools end.
      event.stopPropagation();
      close("escape");
    };
    addEventListener("pointerdown", press, true);
    addEventListener("keydown", key, true);
    return () => {
      removeEventListener("pointerdown", press, true);
      removeEventListener("keydown", key, true);
    };
  });
}
