// Words in the picture: HTML elements that follow points of the body, outside of React.
import { type Camera, Vector3 } from "three";

export interface Label {
  readonly key: string;
  readonly kind: "clamp" | "load" | "probe" | "cavity" | "leak" | "extreme" | "force" | "tape";
  readonly text: string;
  readonly title?: string;
  readonly color?: string;
  at(out: Vector3): Vector3;
  onClick?(): void;
}

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
      if (label.title) element.title = label.title;
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
      let y = ((1 - at.y) / 2) * height;
      const w = 7 * label.text.length + 24;
      // Labels that would lie over each other move down by a line.
      while (taken.some((one) => Math.abs(one.y - y) < 20 && Math.abs(one.x - x) < (one.w + w) / 2))
        y += 21;
      taken.push({ x, y, w });
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }
}
