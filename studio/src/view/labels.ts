// Words in the picture: HTML elements that follow points of the body, outside of React.
import { type Camera, Vector3 } from "three";

export interface Label {
  readonly key: string;
  readonly kind:
    | "clamp"
    | "layer"
    | "load"
    | "probe"
    | "cavity"
    | "leak"
    | "extreme"
    | "force"
    | "tape";
  readonly text: string;
  readonly title?: string;
  readonly color?: string;
  at(out: Vector3): Vector3;
  onClick?(): void;
}

const LINE = 21;
// So many lines a label moves down to be read; a crowd beyond that shows its dots.
const MOST_MOVED = 3;

export class Labels {
  readonly element = document.createElement("div");
  private shown = new Map<string, { label: Label; element: HTMLElement }>();
  private readonly point = new Vector3();

  constructor() {
    this.element.className = "view-labels";
  }

  set(labels: readonly Label[]): void {
    const gone = new Set(this.shown.keys());
    for (const label of labels) {
      gone.delete(label.key);
      let element = this.shown.get(label.key)?.element;
      // What can be clicked is a button; a word that becomes clickable becomes one.
      if (element && element instanceof HTMLButtonElement !== Boolean(label.onClick)) {
        element.remove();
        element = undefined;
      }
      if (!element) {
        element = document.createElement(label.onClick ? "button" : "span");
        element.className = `view-label ${label.kind}`;
        if (element instanceof HTMLButtonElement) element.type = "button";
        element.dataset.testid = `label-${label.key}`;
        this.element.append(element);
      }
      if (element.textContent !== label.text) element.textContent = label.text;
      // Its first line names a label that shows only its dot.
      if (label.title) element.title = `${label.text}\n${label.title}`;
      if (label.color) element.style.setProperty("--mark", label.color);
      element.onclick = label.onClick ?? null;
      this.shown.set(label.key, { label, element });
    }
    for (const key of gone) {
      this.shown.get(key)?.element.remove();
      this.shown.delete(key);
    }
  }

  place(camera: Camera, width: number, height: number): void {
    const taken: { x: number; y: number; w: number }[] = [];
    for (const { label, element } of this.shown.values()) {
      const at = label.at(this.point).project(camera);
      const visible = at.z > -1 && at.z < 1 && Math.abs(at.x) < 1.05 && Math.abs(at.y) < 1.05;
      element.hidden = !visible;
      if (!visible) continue;
      const x = ((at.x + 1) / 2) * width;
      const y = ((1 - at.y) / 2) * height;
      const w = 7 * label.text.length + 24;
      const free = (moved: number) =>
        !taken.some(
          (one) =>
            Math.abs(one.y - y - LINE * moved) < LINE - 1 && Math.abs(one.x - x) < (one.w + w) / 2,
        );
      // Labels that would lie over each other move down, and a line leads back to their point.
      let moved = 0;
      while (moved <= MOST_MOVED && !free(moved)) moved++;
      const crowded = moved > MOST_MOVED && label.kind === "probe";
      if (crowded) moved = 0;
      else taken.push({ x, y: y + LINE * moved, w });
      element.classList.toggle("crowded", crowded);
      element.classList.toggle("moved", moved > 0);
      element.style.setProperty("--lead", `${LINE * moved}px`);
      // Whole pixels: letters stay sharp, and a word that trembles stays where it is.
      element.style.transform = `translate(${Math.round(x)}px, ${Math.round(y + LINE * moved)}px)`;
    }
  }
}
