// Contact at a face that was pressed: objects that the body touches there, and bonds.
import { bytesOf } from "../../../engine/base64";
import type { BodyEvent, Parameter } from "../../../protocol";
import type { Axis, Face } from "../../../view/hands/face";
import { WIDER } from "../../../view/hands/seat";
import { meetingOf, pairChanges } from "../bodies/pairs";
import { boxOf, type Room, written, writtenPlace } from "../bodies/placing";
import { BODY } from "../bodies/several";
import type { Change } from "../edits";
import { freeName } from "../fields/starters";
import { FIRST_FRICTION } from "./gripHere";
import { coordinate, parametersAlong } from "./here";

type Table = Readonly<Record<string, unknown>>;
type Triple = readonly [number, number, number];

/** A design as it is written, with the values of its parameters. */
interface Design {
  readonly source: Table;
  readonly parameters: readonly Parameter[];
}

/** Something that the body can touch or be bonded to. */
export interface Offer {
  readonly id: string;
  readonly label: string;
  /** Name of the action done, for the toast. */
  readonly done: string;
  readonly changes: readonly Change[];
  /** The object that it adds. */
  readonly adds?: string;
  /** Why it is not offered, in the words of the label. */
  readonly disabled?: boolean;
}

/** A plate is so many voxels thick, or fills this part of the room that there is for it. */
const THICK = 2;
const FILLED = 0.9;
/** A plate that is pressed goes this part of the body's size into it. */
const PRESSED = 0.1;
/** Largest distance of bonded surfaces, in voxels, as contact has it. */
const BOND_REACH = 0.5;
/** Lengths are written to this, m. */
const DIGIT = 1e-6;
const FLOOR = "floor";

/** A length to two digits, m. */
const tidy = (meters: number) => Number(meters.toPrecision(2));
const inner = (text: string | number) => String(text).replace(/^=\s*/, "");
const isFormula = (text: string | number): text is string => String(text).startsWith("=");

/** A place some way beyond another that is written: its formula goes on, a number stays one. */
function beyond(text: string | number, meters: number, by: number): string | number {
  if (by === 0) return text;
  if (isFormula(text)) return `= ${inner(text)} ${by < 0 ? "-" : "+"} ${written(Math.abs(by))}`;
  return writtenPlace([meters + by, 0, 0])[0] as string | number;
}

/** End of the body's surface at a face, as it is written: never inside of it. */
function levelText(face: Face, axis: Axis, { parameters, source }: Design) {
  const level = face.seat!.level;
  const sign = face.normal[axis] > 0 ? 1 : -1;
  const text = coordinate(level, parametersAlong(axis, parameters, source), face.voxelSize);
  const outward = sign * Math.ceil((sign * level) / DIGIT - 0.01) * DIGIT;
  return { text: isFormula(text) ? text : coordinate(outward, [], face.voxelSize), level: outward };
}

/** Distances of a plate from both ends of a face along each axis, m. */
type Ends = readonly (readonly [number, number])[];
const WHOLE: Ends = [0, 1, 2].map(() => [0, 0] as const);

/**
 * Distances of a pressing plate from the ends of a face that clamps hold: held vertices cannot give way.
 *
 * Null where vertices elsewhere on the face are held, or nothing would be left.
 */
export function freeOfClamps({ axis, low, high, voxelSize }: Face, body: BodyEvent): Ends | null {
  const near = 1e-3 * voxelSize;
  const held = body.clamps
    .flatMap(({ points }) => points)
    .filter((point) =>
      [0, 1, 2].every((i) => point[i]! > low[i]! - near && point[i]! < high[i]! + near),
    );
  if (held.length === 0) return WHOLE;
  for (const i of [0, 1, 2].filter((one) => one !== axis)) {
    const sides = held.map((point) =>
      [low[i]!, high[i]!].findIndex((end) => Math.abs(point[i]! - end) < near),
    );
    const ends = [0, 1].map((side) => (sides.includes(side) ? voxelSize : 0)) as [number, number];
    if (!sides.includes(-1) && high[i]! - low[i]! - ends[0] - ends[1] > near)
      return WHOLE.map((none, k) => (k === i ? ends : none));
  }
  return null;
}

