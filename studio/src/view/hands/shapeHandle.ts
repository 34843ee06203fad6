// The grips that move and size the chosen shape: dragged, moved by keys, or typed as numbers. Each
// changes one number of the design, or the parameter that this number is.
import { Matrix3, type Matrix4, Vector3 } from "three";
import { NUMBERS } from "../../panes/design/shapes/gripKinds";
import { snappedValue } from "../../panes/design/shapes/shapeGrips";
import type { ShapeGrip } from "../../panes/design/shapes/shapeReader";
import type { CameraRig } from "../drawing/camera";
import type { Rect } from "../marks/labelLayout";
import { drags, GRIP, grip as gripButton, keys, put } from "./grips";
import { previewOf } from "./shapePreview";

/** Distance from the middle of grips that move, and least distance of those that size, pixels. */
const FAR = 86;
const NEAR = 44;
/** Between two grips along one axis, pixels. */
const APART = 30;
/** An axis that points at the eye has no way in the picture: its cosine to the picture is less than this. */
const LEAST_WAY = 0.2;
/** Radius of the ring of an angle, pixels, and the corners that it is drawn with. */
const RING = 112;
const CORNERS = 48;
/** Places of the grip on it, from where it is seen best, radians: clear of other grips. */
const TURNS = [0, -0.5, 0.5, -1, 1];
/** Keys move a shape by this, m; all else they change by the step of its drags. */
const KEY_MOVE = 1e-3;
/** A shape that was dropped comes anew within this time, ms, or it does not. */
const LONGEST_WAIT = 3000;
const SIGNS: Readonly<Record<string, number>> = {
  ...{ ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 },
};
/** Room of a number beside its grip, pixels. */
const NUMBER = { height: 18, aside: GRIP + 4, letter: 6.6 } as const;

/** The shape that is edited: its grips, the frame that it is in, and its middle there, m. */
export interface Edited {
  readonly grips: readonly ShapeGrip[];
  readonly pose: Matrix4;
  readonly middle: Vector3;
}

/** Requests of the handle; a typed text gives its error, or null. */
export interface ShapeEdits {
  changed(): void;
  dropped(grip: ShapeGrip, value: number): void;
  stepped(grip: ShapeGrip, value: number): void;
  typed(grip: ShapeGrip, text: string): string | null;
}

/** The number beside a grip, with the parameter that it is. */
export function numberText({ sign, number, kind }: ShapeGrip, value: number): string {
  const amount = NUMBERS[kind].text(value);
  const own = number.parameter ? `${number.parameter} = ${amount}` : amount;
  return sign ? `${sign} ${own}` : own;
}

/** Effect of a grip, for those who do not see it. */
export function gripLabel({ label, number, kind }: ShapeGrip, value: number): string {
  const amount = NUMBERS[kind].text(value);
  if (number.blocked) return `${label}: ${amount} ${number.blocked}`;
  const through = number.parameter ? ` It changes the parameter ${number.parameter}.` : "";
  return `${label}: ${amount}. Drag, arrow keys, or Enter to type.${through}`;
}

/** Place of a grip on the ring about an axis where it is seen best: on the side of the eye. */
export function frontOf(axis: Vector3, toEye: Vector3, right: Vector3): Vector3 {
  const front = toEye.clone().addScaledVector(axis, -axis.dot(toEye));
  // Seen along its axis a ring is the same to all sides.
  if (front.length() < LEAST_WAY) front.copy(right).addScaledVector(axis, -axis.dot(right));
  return front.normalize();
}

interface Item {
  grip: ShapeGrip;
  readonly button: HTMLButtonElement;
  readonly number: HTMLButtonElement;
  readonly line: SVGLineElement;
  /** The ring of an angle. */
  readonly ring: SVGPathElement | null;
  /** The way of the grip in the picture, and pixels for each meter, or radian. */
  way: { x: number; y: number; pixels: number };
  input: HTMLInputElement | null;
  /** Place on its ring, from where it would be seen best, radians. */
  turn: number;
}

interface Tip {
  readonly x: number;
  readonly y: number;
}

