// The units that this page reads. VoxSoft knows more; unknown ones are left to it.
import { COMMON_UNITS as COMMON_TABLE } from "../protocol";
import { type Dimension, PLAIN, timesDimension } from "./dimension";

export interface Unit {
  /** Its size in SI units. */
  readonly factor: number;
  readonly dimension: Dimension;
}

const LENGTH: Dimension = [1, 0, 0, 0, 0, 0];
const VOLUME: Dimension = [3, 0, 0, 0, 0, 0];
const TIME: Dimension = [0, 0, 1, 0, 0, 0];
const PRESSURE: Dimension = [-1, 1, -2, 0, 0, 0];
const ENERGY: Dimension = [2, 1, -2, 0, 0, 0];

type Rows = Readonly<Record<string, readonly [number, Dimension]>>;

/** Units of daily use; inside a formula only these may follow the / or * of another unit. */
const COMMON: Rows = COMMON_TABLE;

const OTHERS: Rows = {
  in: [0.0254, LENGTH],
  mbar: [100, PRESSURE],
  min: [60, TIME],
  h: [3600, TIME],
  l: [1e-3, VOLUME],
  ml: [1e-6, VOLUME],
  uJ: [1e-6, ENERGY],
  kJ: [1e3, ENERGY],
  "1": [1, PLAIN],
  "%": [1e-2, PLAIN],
};

const SPELLINGS: Readonly<Record<string, string>> = {
  "": "1",
  "-": "1",
  "°": "deg",
  degree: "deg",
  degrees: "deg",
  sec: "s",
};

export const COMMON_UNITS: readonly string[] = Object.keys(COMMON);

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** Exponents as they are typed: m² and m**2 are m^2. */
export function plainExponents(text: string): string {
  return text.replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+/g, (raised) => {
    const digits = [...raised].map((one) => (one === "⁻" ? "-" : SUPERSCRIPTS.indexOf(one)));
    return `^${digits.join("")}`;
  });
}

/** One spelling of each unit: `kg/m^3`, `um`, `deg`. */
export function canonical(text: string): string {
  const plain = plainExponents(text.trim().replaceAll("**", "^")).replace(/[µμ]/g, "u");
  return SPELLINGS[plain] ?? plain;
}

const POWER = /^([A-Za-z°%]+|1)(?:\^?(-?[1-9]))?$/;

function readUnit(text: string): Unit | null {
  let factor = 1;
  let dimension = PLAIN;
  let divide = false;
  for (const part of canonical(text).split(/\s*([*/])\s*/)) {
    if (part === "*" || part === "/") {
      divide = part === "/";
      continue;
    }
    const [, name = "", exponent] = POWER.exec(part) ?? [];
    const row = COMMON[canonical(name)] ?? OTHERS[canonical(name)];
    if (!name || !row) return null;
    const power = Number(exponent ?? 1) * (divide ? -1 : 1);
    factor *= row[0] ** power;
    dimension = timesDimension(dimension, row[1], power);
  }
  // Powers of ten leave their last bit in binary fractions.
  return { factor: Number(factor.toPrecision(16)), dimension };
}

const known = new Map<string, Unit | null>();

/** Value of a unit such as `g/cm^3`, or null if this page does not know it. */
export function unitOf(text: string): Unit | null {
  let unit = known.get(text);
  if (unit === undefined) {
    unit = readUnit(text);
    if (known.size > 1000) known.clear();
    known.set(text, unit);
  }
  return unit;
}