/** A box on a face, which moves and grows with the parameters that the face follows; null where it is oblique. */
export function plateOn(face: Face, design: Design, ends: Ends = WHOLE): Table | null {
  const { axis, seat, low, high, voxelSize: voxel, opposite } = face;
  if (axis === null || !seat) return null;
  const room = opposite === null ? Number.POSITIVE_INFINITY : FILLED * opposite;
  const thick = tidy(Math.min(THICK * voxel, room));
  const sign = face.normal[axis] > 0 ? 1 : -1;
  const level = levelText(face, axis, design);
  const size = [0, 1, 2].map((i) => {
    if (i === axis) return written(thick);
    const side = high[i]! - low[i]!;
    const text = coordinate(side, parametersAlong(i, design.parameters, design.source), voxel);
    const [below, above] = ends[i]!;
    if (below + above > 0) return beyond(text, side, -below - above);
    const wide = seat.free ? WIDER : 1;
    if (isFormula(text)) return wide === 1 ? text : `= ${wide}*${inner(text)}`;
    return written(wide * side);
  });
  const center = [0, 1, 2].map((i) => {
    if (i === axis) return beyond(level.text, level.level, (sign * thick) / 2);
    const own = parametersAlong(i, design.parameters, design.source);
    const middle = (low[i]! + high[i]!) / 2;
    const [below, above] = ends[i]!;
    return beyond(coordinate(middle, own, voxel), middle, (below - above) / 2);
  });
  return { kind: "box", size, center };
}

/** Name in contact of the body that a face is of. */
export function ownerOf(face: Face, body: BodyEvent): string {
  const vertex = face.triangles[0] ?? 0;
  const own = body.bodies.find(({ vertices: [a, b] }) => vertex >= a && vertex <= b);
  return own?.name ?? BODY;
}

interface Thing {
  readonly name: string;
  readonly room: Room;
}

/** Other things: objects, other bodies, the floor. */
function others(owner: string, body: BodyEvent, floor: number | null): Thing[] {
  const bodies = body.bodies
    .filter(({ name }) => name !== owner)
    .map(({ name, bounds: [low, high] }) => ({ name, room: { low, high } }));
  const objects = body.objects.map(({ name, vertices }) => ({
    name,
    room: boxOf(new Float32Array(bytesOf(vertices))),
  }));
  if (floor === null) return [...bodies, ...objects];
  const [low, high] = [
    [-Infinity, -Infinity, -Infinity],
    [Infinity, Infinity, floor],
  ] as [[number, number, number], [number, number, number]];
  return [...bodies, ...objects, { name: FLOOR, room: { low, high } }];
}

/** Least distance between the boxes of two things, m. */
export function apart(a: Room, b: Room): number {
  const gaps = [0, 1, 2].map((i) => Math.max(a.low[i]! - b.high[i]!, b.low[i]! - a.high[i]!, 0));
  return Math.hypot(...gaps);
}

/** The floor where it lies, m; null where there is none. */
function floorOf(source: Table, design: Table | null): number | null {
  const z = (design?.floor as { z?: unknown } | null | undefined)?.z;
  return source.floor !== undefined && typeof z === "number" ? z : null;
}

function plateOffer(
  id: string,
  words: Readonly<{ label: string; done: string }>,
  shape: Table,
  motion: unknown,
  source: Table,
): Offer & { readonly adds: string } {
  const objects = (source.objects as readonly Table[] | undefined) ?? [];
  const name = freeName(
    "plate",
    objects.map((one) => String(one.name)),
  );
  const value = { name, shape, motion };
  return { id, ...words, adds: name, changes: [{ path: ["objects", objects.length], value }] };
}

export interface Around extends Design {
  readonly face: Face;
  readonly body: BodyEvent;
  /** Values of the design, SI. */
  readonly design: Table | null;
}

/** An offer on a face that a clamp holds, which is none. */
const heldOffer = ({ id, label }: Offer): Offer => ({
  ...{ id, done: "", changes: [], disabled: true },
  label: `${label}: a clamp holds this face`,
});