export class ShapeHandle {
  readonly element = document.createElement("div");
  /** Part of the picture that its grips and numbers take. */
  grips: readonly Rect[] = [];
  private readonly drawing = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly outline = document.createElementNS("http://www.w3.org/2000/svg", "path");
  private readonly items = new Map<string, Item>();
  private held: { grip: ShapeGrip; value: number } | null = null;
  /** A dropped shape is drawn as it was until the shape comes anew. */
  private dropped: { grip: ShapeGrip; value: number } | null = null;

  constructor(
    private readonly rig: CameraRig,
    private readonly edits: ShapeEdits,
  ) {
    this.element.className = "section-handle shape-handle";
    this.element.hidden = true;
    this.outline.classList.add("outline");
    this.drawing.append(this.outline);
    this.element.append(this.drawing);
  }

  /** Transform of the drawn shape while a grip is held, in its own frame; null where it is unchanged. */
  get preview(): Matrix4 | null {
    const shown = this.held ?? this.dropped;
    return shown && previewOf(shown.grip, shown.value);
  }

  /** The shape has come anew. */
  forget(): void {
    this.dropped = null;
  }

  /** Put the grips where the shape is drawn, in a picture of some pixels; hide them for null. */
  place(edited: Edited | null, width: number, height: number): void {
    this.element.hidden = edited === null || edited.grips.length === 0;
    this.grips = [];
    const wanted = new Set(edited?.grips.map((grip) => grip.id));
    for (const [id, item] of this.items) if (!wanted.has(id)) this.remove(id, item);
    if (!edited) {
      this.held = this.dropped = null;
      return;
    }
    const page = (point: Vector3): Tip => {
      const at = point.clone().project(this.rig.camera);
      return { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height };
    };
    this.outline.setAttribute("d", this.outlineOf(edited, page));
    const middle = edited.middle.clone();
    if (this.preview) middle.applyMatrix4(this.preview);
    const center = page(middle.applyMatrix4(edited.pose));
    const sizes = edited.grips.filter((grip) => !grip.moves && !("about" in grip.way));
    const moves = edited.grips.filter((grip) => grip.moves);
    const taken = new Map<string, number>();
    const rects: Rect[] = [];
    for (const grip of [...sizes, ...moves]) {
      const item = this.itemOf(grip);
      const along = this.wayOf(grip, edited.pose);
      const from = grip.moves
        ? this.standOf(item, along, middle, edited.pose)
        : this.endOf(item, along, edited.pose);
      const start = page(from);
      const next = page(from.clone().addScaledVector(along, NEAR / this.rig.pixelsPerMeter));
      const [dx, dy] = [next.x - start.x, next.y - start.y];
      const long = Math.hypot(dx, dy);
      const seen = long > LEAST_WAY * NEAR && Number.isFinite(long);
      this.show(item, seen);
      if (!seen) continue;
      const [x, y] = [dx / long, dy / long];
      item.way = { x, y, pixels: (long / NEAR) * this.rig.pixelsPerMeter };
      const axis = "along" in grip.way ? String(grip.way.along) : grip.id;
      const out = (start.x - center.x) * x + (start.y - center.y) * y;
      let beyond = grip.moves ? FAR : Math.max(NEAR - out, 0);
      const other = taken.get(axis);
      if (grip.moves && other !== undefined && Math.abs(other - FAR) < APART)
        beyond = other + APART + 4;
      // Two numbers that end at one place stand one behind the other.
      if (!grip.moves && other !== undefined && Math.abs(out + beyond - other) < APART)
        beyond = other + APART - out;
      if (!grip.moves) taken.set(axis, out + beyond);
      const beside = { x: start.x + x * beyond, y: start.y + y * beyond };
      const tip = grip.moves ? beside : within(center, beside, width, height);
      this.draw(item, start, tip);
      rects.push(...rectsOf(tip, item.number.textContent ?? ""));
    }
    for (const grip of edited.grips.filter((one) => "about" in one.way)) {
      const item = this.itemOf(grip);
      const tip = this.turn(item, edited.pose, page, rects);
      if (tip) rects.push(...rectsOf(tip, item.number.textContent ?? ""));
    }
    this.grips = rects;
  }

