// First values of entries that the schema alone cannot give, as they depend on the meshed body; and why
// some cannot be added to it.
import { writeValue } from "../../../controls/kinds";
import type { BodyEvent } from "../../../protocol";

type Table = Readonly<Record<string, unknown>>;
type Chambered = Pick<BodyEvent, "cavities"> | null;

/** A bound leaves so much room over the mass of the body. */
const ROOM = 1.5;
/** Mass of a body that is not meshed yet, kg. */
const USUAL_MASS = 0.1;

/** Why no entry of a section can be added, in a sentence; null where one can. */
export function obstacleTo(section: string, body: Chambered): string | null {
  const count = body?.cavities.length ?? 0;
  const has = count === 0 ? "none" : "one";
  if (section === "connections" && count < 2) return `It joins two chambers; this body has ${has}.`;
  if (section === "supplies" && count === 0) return "It drives a chamber; this body has none.";
  return null;
}

/** A new entry that fits the body. */
export function fitted(section: string, value: Table, body: Chambered): Table {
  if (section !== "connections") return value;
  const names = (body?.cavities ?? []).map((cavity, i) => cavity.name || i);
  return { ...value, chambers: names.slice(0, 2) };
}

/** A first constraint, which the body as it is keeps. */
export function firstConstraint(body: Pick<BodyEvent, "mass"> | null): Table {
  const most = ROOM * (body?.mass || USUAL_MASS);
  // One digit is enough for a number that is to be replaced.
  return { metric: "mass", max: writeValue(Number(most.toPrecision(1)), 1e-3, "g") };
}

export const FIRST_OBJECTIVE: Table = { minimize: "mass" };
