// Marks of contact in the unloaded design: dots where surfaces are bonded, the floor, and words for pairs of contact.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  LineBasicMaterial,
  LineLoop,
  Points,
  PointsMaterial,
} from "three";
import { formatNumber, formatQuantity } from "../../controls/units";
import { meetingOf, pairsOf } from "../../panes/design/bodies/pairs";
import type { Room } from "../../panes/design/bodies/placing";
import { BODY, roomOf } from "../../panes/design/bodies/several";
import type { BodyBond, BodyEvent } from "../../protocol";
import { showPane } from "../../shell/actions";
import type { Label } from "./labels";

const BOND_COLOR = "#35b8c0";
const TOUCH_COLOR = "#98a1ab";
const FLOOR = "floor";
/** Margin of the drawn floor beyond the body, as a part of its size. */
const BEYOND = 0.5;

type Table = Readonly<Record<string, unknown>>;

export interface Meets {
  readonly of: readonly [string, string];
  readonly text: string;
  readonly title: string;
  /** In the middle between the two, m. */
  readonly at: readonly [number, number, number];
}

/**
 * The pairs named in the picture: those that the design names, and those of the chosen entry.
 *
 * `design` holds the values of the document. Bonds have dots and words of their own.
 */
export function meetsOf(body: BodyEvent, design: Table | null, chosen: string | null): Meets[] {
  const contact = design?.contact;
  const bodies = body.bodies.length > 0 ? body.bodies.map(({ name }) => name) : [BODY];
  const named = pairsOf(contact).map(({ of }) => of as readonly [string, string]);
  const own = body.objects.some(({ name }) => name === chosen)
    ? bodies.map((name): [string, string] => [name, chosen as string])
    : [];
  const seen = new Set<string>();
  return [...named, ...own].flatMap(([a, b]) => {
    const key = [a, b].sort().join(" ");
    const { kind, friction } = meetingOf(contact, a, b);
    if (seen.has(key) || kind === "bonded") return [];
    seen.add(key);
    const at = between(boxOf(a, body, design), boxOf(b, body, design));
    if (!at) return [];
    const rubs = typeof friction === "number" && friction > 0;
    const touching = rubs ? `friction ${formatNumber(friction, 3)}` : "no friction";
    const who = a === b ? `${a} on itself` : `${a} and ${b}`;
    return [
      {
        ...{ of: [a, b] as const, at, text: kind === "none" ? "no contact" : touching },
        title: kind === "none" ? `${who} pass through each other` : `Contact of ${who}`,
      },
    ];
  });
}

function boxOf(name: string, body: BodyEvent, design: Table | null): Room | null {
  if (name !== FLOOR) return roomOf(name, body);
  const z = heightOf(design);
  return z === null ? null : { low: [-Infinity, -Infinity, z], high: [Infinity, Infinity, z] };
}

/** Height of the floor of a design, m; null where it has none. */
function heightOf(design: Table | null): number | null {
  const z = (design?.floor as { z?: unknown } | null | undefined)?.z;
  return typeof z === "number" ? z : null;
}

/** The corners of the drawn floor: a square under the body and somewhat beyond, m. */
export function floorCorners([low, high]: BodyEvent["bounds"], z: number): number[][] {
  const side = 0.5 * (1 + BEYOND) * Math.max(high[0] - low[0], high[1] - low[1]);
  const [x, y] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  return [
    [x - side, y - side, z],
    [x + side, y - side, z],
    [x + side, y + side, z],
    [x - side, y + side, z],
  ];
}

/** The middle of the room shared by two boxes, or of the gap between them. */
function between(a: Room | null, b: Room | null): [number, number, number] | null {
  if (!a || !b) return null;
  return [0, 1, 2].map(
    (i) => (Math.max(a.low[i]!, b.low[i]!) + Math.min(a.high[i]!, b.high[i]!)) / 2,
  ) as [number, number, number];
}

export class ContactMarks {
  readonly group = new Group();
  // Kept from body to body: its shader would have to be compiled for each again.
  private readonly dots = new PointsMaterial({
    color: new Color(BOND_COLOR),
    ...{ size: 5, sizeAttenuation: false, transparent: true, opacity: 0.95, depthTest: false },
  });
  private readonly rim = new LineBasicMaterial({ color: new Color(TOUCH_COLOR) });
  private bonds: readonly BodyBond[] = [];

  build(
    bonds: readonly BodyBond[],
    bounds: BodyEvent["bounds"] | null,
    design: Table | null,
  ): void {
    for (const child of this.group.children) (child as Points).geometry.dispose();
    this.group.clear();
    const z = heightOf(design);
    if (bounds && z !== null) {
      const corners = new Float32Array(floorCorners(bounds, z).flat());
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(corners, 3));
      const drawing = new LineLoop(geometry, this.rim);
      drawing.frustumCulled = false;
      this.group.add(drawing);
    }
    this.bonds = bonds.filter(({ points }) => points.length > 0);
    for (const { points } of this.bonds) {
      const geometry = new BufferGeometry();
      const places = new Float32Array(points.flat());
      geometry.setAttribute("position", new BufferAttribute(places, 3));
      const drawing = new Points(geometry, this.dots);
      // Over the rigid objects, through which they are seen.
      drawing.renderOrder = 8;
      drawing.frustumCulled = false;
      this.group.add(drawing);
    }
  }

  labels(body: BodyEvent, design: Table | null, chosen: string | null): Label[] {
    const onClick = () => showPane("design");
    const bonds = this.bonds.map(({ of, strength, points }): Label => {
      const middle = [0, 1, 2].map(
        (i) => points.reduce((sum, point) => sum + point[i]!, 0) / points.length,
      ) as [number, number, number];
      const until = strength === null ? "" : `, up to ${formatQuantity(strength, "Pa", 3)}`;
      return {
        key: `bond-${of.join("-")}`,
        kind: "touch",
        text: `bonded${until}`,
        title: `${of[0]} and ${of[1]} are bonded where the dots are`,
        color: BOND_COLOR,
        at: (out) => out.set(...middle),
        onClick,
      };
    });
    const meets = meetsOf(body, design, chosen).map(
      ({ of, text, title, at }): Label => ({
        key: `meets-${of.join("-")}`,
        kind: "touch",
        ...{ text, title, color: TOUCH_COLOR, onClick },
        at: (out) => out.set(...at),
      }),
    );
    const z = heightOf(design);
    if (z === null) return [...bonds, ...meets];
    const corner = floorCorners(body.bounds, z)[0] as [number, number, number];
    const friction = (design?.contact as { friction?: unknown } | null | undefined)?.friction;
    const rubs = typeof friction === "number" && friction > 0;
    const floor: Label = {
      key: "floor",
      kind: "touch",
      text: rubs ? `floor, friction ${formatNumber(friction, 3)}` : "floor",
      title: "Nothing sinks through this plane",
      color: TOUCH_COLOR,
      at: (out) => out.set(...corner),
      onClick,
    };
    return [...bonds, ...meets, floor];
  }
}