  // The ring of an angle about its axis, and its grip on it; null where it has no way in the picture.
  private turn(
    item: Item,
    pose: Matrix4,
    page: (point: Vector3) => Tip,
    taken: readonly Rect[],
  ): Tip | null {
    const { grip } = item;
    if (!("about" in grip.way)) return null;
    const axis = new Vector3(...grip.way.about).applyMatrix3(new Matrix3().setFromMatrix4(pose));
    const center = new Vector3(...grip.from).applyMatrix4(pose);
    const right = new Vector3(1, 0, 0).applyQuaternion(this.rig.orientation);
    const front = frontOf(axis, this.rig.toEye, right);
    const radius = RING / this.rig.pixelsPerMeter;
    const at = (angle: number) =>
      center.clone().addScaledVector(front.clone().applyAxisAngle(axis, angle), radius);
    const by = this.valueOf(grip) - grip.value;
    const known = this.held?.grip.id === grip.id;
    const isClear = (turn: number) =>
      rectsOf(page(at(turn)), numberText(grip, grip.value)).every((own) =>
        taken.every((other) => !overlap(own, other)),
      );
    // While it is held it goes on from where it was taken.
    if (!known) item.turn = TURNS.find(isClear) ?? 0;
    const here = item.turn + by;
    const [tip, next] = [page(at(here)), page(at(here + 1e-3))];
    const [dx, dy] = [(next.x - tip.x) * 1e3, (next.y - tip.y) * 1e3];
    const pixels = Math.hypot(dx, dy);
    const seen = Number.isFinite(pixels) && (known || pixels > LEAST_WAY * RING);
    this.show(item, seen);
    if (!seen) return null;
    // If the ring turns away from the eye it goes on as it went before.
    if (pixels > LEAST_WAY * RING) item.way = { x: dx / pixels, y: dy / pixels, pixels };
    const corners = Array.from({ length: CORNERS + 1 }, (_, i) =>
      page(at((2 * Math.PI * i) / CORNERS)),
    );
    item.ring?.setAttribute("d", pathOf(corners));
    this.draw(item, page(center), tip);
    return tip;
  }

  // Lines that show the meaning of numbers: of the grip that is held, as it would be.
  private outlineOf(edited: Edited, page: (point: Vector3) => Tip): string {
    const lines = edited.grips.flatMap((grip) => {
      const known = this.held ?? this.dropped;
      return grip.outline?.(known?.grip.id === grip.id ? known.value : grip.value) ?? [];
    });
    const drawn = lines.map((line) =>
      pathOf(line.map((point) => page(new Vector3(...point).applyMatrix4(edited.pose)))),
    );
    return drawn.join("");
  }

  // Start of a grip that moves: in the middle of the shape, or at the point that it moves.
  private standOf({ grip }: Item, along: Vector3, middle: Vector3, pose: Matrix4): Vector3 {
    if (!grip.at) return middle;
    const by = this.valueOf(grip) - grip.value;
    return new Vector3(...grip.at).applyMatrix4(pose).addScaledVector(along, by);
  }

  // The direction of a grip in the picture's frame.
  private wayOf({ way }: ShapeGrip, pose: Matrix4): Vector3 {
    const turn = new Matrix3().setFromMatrix4(pose);
    if ("along" in way) return new Vector3(...way.along).applyMatrix3(turn).normalize();
    const right = new Vector3(1, 0, 0).applyQuaternion(this.rig.orientation);
    const up = new Vector3(0, 1, 0).applyQuaternion(this.rig.orientation);
    const aside = right.clone().add(up).normalize().negate();
    if (!("around" in way) || !way.around) return aside;
    const axis = new Vector3(...way.around).applyMatrix3(turn);
    const across = axis.cross(this.rig.toEye);
    // Seen along its axis it is as wide to all sides.
    if (across.length() < LEAST_WAY) return aside;
    return across.multiplyScalar(across.dot(right) > 0 ? -1 : 1).normalize();
  }

