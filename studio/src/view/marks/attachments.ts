// Attachments of the body, such as springs and tendons: a line through the places that it joins, which move with it.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Line,
  LineBasicMaterial,
  Points,
  PointsMaterial,
  Vector3,
} from "three";
import type { BodyAttachment, BodyLoad, BodyPlace, StatEvent } from "../../protocol";
import { showPane } from "../../shell/actions";
import type { Places } from "../hands/target";
import type { Label } from "./labels";
import { loadText } from "./symbols";

const COLOR = "#7ac74f";

interface Drawn {
  readonly attachment: BodyAttachment;
  readonly places: BufferAttribute;
}

/** Present center of a place, moved as its vertices are on the mean. */
export function placeNow(place: BodyPlace, mesh: Places, exaggeration: number): Vector3 {
  const center = new Vector3(...place.center);
  if (place.vertices.length === 0 || mesh.topology.tets) return center;
  const { rest } = mesh.topology;
  const moved = new Vector3();
  const one = new Vector3();
  for (const vertex of place.vertices) {
    moved.add(mesh.place(vertex, exaggeration, one));
    moved.sub(one.fromArray(rest, 3 * vertex));
  }
  return center.addScaledVector(moved, 1 / place.vertices.length);
}

export class Attachments {
  readonly group = new Group();
  private readonly line = new LineBasicMaterial({ color: new Color(COLOR), depthTest: false });
  private readonly ends = new PointsMaterial({
    color: new Color(COLOR),
    size: 6,
    sizeAttenuation: false,
    depthTest: false,
  });
  private drawn: Drawn[] = [];
  private geometries: BufferGeometry[] = [];

  build(attachments: readonly BodyAttachment[]): void {
    this.group.clear();
    for (const geometry of this.geometries) geometry.dispose();
    this.geometries = [];
    this.drawn = attachments.map((attachment) => {
      const start = attachment.places.flatMap((place) => place.center);
      const places = new BufferAttribute(new Float32Array(start), 3);
      const geometry = new BufferGeometry().setAttribute("position", places);
      // Dots at its ends alone: a line that bends with the body has many places.
      const [count, step] = [attachment.places.length, attachment.places.length - 1];
      const ends = new BufferGeometry().setAttribute("position", places);
      ends.setIndex(count > 1 ? [0, step] : [0]);
      this.geometries.push(geometry, ends);
      for (const drawing of [new Line(geometry, this.line), new Points(ends, this.ends)]) {
        drawing.frustumCulled = false;
        drawing.renderOrder = 7;
        this.group.add(drawing);
      }
      return { attachment, places };
    });
  }

  /** Draw everything where it is now, and give the words. */
  update(
    mesh: Places,
    exaggeration: number,
    loads: readonly BodyLoad[],
    stat: StatEvent | null,
  ): Label[] {
    return this.drawn.map(({ attachment, places }, i) => {
      const middle = new Vector3();
      attachment.places.forEach((place, at) => {
        const now = placeNow(place, mesh, exaggeration);
        places.setXYZ(at, now.x, now.y, now.z);
        middle.addScaledVector(now, 1 / attachment.places.length);
      });
      places.needsUpdate = true;
      const load = loads.find(({ index }) => index === attachment.load);
      return {
        key: `attachment-${i}`,
        kind: "attachment",
        text: load ? `${attachment.name} ${loadText(load, stat)}` : attachment.name,
        title: attachment.summary,
        color: COLOR,
        at: (out) => out.copy(middle),
        onClick: () => showPane(load ? "run" : "design"),
      };
    });
  }
}
