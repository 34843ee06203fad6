// Values of a design that can change along a path, and the range of a path as text.

import { cavityName } from "../../controls/cavities";
import { siUnit, writtenUnit } from "../../controls/kinds";
import { factorOf } from "../../controls/units";
import type { Parameter } from "../../protocol";

/** A value of the design that a path may change. */
export interface Changeable {
  /** Key in the design file. */
  readonly key: string;
  readonly label: string;
  readonly kind: string;
  /** In SI units. */
  readonly value: number;
  /** Default start of a path, in SI units. */
  readonly start: number;
}

const LOADS: Readonly<Record<string, readonly [label: string, kind: string]>> = {
  gravity: ["gravity", "acceleration"],
  pressure: ["pressure", "pressure"],
  force: ["force", "force"],
  traction: ["traction", "pressure"],
  magnetic_field: ["magnetic field", "magnetic field"],
};

const ACTIVATIONS: Readonly<Record<string, string>> = {
  strain: "number",
  swelling: "number",
  thermal: "temperature",
  "shape-memory": "temperature",
  dielectric: "electric field",
};

const DRIVES = ["tension", "shortening", "length"] as const;

type Table = Readonly<Record<string, unknown>>;

/** Key of a path over time, along which histories are followed and rubber relaxes. */
export const TIME = "time";
/** Relaxation times after which less than a hundredth of a branch is left. */
const RELAXED = 5;

function tables(value: unknown): readonly Table[] {
  return Array.isArray(value) ? (value as Table[]) : [];
}

/** A number, or the components of a vector that are not zero (all of them where all are). */
function numbers(value: unknown, key: string, label: string, kind: string): Changeable[] {
  if (typeof value === "number") return [{ key, label, kind, value, start: 0 }];
  if (!Array.isArray(value)) return [];
  const some = value.some((x) => x !== 0);
  return value.flatMap((x, axis) =>
    typeof x === "number" && (x !== 0 || !some)
      ? [
          {
            key: `${key}[${axis}]`,
            label: `${label} along ${"xyz"[axis]}`,
            kind,
            value: x,
            start: 0,
          },
        ]
      : [],
  );
}

/** All tables of a design, at any depth. */
function everyTable(value: unknown): readonly Table[] {
  if (Array.isArray(value)) return value.flatMap(everyTable);
  if (typeof value !== "object" || value === null) return [];
  return [value as Table, ...Object.values(value).flatMap(everyTable)];
}

/** Relaxation times in s of the rubber of a design. */
export function relaxationTimes(design: Table): readonly number[] {
  const branches = everyTable(design).flatMap((table) => tables(table.prony));
  return branches.flatMap(({ tau }) => (typeof tau === "number" ? [tau] : []));
}

/** End in s of the histories and of the relaxation of a design; null where it has neither. */
function endOfTime(design: Table): number | null {
  const histories = everyTable(design).flatMap((table) => {
    const time = (table.history as Table | null | undefined)?.time;
    return Array.isArray(time) ? time.filter((one) => typeof one === "number") : [];
  });
  const ends = [...histories, ...relaxationTimes(design).map((tau) => RELAXED * tau)];
  const end = Math.max(0, ...ends);
  return end > 0 ? end : null;
}

/** Stiffness along a path over a value, of a design whose rubber relaxes; null for any other design. */
export function stiffnessNote(design: Table, key: string): string | null {
  if (relaxationTimes(design).length === 0) return null;
  if (key !== TIME) return "Rubber has its long-term stiffness here: follow time to see it relax.";
  return (
    "A load without a history acts suddenly at time zero, on the instantaneous stiffness; " +
    "later the rubber relaxes toward the long-term one."
  );
}

/** A load in words, with the chamber that it is in. */
function labelOfLoad(load: Table): string {
  const [label] = LOADS[String(load.kind)] ?? ["load"];
  if (load.cavity === undefined || load.cavity === null || load.cavity === "all") return label;
  const named = typeof load.cavity === "string" && !/^\d+$/.test(load.cavity);
  return `${label} in ${named ? load.cavity : cavityName({ name: "" }, Number(load.cavity))}`;
}

/** Values that a path may change: loads, tendons, activations, moved clamps, time, and parameters of them. */
export function changeable(design: Table, parameters: readonly Parameter[]): Changeable[] {
  const found: Changeable[] = [];
  const loads = tables(design.loads);
  const labels = loads.map(labelOfLoad);
  loads.forEach((load, i) => {
    const [, kind] = LOADS[String(load.kind)] ?? ["load", "number"];
    const alike = labels.filter((one) => one === labels[i]).length > 1;
    const label = alike ? `${labels[i]} (load ${i + 1})` : `${labels[i]}`;
    found.push(...numbers(load.value, `loads[${i}].value`, label, kind));
  });
  tables(design.tendons).forEach((tendon, i) => {
    for (const drive of DRIVES) {
      const kind = drive === "tension" ? "force" : "length";
      const label = `${drive} of ${String(tendon.name)}`;
      found.push(...numbers(tendon[drive], `tendons[${i}].${drive}`, label, kind));
    }
  });
  tables(design.activations).forEach((each, i) => {
    const kind = ACTIVATIONS[String(each.kind)] ?? "number";
    const label = `${String(each.kind)} of ${String(each.part)}`;
    const start = typeof each.reference === "number" ? each.reference : 0;
    found.push(
      ...numbers(each.value, `activations[${i}].value`, label, kind).map((one) => ({
        ...one,
        start,
      })),
    );
  });
  tables(design.clamps).forEach((clamp, i) => {
    const way = (clamp.motion as Table | null | undefined)?.displacement;
    const key = `clamps[${i}].motion.displacement`;
    found.push(...numbers(way, key, `motion of clamp ${i + 1}`, "length"));
  });
  const end = endOfTime(design);
  if (end !== null) {
    found.push({ key: TIME, label: "time", kind: "time", value: end, start: 0 });
  }
  for (const one of parameters) {
    if (one.formula) continue;
    const { name, kind, value } = one;
    found.push({ key: name, label: `parameter ${name}`, kind, value, start: one.min ?? 0 });
  }
  return found;
}

/** The range of a path as the design language has it, such as `loads[0].value=0..30 kPa/16`. */
export function overText(what: Changeable, from: number, to: number, count: number): string {
  const unit = writtenUnit(what.kind);
  const factor = unit === "" ? 1 : factorOf(unit);
  const say = (si: number) => String(Number((si / factor).toPrecision(10)));
  return `${what.key}=${say(from)}..${say(to)}${unit === "" ? "" : ` ${unit}`}/${count}`;
}

/** The SI unit of a value. */
export function unitOfValue(what: Changeable): string {
  return siUnit(what.kind);
}
