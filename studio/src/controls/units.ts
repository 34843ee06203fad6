// Numbers with units, as a user types and reads them. Values are SI everywhere else.

interface Unit {
  readonly quantity: string;
  readonly factor: number;
}

const UNITS: Readonly<Record<string, Unit>> = {
  m: { quantity: "length", factor: 1 },
  cm: { quantity: "length", factor: 1e-2 },
  mm: { quantity: "length", factor: 1e-3 },
  um: { quantity: "length", factor: 1e-6 },
  in: { quantity: "length", factor: 0.0254 },
  Pa: { quantity: "pressure", factor: 1 },
  kPa: { quantity: "pressure", factor: 1e3 },
  MPa: { quantity: "pressure", factor: 1e6 },
  bar: { quantity: "pressure", factor: 1e5 },
  mbar: { quantity: "pressure", factor: 100 },
  psi: { quantity: "pressure", factor: 6894.757293168361 },
  N: { quantity: "force", factor: 1 },
  mN: { quantity: "force", factor: 1e-3 },
  kN: { quantity: "force", factor: 1e3 },
  kg: { quantity: "mass", factor: 1 },
  g: { quantity: "mass", factor: 1e-3 },
  mg: { quantity: "mass", factor: 1e-6 },
  "kg/m^3": { quantity: "density", factor: 1 },
  "g/cm^3": { quantity: "density", factor: 1e3 },
  s: { quantity: "time", factor: 1 },
  ms: { quantity: "time", factor: 1e-3 },
  min: { quantity: "time", factor: 60 },
  h: { quantity: "time", factor: 3600 },
  rad: { quantity: "angle", factor: 1 },
  deg: { quantity: "angle", factor: Math.PI / 180 },
  "°": { quantity: "angle", factor: Math.PI / 180 },
  "m^2": { quantity: "area", factor: 1 },
  "cm^2": { quantity: "area", factor: 1e-4 },
  "mm^2": { quantity: "area", factor: 1e-6 },
  "m^3": { quantity: "volume", factor: 1 },
  l: { quantity: "volume", factor: 1e-3 },
  ml: { quantity: "volume", factor: 1e-6 },
  "cm^3": { quantity: "volume", factor: 1e-6 },
  "mm^3": { quantity: "volume", factor: 1e-9 },
  "N/m": { quantity: "stiffness", factor: 1 },
  "N/mm": { quantity: "stiffness", factor: 1e3 },
  J: { quantity: "energy", factor: 1 },
  mJ: { quantity: "energy", factor: 1e-3 },
  uJ: { quantity: "energy", factor: 1e-6 },
  "J/m^3": { quantity: "energy density", factor: 1 },
  "kJ/m^3": { quantity: "energy density", factor: 1e3 },
  "m/s": { quantity: "speed", factor: 1 },
  "mm/s": { quantity: "speed", factor: 1e-3 },
  "m/s^2": { quantity: "acceleration", factor: 1 },
  "1/s": { quantity: "rate", factor: 1 },
  Hz: { quantity: "rate", factor: 1 },
  "1": { quantity: "number", factor: 1 },
  "%": { quantity: "number", factor: 1e-2 },
};

// What soft-robotics people read: millimeters, kilopascals.
const SHOWN: Readonly<Record<string, string>> = {
  m: "mm",
  Pa: "kPa",
  "m^2": "cm^2",
  "m^3": "ml",
  rad: "deg",
  kg: "g",
  "m/s": "mm/s",
  "J/m^3": "kJ/m^3",
  J: "mJ",
};

const SPELLINGS: Readonly<Record<string, string>> = {
  "": "1",
  "-": "1",
  µm: "um",
  μm: "um",
  mL: "ml",
  L: "l",
  degree: "deg",
  degrees: "deg",
  sec: "s",
};

const PATTERN = /^([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*(.*)$/i;

function canonical(text: string): string {
  const plain = text.trim().replaceAll("**", "^").replaceAll("²", "^2").replaceAll("³", "^3");
  return SPELLINGS[plain] ?? plain;
}

/** The unit in which a quantity given in an SI unit is shown by default. */
export function shownUnit(si: string): string {
  const unit = canonical(si);
  return SHOWN[unit] ?? unit;
}

/** How many SI units one `unit` is; an unknown unit counts as itself. */
export function factorOf(unit: string): number {
  return UNITS[canonical(unit)]?.factor ?? 1;
}

export type Parsed = { readonly value: number } | { readonly problem: string };

/**
 * Read "5 mm", "0.5 cm", "1e3" or, with a unit `m` and `mm` shown, a bare "5".
 * A bare number counts in the unit that the field shows. Gives an SI value, or what is wrong.
 */
export function parseQuantity(text: string, shown: string): Parsed {
  if (/\d,\d{3}(?!\d)/.test(text)) {
    return { problem: "a comma before three digits can mean two things: leave it out" };
  }
  const match = PATTERN.exec(text.trim().replace(",", "."));
  if (!match) return { problem: `“${text.trim()}” is no number` };
  const value = Number(match[1]);
  const typed = canonical(match[2] ?? "");
  const own = canonical(shown);
  if ((match[2] ?? "").trim() === "") return finite(value * factorOf(own), text);
  const unit = UNITS[typed];
  if (!unit) return { problem: `unknown unit “${match[2]?.trim()}”` };
  const expected = UNITS[own];
  if (expected && expected.quantity !== unit.quantity) {
    return { problem: `${typed} is a ${unit.quantity}; a ${expected.quantity} is due` };
  }
  return finite(value * unit.factor, text);
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

/** An SI value as text with the unit that people read, such as `20 mm`. */
export function formatQuantity(value: number, si: string, digits = 4): string {
  const unit = shownUnit(si);
  const number = formatNumber(value / factorOf(unit), digits);
  return unit === "1" ? number : `${number} ${unitText(unit)}`;
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
