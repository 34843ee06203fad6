// A number of the form made a parameter: named after its place, with bounds around it.
import type { Change, Path } from "../edits";
import { freeName } from "../fields/starters";

type Table = Readonly<Record<string, unknown>>;

/** Bounds of a new parameter, as parts of the number that it was. */
const LEAST = 0.5;
const MOST = 1.5;
const NUMBER_AND_UNIT = /^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*(.*?)\s*$/i;
const AXES = ["x", "y", "z"];
/** Keys that do not describe the number. */
const SILENT = new Set(["value", "shape", "motion", "of", "region"]);
const SINGLE: Readonly<Record<string, string>> = { bodies: "body", supplies: "supply" };

/** The words of a place: the entry it is in, by name or kind, and its key there. */
function wordsOf(path: Path, source: Table): string[] {
  const [section, ...rest] = path;
  const words: string[] = [];
  let here: unknown = source[String(section)];
  rest.forEach((step, i) => {
    here = (here as Record<string | number, unknown> | undefined)?.[step];
    if (typeof step === "number") {
      if (i === 0) {
        const { name, kind } = (here ?? {}) as { name?: unknown; kind?: unknown };
        const own = SINGLE[String(section)] ?? String(section).replace(/s$/, "");
        words.push(String(name ?? kind ?? own));
      } else if (i === rest.length - 1) words.push(AXES[step] ?? String(step + 1));
    } else if (!SILENT.has(step)) words.push(step);
  });
  return rest.length > 0 ? words : [String(section)];
}

/** Name of a parameter of a place: letters, digits and _, as formulas know names. */
export function parameterName(path: Path, source: Table): string {
  const name = wordsOf(path, source)
    .join("_")
    .replaceAll(/[^A-Za-z0-9_]+/g, "_");
  return /^[A-Za-z]/.test(name) ? name : `p_${name}`;
}

/** Check if a value of the document is one number, with a unit or without. */
export function isNumber(value: unknown): boolean {
  return typeof value === "number" || NUMBER_AND_UNIT.test(String(value ?? ""));
}

/** The changes that make a number of the document a parameter; empty where it is none. */
export function promoted(path: Path, value: unknown, source: Table): Change[] {
  return promotedTo(parameterName(path, source), value, source, (formula) => [
    { path, value: formula },
  ]);
}

/** Put a value under a name, where `place` puts the formula. */
export function promotedTo(
  wanted: string,
  value: unknown,
  source: Table,
  place: (formula: string) => readonly Change[],
): Change[] {
  const match = NUMBER_AND_UNIT.exec(String(value ?? ""));
  if (!match) return [];
  const [, digits, unit] = match;
  const number = Number(digits);
  const taken = Object.keys((source.parameters as Table | undefined) ?? {});
  const plain = wanted.replaceAll(/[^A-Za-z0-9_]+/g, "_");
  const name = freeName(plain, taken).replaceAll("-", "_");
  const written = (part: number) => {
    const size = Number((part * number).toPrecision(12));
    return unit ? `${size} ${unit}` : size;
  };
  const [min, max] = number < 0 ? [written(MOST), written(LEAST)] : [written(LEAST), written(MOST)];
  const parameter = number === 0 ? { value } : { value, min, max };
  return [{ path: ["parameters", name], value: parameter }, ...place(`= ${name}`)];
}
