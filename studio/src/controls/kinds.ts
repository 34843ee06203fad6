// Kinds of quantity as the design's schema and the studies name them ("length", "modulus", ...).
import { formatNumber, formatQuantity, parseQuantity } from "./units";

interface Kind {
  /** The SI unit. */
  readonly si: string;
  /** What a bare number counts in, spelled as design files spell it. */
  readonly written: string;
}

const KINDS: Readonly<Record<string, Kind>> = {
  length: { si: "m", written: "mm" },
  area: { si: "m^2", written: "mm^2" },
  volume: { si: "m^3", written: "mL" },
  pressure: { si: "Pa", written: "kPa" },
  modulus: { si: "Pa", written: "kPa" },
  density: { si: "kg/m^3", written: "kg/m^3" },
  mass: { si: "kg", written: "g" },
  force: { si: "N", written: "N" },
  acceleration: { si: "m/s^2", written: "m/s^2" },
  time: { si: "s", written: "s" },
  rate: { si: "1/s", written: "1/s" },
  speed: { si: "m/s", written: "m/s" },
  angle: { si: "rad", written: "deg" },
  stiffness: { si: "N/m", written: "N/m" },
  compliance: { si: "m/N", written: "m/N" },
  "volume compliance": { si: "m^3/Pa", written: "m^3/Pa" },
  energy: { si: "J", written: "J" },
  number: { si: "1", written: "" },
};

/** The SI unit of a kind; kinds that are not known here count as plain numbers. */
export function siUnit(kind: string): string {
  return KINDS[kind]?.si ?? "1";
}

/** The unit that a bare number of a kind is completed with in a design file. */
export function writtenUnit(kind: string): string {
  return KINDS[kind]?.written ?? "";
}

/** An SI value with the unit that people read, by its kind. */
export function formatKind(value: number | null | undefined, kind: string, digits = 4): string {
  if (value == null || Number.isNaN(value)) return "–";
  return formatQuantity(value, siUnit(kind), digits);
}

export type Written = { readonly value: string | number } | { readonly problem: string };

/**
 * Read what was typed into a field of a design and give what belongs in the file: text with its
 * unit, a plain number where there is none, or a formula as it is.
 *
 * Units that this page does not know go on to VoxSoft, which knows more of them.
 */
export function readWritten(typed: string, kind: string, words: readonly string[] = []): Written {
  const text = typed.trim().replaceAll("−", "-");
  if (text.startsWith("=")) {
    return text.slice(1).trim() === ""
      ? { problem: "a formula is due after the =" }
      : { value: `= ${text.slice(1).trim()}` };
  }
  if (words.includes(text)) return { value: text };
  const unit = writtenUnit(kind);
  if (unit === "") {
    const number = Number(text.replace(",", "."));
    if (text !== "" && !Number.isNaN(number)) return { value: number };
    return { problem: `“${text}” is no number; a formula begins with =` };
  }
  if (/^[+-]?inf(inity)?$/i.test(text)) return { value: text };
  const read = parseQuantity(text, unit);
  if ("problem" in read) {
    return read.problem.startsWith("unknown unit") ? { value: text } : read;
  }
  if (read.value === 0) return { value: 0 };
  const bare = Number(text.replace(",", "."));
  return { value: Number.isNaN(bare) ? text.replace(",", ".") : `${bare} ${unit}` };
}

/** A number for a design file in a given unit, without the noise of binary fractions. */
export function writeValue(si: number, factor: number, unit: string): string | number {
  const number = Number((si / factor).toPrecision(12));
  if (unit === "") return number;
  return number === 0 ? 0 : `${number} ${unit}`;
}

/** A value of a design as text, such as `[0, 0, 5 mm]`. */
export function describeValue(value: unknown): string {
  if (value === null || value === undefined) return "–";
  if (typeof value === "number") return formatNumber(value, 5);
  if (Array.isArray(value)) return `[${value.map(describeValue).join(", ")}]`;
  if (typeof value === "object") {
    const entries = Object.entries(value).map(([key, inner]) => `${key}: ${describeValue(inner)}`);
    return entries.join(", ");
  }
  return String(value);
}
