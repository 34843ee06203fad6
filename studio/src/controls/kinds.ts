// Kinds of quantity as the design's schema and the studies name them ("length", "modulus", ...).
import { KINDS as ALL } from "../protocol";
import { type Dimension, PLAIN } from "./dimension";
import { type Amounts, NO_PARAMETERS, writtenFormula } from "./formula";
import {
  factorOf,
  formatNumber,
  formatQuantity,
  isOneNumber,
  parseQuantity,
  spaced,
} from "./units";
import { unitOf } from "./unitTable";

const KINDS: Readonly<Record<string, (typeof ALL)[keyof typeof ALL]>> = ALL;

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

/** The dimension of a kind. */
export function dimensionOf(kind: string): Dimension {
  return unitOf(siUnit(kind))?.dimension ?? PLAIN;
}

/**
 * Read the typed text of a field of a design and give the value for the file: text with its
 * unit, a plain number where there is none, or a formula. Arithmetic of numbers is worked out;
 * text that names a parameter becomes a formula. Text unknown to this page, such as a rare unit,
 * goes on to VoxSoft.
 */
export function readWritten(
  typed: string,
  kind: string,
  words: readonly string[] = [],
  parameters: Amounts = NO_PARAMETERS,
): Written {
  const text = typed.trim().replaceAll("−", "-");
  if (words.includes(text)) return { value: text };
  const written = writtenFormula(text, dimensionOf(kind), parameters);
  if (written) return "formula" in written ? { value: written.formula } : written;
  const unit = writtenUnit(kind);
  if (unit !== "" && /^[+-]?inf(inity)?$/i.test(text)) return { value: text };
  const plain = text.replace(",", ".");
  const read = parseQuantity(text, unit || "1");
  if ("problem" in read) {
    if (!read.unsure) return read;
    return { value: isOneNumber(plain) ? plain : `= ${text}` };
  }
  const bare = Number(plain);
  if (unit === "" || read.value === 0 || !Number.isNaN(bare) || !isOneNumber(plain)) {
    return { value: writeValue(read.value, factorOf(unit), unit) };
  }
  return { value: spaced(plain) };
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
