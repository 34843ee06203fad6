// Objects to grip: the text of a new one, of another motion, and of its friction.
import { parseQuantity } from "../../../controls/units";
import type { BodyEvent, Triple } from "../../../protocol";
import type { Change } from "../edits";
import { pairsOf as allPairs, pairChanges } from "./pairs";
import { type Surroundings, sideFor, spotFor, wayInto, written, writtenPlace } from "./placing";

export type Table = Readonly<Record<string, unknown>>;
export type Motion = "fixed" | "moved" | "free";
export const PRIMITIVES = ["sphere", "box", "cylinder"] as const;
export type Primitive = (typeof PRIMITIVES)[number];

/** The shape of a new object beside the body. */
export function newShape(kind: Primitive, around: Surroundings | null): Table {
  const side = sideFor(around);
  const [x, y, z] = spotFor([side, side, side], around);
  switch (kind) {
    case "sphere":
      return { kind, radius: written(side / 2), center: writtenPlace([x, y, z]) };
    case "box":
      return {
        kind,
        size: [written(side), written(side), written(side)],
        center: writtenPlace([x, y, z]),
      };
    case "cylinder":
      return {
        ...{ kind, radius: written(side / 2), height: written(side) },
        base: writtenPlace([x, y, z - side / 2]),
      };
  }
}

/** A mesh from a file, of a box from `low` to `high`, m, moved beside the body. */
export function meshShape(
  shape: Table,
  low: Triple,
  high: Triple,
  around: Surroundings | null,
): Table {
  const size = low.map((x, axis) => (high[axis] as number) - x) as Triple;
  const spot = spotFor(size, around);
  const by = spot.map((x, axis) => x - 0.5 * ((low[axis] as number) + (high[axis] as number)));
  return { kind: "translate", of: shape, by: writtenPlace(by as Triple) };
}

/** Lengths of a shape that is sized end at a tenth of a millimeter, m. */
const SNAP = 1e-4;

/**
 * A sphere, box or cylinder some times as large about its middle; null where it is none of these, or a length is
 * a formula, which sets the size.
 */
export function resized(shape: unknown, factor: number): Table | null {
  if (typeof shape !== "object" || shape === null) return null;
  const table = shape as Table;
  const meters = (value: unknown): number => {
    const read = String(value).trim().startsWith("=") ? null : parseQuantity(String(value), "m");
    return read && "value" in read ? read.value : Number.NaN;
  };
  const larger = (value: unknown) =>
    Math.max(Math.round((meters(value) * factor) / SNAP), 1) * SNAP;
  const isNumber = (...lengths: unknown[]) => lengths.every((one) => Number.isFinite(meters(one)));
  switch (table.kind) {
    case "sphere":
      return isNumber(table.radius) ? { ...table, radius: written(larger(table.radius)) } : null;
    case "box": {
      const { size, center } = table;
      // One that is placed by its corner would grow to one side.
      if (!Array.isArray(size) || !isNumber(...size) || center === undefined) return null;
      return { ...table, size: size.map((side) => written(larger(side))) };
    }
    case "cylinder": {
      const { radius, height, base, axis } = table;
      if (!isNumber(radius, height) || !Array.isArray(base) || (axis ?? "z") !== "z") return null;
      if (!isNumber(base[2])) return null;
      const high = larger(height);
      const low = meters(base[2]) - (high - meters(height)) / 2;
      const [z] = writtenPlace([low, 0, 0]);
      return {
        ...table,
        ...{ radius: written(larger(radius)), height: written(high), base: [base[0], base[1], z] },
      };
    }
    default:
      return null;
  }
}

/** Motion of an object as it is written. */
export function motionOf(object: Table): Motion {
  if (object.motion === "free") return "free";
  return typeof object.motion === "object" && object.motion !== null ? "moved" : "fixed";
}

/** Replace the motion of an object, and its mass, which it then needs or not. */
export function withMotion(object: Table, motion: Motion, body: BodyEvent | null): Table {
  const { mass, density, motion: _, ...rest } = object;
  switch (motion) {
    case "fixed":
      return { ...rest, motion };
    case "moved": {
      const way = wayInto(String(object.name), body);
      return { ...rest, motion: { displacement: writtenPlace(way) } };
    }
    case "free":
      if (mass !== undefined) return { ...rest, motion, mass };
      return density !== undefined
        ? { ...rest, motion, density }
        : { ...rest, motion, mass: "50 g" };
  }
}

interface Pair {
  readonly of: readonly string[];
  readonly friction?: number;
}

const pairsOf = (contact: unknown) => allPairs(contact) as unknown as readonly Pair[];

const isPair = (pair: Pair, name: string, body: string) =>
  pair.of.length === 2 && pair.of.includes(name) && pair.of.includes(body);

/** The friction of an object with the bodies: that of a pair, or of all. */
export function frictionOf(contact: unknown, name: string, bodies: readonly string[]): unknown {
  const own = pairsOf(contact).findLast((pair) =>
    bodies.some((body) => isPair(pair, name, body)),
  )?.friction;
  return own ?? (contact as { friction?: unknown } | undefined)?.friction ?? 0;
}

/** The changes that give an object another friction with the bodies: a number, or a formula. */
export function frictionEdit(
  contact: unknown,
  name: string,
  objects: number,
  friction: number | string,
  bodies: readonly string[],
): Change[] {
  const pairs = pairsOf(contact);
  const of = bodies.map((body) => pairs.findLastIndex((pair) => isPair(pair, name, body)));
  const [own, ...others] = of.filter((at) => at >= 0);
  if (own !== undefined && others.length === 0 && bodies.length === 1)
    return [{ path: ["contact", "pairs", own, "friction"], value: friction }];
  // All that touches has it while there is one object; of several each has its own.
  if (objects < 2 && own === undefined) {
    const path = contact === undefined ? ["contact"] : ["contact", "friction"];
    return [{ path, value: contact === undefined ? { friction } : friction }];
  }
  if (bodies.length > 1) {
    // Copies with each of them, one pair each.
    const changed = pairs.map((pair, at) => (of.includes(at) ? { ...pair, friction } : pair));
    const missing = bodies.filter((_, i) => (of[i] ?? -1) < 0);
    const value = [...changed, ...missing.map((body) => ({ of: [body, name], friction }))];
    return contact === undefined
      ? [{ path: ["contact"], value: { pairs: value } }]
      : [{ path: ["contact", "pairs"], value }];
  }
  return pairChanges(contact, [bodies[0] as string, name], { friction });
}
