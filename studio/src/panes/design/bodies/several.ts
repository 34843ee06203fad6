// Bodies of a design: which belong to an entry of the form, and where copies and new ones go.
import { bytesOf } from "../../../engine/base64";
import type { BodyEvent, Triple } from "../../../protocol";
import { boxOf, type Room } from "./placing";

/** Name in contact of the body of a design that has no others. */
export const BODY = "body";

/** Check if a body is that of an entry, or one of those of its design. */
export const isOf = (name: string, entry: string | null): boolean =>
  entry !== null && (name === entry || name.startsWith(`${entry}.`));

/** The entry of the form that a body belongs to. */
export function entryOf(name: string, entries: readonly string[]): string | null {
  return entries.find((entry) => isOf(name, entry)) ?? null;
}

/** Names of the bodies of a document, as contact calls them. */
export function bodyNames(source: Readonly<Record<string, unknown>>): string[] {
  const bodies = Array.isArray(source.bodies) ? (source.bodies as { name?: unknown }[]) : [];
  return bodies.length > 0 ? bodies.map((body) => String(body.name ?? "")) : [BODY];
}

function union(rooms: readonly Room[]): Room | null {
  if (rooms.length === 0) return null;
  const low = [0, 1, 2].map((axis) => Math.min(...rooms.map((room) => room.low[axis] as number)));
  const high = [0, 1, 2].map((axis) => Math.max(...rooms.map((room) => room.high[axis] as number)));
  return { low: low as Triple, high: high as Triple };
}

/** The box of a body or object of the form; null where it is not drawn. */
export function roomOf(name: string, body: BodyEvent): Room | null {
  const [low, high] = body.bounds;
  if (name === BODY && body.bodies.length === 0) return { low, high };
  const object = body.objects.find((one) => one.name === name);
  if (object) return boxOf(new Float32Array(bytesOf(object.vertices)));
  return union(
    body.bodies
      .filter((one) => isOf(one.name, name))
      .map(({ bounds }) => ({ low: bounds[0], high: bounds[1] })),
  );
}

/** End along x of all bodies, with a voxel of room, m. */
export function beyondOf(body: BodyEvent | null): number {
  if (!body) return 0;
  const objects = body.objects.map((object) => roomOf(object.name, body));
  const edges = [body.bounds[1][0], ...objects.map((room) => room?.high[0] ?? -Infinity)];
  return tidy(Math.max(...edges) + body.voxel_size);
}

/** The way to a copy beside all that there is, m. */
export function besideOf(name: string, body: BodyEvent | null): Triple {
  const room = body && roomOf(name, body);
  if (!body || !room) return [0.01, 0, 0];
  return [tidy(beyondOf(body) - room.low[0]), 0, 0];
}

/** Up to the next tenth of a millimeter: a length that one can read. */
const tidy = (length: number) => Number((Math.ceil(1e4 * length - 1e-6) / 1e4).toFixed(4));