/** Contacts possible at a face: something new that lies on it, and things already there. */
export function touchOffers(around: Around): Offer[] {
  const { face, body, source, design } = around;
  const { contact } = source;
  const rough: Change[] =
    contact === undefined ? [{ path: ["contact"], value: { friction: FIRST_FRICTION } }] : [];
  const offers: Offer[] = [];
  const plate = plateOn(face, around);
  const { axis, normal } = face;
  if (plate && axis !== null) {
    const words = { label: "a plate that stays", done: "A plate on this face" };
    const stays = plateOffer("plate", words, plate, "fixed", source);
    offers.push({ ...stays, changes: [...stays.changes, ...rough] });
    const [low, high] = body.bounds;
    const depth = tidy(PRESSED * (high[axis]! - low[axis]!));
    const way = writtenPlace(normal.map((x) => -depth * x) as [number, number, number]);
    const pressing = {
      label: `a plate pressed ${written(depth)} into it`,
      done: `A plate that goes ${written(depth)} into this face`,
    };
    const ends = freeOfClamps(face, body);
    const shape = (ends && plateOn(face, around, ends)) ?? plate;
    const moved = plateOffer("press", pressing, shape, { displacement: way }, source);
    const press = { ...moved, changes: [...moved.changes, ...rough] };
    offers.push(ends ? press : heldOffer(press));
  }
  const floor = floorOf(source, design);
  if (floor === null && isUnderneath(face, body)) {
    const { text } = levelText(face, 2, around);
    offers.push({
      ...{ id: "floor", label: "a floor", done: "A floor under this face" },
      changes: [{ path: ["floor"], value: { z: text } }, ...rough],
    });
  }
  const owner = ownerOf(face, body);
  for (const { name } of others(owner, body, floor))
    offers.push(meets(owner, name, contact, `thing-${name}`));
  const self = meets(owner, owner, contact, "itself");
  const alone = contact === undefined && body.objects.length + body.bodies.length === 0;
  offers.push(alone ? { ...self, ...TOUCHES_ITSELF, changes: rough, disabled: false } : self);
  return offers;
}

const TOUCHES_ITSELF = { label: "itself", done: "The body touches itself" } as const;

/** Check if nothing is lower than a face that looks down. */
function isUnderneath(face: Face, body: BodyEvent): boolean {
  if (face.axis !== 2 || face.normal[2] > 0) return false;
  const lowest = Math.min(
    body.bounds[0][2],
    ...body.objects.map(({ vertices }) => boxOf(new Float32Array(bytesOf(vertices))).low[2]),
  );
  return lowest > face.low[2] - 1e-3 * face.voxelSize;
}

/** That two things touch, where they did not or without friction of their own. */
function meets(owner: string, name: string, contact: unknown, id: string): Offer {
  const { kind, friction } = meetingOf(contact, owner, name);
  const who = name === owner ? "itself" : name;
  if (kind === "touching" && friction !== 0) {
    const label = `${who}: touches, friction ${String(friction).replace(/^=\s*/, "")}`;
    return { id, label, done: "", changes: [], disabled: true };
  }
  const before = { none: "passes through now", bonded: "bonded now", touching: "no friction now" };
  return {
    ...{ id, label: `${who} (${before[kind]})`, done: `${owner} touches ${who}` },
    changes: pairChanges(contact, [owner, name], { friction: FIRST_FRICTION }),
  };
}

/** Bonds possible at a face: a plate that lies on it, and things near enough. */
export function bondOffers(around: Around): Offer[] {
  const { face, body, source, design } = around;
  const { contact } = source;
  const owner = ownerOf(face, body);
  const offers: Offer[] = [];
  const plate = plateOn(face, around);
  if (plate) {
    const words = { label: "a plate that stays", done: "A plate bonded to this face" };
    const offer = plateOffer("plate", words, plate, "fixed", source);
    const pair = pairChanges(contact, [owner, offer.adds], { kind: "bonded" });
    offers.push({ ...offer, changes: [...offer.changes, ...pair] });
  }
  const reach = BOND_REACH * body.voxel_size;
  const own = roomOfFace(face);
  for (const { name, room } of others(owner, body, floorOf(source, design))) {
    const id = `thing-${name}`;
    const gap = apart(own, room);
    if (meetingOf(contact, owner, name).kind === "bonded")
      offers.push({ id, label: `${name}: bonded`, done: "", changes: [], disabled: true });
    else if (gap > reach * (1 + 1e-6))
      offers.push({
        ...{ id, done: "", changes: [], disabled: true },
        label: `${name}: ${written(gap)} away, needs ${written(reach)}`,
      });
    else
      offers.push({
        ...{ id, label: name, done: `${owner} and ${name} are bonded` },
        changes: pairChanges(contact, [owner, name], { kind: "bonded" }),
      });
  }
  return offers;
}

/** The box of a face, out to where its smooth surface is. */
function roomOfFace({ low, high, axis, seat }: Face): Room {
  const ends = (of: Triple, choose: (...x: number[]) => number) =>
    of.map((x, i) => (i === axis && seat ? choose(x, seat.level) : x)) as [number, number, number];
  return { low: ends(low, Math.min), high: ends(high, Math.max) };
}
