// Several bodies in the picture: each with its name, and a box around the one that is chosen.
import { Box3, Box3Helper, Color, Group, type LineBasicMaterial, Vector3 } from "three";
import { bodyNames, entryOf, isOf, roomOf } from "../../panes/design/bodies/several";
import type { BodyEvent, Triple } from "../../protocol";
import { showPane } from "../../shell/actions";
import { useStudio } from "../../store/studio";
import { setView } from "../../store/view";
import type { BodyMesh } from "../body/body";
import type { Label } from "./labels";

/** Color of the entry chosen in the form or the picture. */
export const CHOSEN_COLOR = "#f0b429";
const COLOR = "#b9c2cc";
/** Share of the chosen color in that of a chosen part. */
const TINT = 0.6;

/** The entry of the form that a body of the picture belongs to. */
function entryHere(name: string): string | null {
  return entryOf(name, bodyNames(useStudio.getState().document?.source ?? {}));
}

/** Colors of the parts, those of a chosen body marked. */
export function partColors(body: BodyEvent | null, chosen: string | null): string[] {
  const mark = new Color(CHOSEN_COLOR);
  return (body?.parts ?? []).map((part) =>
    isOf(part.body, chosen)
      ? `#${new Color(part.color).lerp(mark, TINT).getHexString()}`
      : part.color,
  );
}

/** The first and last drawn vertex of an entry, or null. */
export function verticesOf(body: BodyEvent, entry: string | null): [number, number] | null {
  const own = body.bodies.filter((one) => isOf(one.name, entry));
  if (own.length === 0) return null;
  return [
    Math.min(...own.map(({ vertices }) => vertices[0])),
    Math.max(...own.map(({ vertices }) => vertices[1])),
  ];
}

export class Several {
  readonly group = new Group();
  private readonly box = new Box3();
  private readonly frame = new Box3Helper(this.box, new Color(CHOSEN_COLOR));
  private drawn = "";

  constructor() {
    this.frame.renderOrder = 8;
    (this.frame.material as LineBasicMaterial).transparent = true;
    this.group.add(this.frame);
    this.frame.visible = false;
  }

  /** Draw the box of a body or object that is being moved by a shift, m. */
  placeMoved(body: BodyEvent, chosen: string, shift: Triple): void {
    const room = roomOf(chosen, body);
    this.frame.visible = room !== null;
    this.drawn = "";
    if (!room) return;
    this.box.set(new Vector3(...room.low), new Vector3(...room.high));
    this.box.translate(new Vector3(...shift));
  }

  /** Draw the box around the chosen body where its surface is drawn. */
  place(
    body: BodyEvent | null,
    surface: BodyMesh | null,
    chosen: string | null,
    exaggeration: number,
  ): void {
    const there = body && surface?.topology.id === body.topology ? verticesOf(body, chosen) : null;
    this.frame.visible = there !== null;
    if (!there || !surface) {
      this.drawn = "";
      return;
    }
    const frame = surface.frame;
    const key = `${surface.topology.id} ${frame?.number} ${frame?.time} ${chosen} ${exaggeration}`;
    if (key === this.drawn) return;
    this.drawn = key;
    const at = new Vector3();
    this.box.makeEmpty();
    for (let vertex = there[0]; vertex <= there[1]; vertex++)
      this.box.expandByPoint(surface.place(vertex, exaggeration, at));
    this.box.expandByScalar(0.05 * (surface.topology.voxelSize || 0));
  }

  labels(
    body: BodyEvent,
    surface: BodyMesh | null,
    chosen: string | null,
    exaggeration: number,
  ): Label[] {
    return body.bodies.map((one) => {
      const entry = entryHere(one.name);
      const marked = isOf(one.name, chosen);
      return {
        key: `body-${one.name}`,
        kind: "body",
        text: one.name,
        title: "A body of the design: show where it is described",
        color: marked ? CHOSEN_COLOR : COLOR,
        at: (out) => middleOf(one, surface, exaggeration, out),
        onClick: () => {
          setView({ chosen: entry ?? one.name });
          showPane("design");
        },
      };
    });
  }

  /** The entry of the form whose body has a drawn vertex. */
  entryAt(body: BodyEvent | null, vertex: number): string | null {
    const found = body?.bodies.find(
      ({ vertices: [first, last] }) => vertex >= first && vertex <= last,
    );
    return found ? entryHere(found.name) : null;
  }
}

/** The middle of a body: of a few of its vertices where they are drawn, as its box at rest moves with them. */
function middleOf(
  { bounds: [low, high], vertices: [first, last] }: BodyEvent["bodies"][number],
  surface: BodyMesh | null,
  exaggeration: number,
  out: Vector3,
): Vector3 {
  out
    .set(...low)
    .add(new Vector3(...high))
    .multiplyScalar(0.5);
  if (!surface || surface.topology.rest.length / 3 <= last) return out;
  const { rest } = surface.topology;
  const step = Math.max(1, Math.floor((last - first + 1) / SAMPLED));
  const moved = new Vector3();
  const at = new Vector3();
  let count = 0;
  for (let vertex = first; vertex <= last; vertex += step) {
    surface.place(vertex, exaggeration, at);
    moved.x += at.x - rest[3 * vertex]!;
    moved.y += at.y - rest[3 * vertex + 1]!;
    moved.z += at.z - rest[3 * vertex + 2]!;
    count += 1;
  }
  return out.addScaledVector(moved, 1 / count);
}

/** Vertices of a body that its word follows. */
const SAMPLED = 60;
