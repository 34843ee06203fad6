// Numbers with units, as a user types and reads them. Values are SI everywhere else.
import { describeDimension, PLAIN, sameDimension } from "./dimension";
import { type Evaluated, evaluate, type Problem } from "./formula";
import { canonical, unitOf } from "./unitTable";

// Units that soft-robotics people read: millimeters, kilopascals.
const SHOWN: Readonly<Record<string, string>> = {
  m: "mm",
  Pa: "kPa",
  "m^2": "cm^2",
  "m^3": "mL",
  rad: "deg",
  kg: "g",
  "m/s": "mm/s",
  "J/m^3": "kJ/m^3",
  J: "mJ",
  T: "mT",
};

const QUANTITY = /^([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*(.*)$/i;

/** The unit in which a quantity given in an SI unit is shown by default. */
export function shownUnit(si: string): string {
  const unit = canonical(si);
  return SHOWN[unit] ?? unit;
}

/** Size of one `unit` in SI units; an unknown unit counts as itself. */
export function factorOf(unit: string): number {
  return unitOf(unit)?.factor ?? 1;
}

export type Parsed = { readonly value: number } | Problem;

/**
 * Read "5 mm", "0.5 cm", "2*5 mm + 1 cm" or, with a unit `m` and `mm` shown, a bare "5" or "2*5".
 * A number without any unit counts in the unit that the field shows. Gives an SI value, or the error.
 */
export function parseQuantity(text: string, shown: string): Parsed {
  const typed = text.trim().replaceAll("−", "-");
  if (/\d,\d{3}(?!\d)/.test(typed) && !typed.includes("(")) {
    return { problem: "a comma before three digits can mean two things: leave it out" };
  }
  if (!/\d/.test(typed)) return { problem: `“${typed}” is no number` };
  const read = amountOf(typed.includes("(") ? typed : typed.replaceAll(",", "."));
  if ("problem" in read) return read;
  const own = unitOf(shown) ?? { factor: 1, dimension: PLAIN };
  if (!/[A-Za-zµμ°%]/.test(typed.replace(EXPONENTS_AND_CALLS, ""))) {
    return finite(read.value * own.factor, typed);
  }
  const zero = read.value === 0 && sameDimension(read.dimension, PLAIN);
  if (!zero && !sameDimension(read.dimension, own.dimension)) {
    const [came, due] = [read.dimension, own.dimension].map(describeDimension);
    return { problem: `“${typed}” is ${came}; expected ${due}` };
  }
  return read;
}

/** A number and its unit with one space between them, such as `20 mm` for 20mm. */
export function spaced(text: string): string {
  const [, number, unit] = QUANTITY.exec(text) ?? [];
  return number && unit ? `${number} ${unit}` : text;
}

/** Check if a text is one number with its unit, known or not, so that nothing is to be worked out. */
export function isOneNumber(text: string): boolean {
  const unit = QUANTITY.exec(text)?.[2];
  return (
    unit !== undefined && (unitOf(unit) !== null || /^(?!.*\/\s*[\d.])[^-+*()\s]+$/.test(unit))
  );
}

/** Calls of functions, and the letter inside of 1e3: letters that are neither unit nor parameter. */
const EXPONENTS_AND_CALLS = /(?:min|max)(?=\s*\()|(?<=[\d.])e(?=[+-]?\d)/gi;

/** A number with one unit, or the result of a formula. */
function amountOf(typed: string): Evaluated {
  const [, number, written = ""] = QUANTITY.exec(typed) ?? [];
  const unit = number === undefined ? null : unitOf(written);
  if (unit === null) return evaluate(typed);
  const read = finite(Number((Number(number) * unit.factor).toPrecision(16)), typed);
  return "problem" in read ? read : { ...read, dimension: unit.dimension };
}

function finite(value: number, text: string): Parsed {
  return Number.isFinite(value) ? { value } : { problem: `“${text}” is out of range` };
}

/** A number with as many digits as are worth reading. */
export function formatNumber(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text =
    size >= 1e6 || size < 1e-4
      ? value.toExponential(Math.max(digits - 2, 1)).replace(/\.?0+e/, "e")
      : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−").replace("e+", "e");
}

// Rounding error of zero, by SI unit: negligible beside bodies of millimeters and grams. Places
// are rounded to 1e-16 of a body's size, strains in voxels of a hundredth of it to 1e-14, and stress to that
// part of a bulk modulus, of rubber 100 MPa at most: 1e-6 Pa, a strain of 1e-11 where Young's modulus is
// 100 kPa. Energy densities are rounded to 1e-16 of a modulus, of 10 MPa at most.
const NOTHING: Readonly<Record<string, number>> = {
  m: 1e-12,
  N: 1e-9,
  J: 1e-15,
  Pa: 1e-6,
  "J/m^3": 1e-9,
  "m/s": 1e-12,
};

/** A value that was computed, with zero where only rounding is left of it. */
export function cleaned(value: number, si: string): number {
  return Math.abs(value) < (NOTHING[si] ?? 0) ? 0 : value;
}

/** An SI value as text with the unit that people read, such as `20 mm`. */
export function formatQuantity(value: number, si: string, digits = 4): string {
  const unit = shownUnit(si);
  const number = formatNumber(value / factorOf(unit), digits);
  return unit === "1" ? number : `${number} ${unitText(unit)}`;
}

/** An energy in millijoule, or in microjoule where that would be all zeros; dust of rounding is 0. */
export function formatEnergy(joule: number): string {
  const size = Math.abs(joule);
  if (size < 1e-10) return "0 mJ";
  return size < 1e-5 ? `${formatNumber(joule * 1e6, 3)} µJ` : formatQuantity(joule, "J", 3);
}

/** A unit as set in type: superscripts, the micro sign, the degree sign. */
export function unitText(unit: string): string {
  const plain = canonical(unit);
  if (plain === "1") return "";
  if (plain === "deg") return "°";
  return plain
    .replace("^2", "²")
    .replace("^3", "³")
    .replace(/^u(?=[mJ])/, "µ");
}

/** A span of time in words that stay short: `0.4 s`, `2:04`, `1:02:10`. */
export function formatSpan(seconds: number): string {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 60) return `${formatNumber(seconds, 2)} s`;
  const whole = Math.round(seconds);
  const h = Math.floor(whole / 3600);
  const m = Math.floor((whole % 3600) / 60);
  const s = String(whole % 60).padStart(2, "0");
  return h > 0 ? `${h}:${String(m).padStart(2, "0")}:${s}` : `${m}:${s}`;
}
