// Rectangles of cards, bars and banners over the picture: words keep out of them.
import type { Rect } from "./labelLayout";

const PANELS = [
  ...[".view-bar", ".legend", ".cube", ".force-legend", ".scale-bar"],
  ...[".badges", ".picked", ".view-banner"],
].join(", ");

export class Panels {
  rects: readonly Rect[] = [];
  private end: (() => void) | null = null;

  /** Look after the panels of a stage until another is given, or none; `moved` when one has moved. */
  watch(stage: HTMLElement | null, moved: () => void): void {
    this.end?.();
    this.end = null;
    this.rects = [];
    if (!stage) return;
    const measure = () => {
      this.rects = rectsIn(stage);
      moved();
    };
    const sizes = new ResizeObserver(measure);
    const watchAll = () => {
      sizes.disconnect();
      sizes.observe(stage);
      for (const panel of stage.querySelectorAll(PANELS)) sizes.observe(panel);
    };
    // They come and go as children of the stage; the words of the picture are elsewhere.
    const children = new MutationObserver(watchAll);
    children.observe(stage, { childList: true });
    watchAll();
    this.end = () => {
      sizes.disconnect();
      children.disconnect();
    };
  }
}

function rectsIn(stage: HTMLElement): Rect[] {
  const from = stage.getBoundingClientRect();
  return [...stage.querySelectorAll(PANELS)].flatMap((panel) => {
    const { left, top, right, bottom } = panel.getBoundingClientRect();
    if (right <= left || bottom <= top) return [];
    return [
      {
        left: left - from.left,
        top: top - from.top,
        right: right - from.left,
        bottom: bottom - from.top,
      },
    ];
  });
}
