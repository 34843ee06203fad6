// Words in the picture: HTML elements that follow points of the body, outside of React.
import { type Camera, Vector3 } from "three";
import { LINE, type Rect, standWords, type Word } from "./labelLayout";

export interface Label {
  readonly key: string;
  readonly kind:
    | "clamp"
    | "layer"
    | "attachment"
    | "body"
    | "object"
    | "shape"
    | "load"
    | "probe"
    | "cavity"
    | "leak"
    | "overlap"
    | "plane"
    | "extreme"
    | "spot"
    | "force"
    | "touch"
    | "tape";
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
      // A label that can be clicked is a button; a word that becomes clickable becomes one.
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

  /** Put each word at its point, clear of the others and of buttons in the picture. */
  place(camera: Camera, width: number, height: number, pressed: readonly Rect[] = []): void {
    const seen: { element: HTMLElement; word: Word }[] = [];
    for (const { label, element } of this.shown.values()) {
      const at = label.at(this.point).project(camera);
      const visible = at.z > -1 && at.z < 1 && Math.abs(at.x) < 1.05 && Math.abs(at.y) < 1.05;
      element.hidden = !visible;
      if (!visible) continue;
      const x = ((at.x + 1) / 2) * width;
      const y = ((1 - at.y) / 2) * height;
      const minor = label.kind === "probe";
      seen.push({ element, word: { x, y, width: 7 * label.text.length + 24, minor } });
    }
    const standing = standWords(
      seen.map((one) => one.word),
      pressed,
      width,
    );
    for (const [i, { element, word }] of seen.entries()) {
      const { lines, left, crowded } = standing[i]!;
      element.classList.toggle("crowded", crowded);
      // A line leads back to the point, where the word stands right below it.
      element.classList.toggle("moved", lines > 0 && left === 0);
      element.style.setProperty("--lead", `${LINE * lines}px`);
      // Whole pixels: letters stay sharp, and a word that trembles stays where it is.
      const [x, y] = [Math.round(word.x - left), Math.round(word.y + LINE * lines)];
      element.style.transform = `translate(${x}px, ${y}px)`;
    }
  }
}