  // Present end of the number of a grip, in the picture's frame.
  private endOf({ grip }: Item, along: Vector3, pose: Matrix4): Vector3 {
    const reach = grip.reach + (this.valueOf(grip) - grip.value) / grip.rate;
    return new Vector3(...grip.from).applyMatrix4(pose).addScaledVector(along, reach);
  }

  private valueOf(grip: ShapeGrip): number {
    return this.held?.grip.id === grip.id ? this.held.value : grip.value;
  }

  private draw(item: Item, from: Tip, tip: Tip): void {
    const { grip, button, number, line } = item;
    const value = this.valueOf(grip);
    const ends = { x1: from.x, y1: from.y, x2: tip.x, y2: tip.y };
    for (const [name, at] of Object.entries(ends)) line.setAttribute(name, at.toFixed(1));
    put(button, tip, 0);
    const label = gripLabel(grip, value);
    if (button.title !== label) {
      button.title = label;
      button.setAttribute("aria-label", label);
    }
    const text = numberText(grip, value);
    if (number.textContent !== text) number.textContent = text;
    const at = `translate(${(tip.x + NUMBER.aside).toFixed(0)}px, ${(tip.y - NUMBER.height / 2).toFixed(0)}px)`;
    number.style.transform = at;
    if (item.input) item.input.style.transform = at;
  }

  private show({ button, number, line, ring, input }: Item, seen: boolean): void {
    button.hidden = !seen;
    number.hidden = !seen || input !== null;
    for (const drawn of [line, ring]) if (drawn) drawn.style.display = seen ? "" : "none";
  }

  private itemOf(grip: ShapeGrip): Item {
    const known = this.items.get(grip.id) ?? this.made(grip);
    // While it is held it stays as it was when it was taken.
    if (this.held?.grip.id !== grip.id) known.grip = grip;
    const { button, number } = known;
    const blocked = known.grip.number.blocked !== null;
    for (const part of [button, number]) part.classList.toggle("is-blocked", blocked);
    if (blocked) button.setAttribute("aria-disabled", "true");
    else button.removeAttribute("aria-disabled");
    number.title = blocked ? gripLabel(known.grip, known.grip.value) : "Type the number";
    return known;
  }

  private made(grip: ShapeGrip): Item {
    const axis = "xyz".includes(grip.id.at(-1)!) && grip.id.includes("-") ? grip.id.at(-1)! : "own";
    const button = gripButton(`shape-${grip.id}`, grip.label, grip.moves ? grip.sign : "");
    button.classList.add(grip.moves ? "move-grip" : "size-grip", axis);
    if ("about" in grip.way) button.classList.add("turn-grip");
    const number = document.createElement("button");
    number.type = "button";
    number.tabIndex = -1; // Enter on the grip does the same
    number.className = "grip-number";
    number.dataset.testid = `number-${grip.id}`;
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    line.classList.add(axis);
    this.drawing.append(line);
    const ring =
      "about" in grip.way ? document.createElementNS("http://www.w3.org/2000/svg", "path") : null;
    ring?.classList.add("ring");
    if (ring) this.drawing.append(ring);
    this.element.append(button, number);
    const way = { x: 0, y: -1, pixels: 1 };
    const item: Item = { grip, button, number, line, ring, way, input: null, turn: 0 };
    this.items.set(grip.id, item);
    this.listen(item);
    return item;
  }

  private listen(item: Item): void {
    const { button, number } = item;
    drags(
      button,
      () => {
        const { grip } = item;
        const { step, fine: fineStep } = NUMBERS[grip.kind];
        let wanted = grip.value;
        this.dropped = null;
        return (dx, dy, fine) => {
          if (grip.number.blocked) return;
          // The way of an angle turns with it.
          const { x, y, pixels } = item.way;
          wanted += (grip.rate * (dx * x + dy * y)) / pixels;
          this.held = { grip, value: snappedValue(grip, wanted, fine ? fineStep : step) };
          this.edits.changed();
        };
      },
      () => {
        const { held } = this;
        this.held = null;
        if (held && Math.abs(held.value - held.grip.value) > 1e-9) {
          this.drop(held);
        }
        this.edits.changed();
      },
    );
    keys(button, (event) => {
      const { grip } = item;
      const sign = SIGNS[event.key];
      if (sign === undefined && event.key !== "Enter") return false;
      if (grip.number.blocked) return true;
      if (sign === undefined) this.type(item);
      else {
        const { step: usual, fine } = NUMBERS[grip.kind];
        const step = event.shiftKey ? fine : grip.moves ? KEY_MOVE : usual;
        const value = snappedValue(grip, grip.value + sign * step, fine / 100);
        if (value !== grip.value) this.edits.stepped(grip, value);
      }
      return true;
    });
    const type = () => item.grip.number.blocked === null && this.type(item);
    button.addEventListener("dblclick", type);
    number.addEventListener("click", type);
  }

  // The shape comes anew soon; where it does not, it is shown as it still is.
  private drop(held: { grip: ShapeGrip; value: number }): void {
    this.dropped = held;
    this.edits.dropped(held.grip, held.value);
    setTimeout(() => {
      if (this.dropped === held) this.forget();
      this.edits.changed();
    }, LONGEST_WAIT);
  }

  // A field in place of the number; Enter or leaving it takes the typed text.
  private type(item: Item): void {
    if (item.input) return;
    const { grip } = item;
    const input = document.createElement("input");
    input.className = "input grip-input";
    input.dataset.testid = `typed-${grip.id}`;
    input.setAttribute("aria-label", grip.label);
    const written = NUMBERS[grip.kind].text(grip.value);
    input.value = written;
    input.style.transform = item.number.style.transform;
    const wrong = document.createElement("span");
    wrong.className = "grip-problem";
    wrong.id = `problem-${grip.id}`;
    wrong.setAttribute("role", "alert");
    wrong.hidden = true;
    wrong.style.transform = input.style.transform;
    input.setAttribute("aria-describedby", wrong.id);
    item.input = input;
    item.number.hidden = true;
    this.element.append(input, wrong);
    const end = (refocus: boolean) => {
      if (item.input !== input) return;
      item.input = null;
      input.remove();
      wrong.remove();
      if (refocus) item.button.focus();
      this.edits.changed();
    };
    const take = (): boolean => {
      const same = input.value.trim() === written;
      const problem = same ? null : this.edits.typed(grip, input.value);
      wrong.textContent = problem ?? "";
      wrong.hidden = problem === null;
      input.setAttribute("aria-invalid", String(problem !== null));
      return problem === null;
    };
    input.addEventListener("keydown", (event) => {
      event.stopPropagation(); // the page has other uses for keys
      if (event.key === "Escape") end(true);
      else if (event.key === "Enter" && take()) end(true);
    });
    input.addEventListener("blur", () => {
      take();
      end(false);
    });
    input.focus();
    input.select();
  }

  private remove(id: string, item: Item): void {
    for (const part of [item.button, item.number, item.line, item.ring]) part?.remove();
    item.input?.remove();
    this.items.delete(id);
    if (this.held?.grip.id === id) this.held = null;
  }
}

const pathOf = (points: readonly Tip[]): string =>
  points.map(({ x, y }, i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

/** A place or, where that is outside of the picture, the last one on the way there from a center that is in it. */
export function within(center: Tip, place: Tip, width: number, height: number): Tip {
  const part = (from: number, to: number, most: number) => {
    if (to < GRIP) return (from - GRIP) / (from - to);
    return to > most - GRIP ? (most - GRIP - from) / (to - from) : 1;
  };
  const share = Math.min(part(center.x, place.x, width), part(center.y, place.y, height));
  if (!(share >= 0 && share < 1)) return place;
  const toward = (from: number, to: number) => from + share * (to - from);
  return { x: toward(center.x, place.x), y: toward(center.y, place.y) };
}

const overlap = (a: Rect, b: Rect): boolean =>
  a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

function rectsOf({ x, y }: Tip, text: string): Rect[] {
  const left = x + NUMBER.aside;
  const half = NUMBER.height / 2;
  return [
    { left: x - GRIP, right: x + GRIP, top: y - GRIP, bottom: y + GRIP },
    { left, right: left + NUMBER.letter * text.length + 8, top: y - half, bottom: y + half },
  ];
}
