// Places of a design that speak of a named thing: of a shape, a part, a probe and so on.
import type { Path } from "../edits";

type Table = Readonly<Record<string, unknown>>;

/** Sections whose entries others speak of by name. */
export type Spoken =
  | "parameters"
  | "shapes"
  | "parts"
  | "materials"
  | "histories"
  | "chambers"
  | "probes"
  | "tendons"
  | "clamps";

const GOALS: readonly string[] = ["objectives", "constraints"];

/** Check if a key at a path holds the name of a thing of a section. */
const SPEAKS: Readonly<
  Record<Exclude<Spoken, "parameters">, (key: string, path: Path) => boolean>
> = {
  shapes: (key, [section]) =>
    key === "shape" ||
    (key === "of" && section !== "contact") ||
    (section === "shapes" && ["by", "base", "inner", "outer"].includes(key)),
  parts: (key) => key === "part",
  materials: (key) => key === "material",
  histories: (key) => key === "history",
  chambers: (key) => ["cavity", "chamber", "chambers"].includes(key),
  probes: (key, [section]) => ["probe", "base"].includes(key) && GOALS.includes(String(section)),
  tendons: (key, [section]) => key === "tendon" && GOALS.includes(String(section)),
  clamps: (key, [section]) => key === "clamp" && GOALS.includes(String(section)),
};

/** Paths of all texts that name a thing of a section. */
export function mentions(source: Table, section: Spoken, name: string): Path[] {
  if (section === "parameters") return formulasWith(source, name, []);
  const speaks = SPEAKS[section];
  const inside = (value: unknown, path: Path): Path[] => {
    if (Array.isArray(value)) return value.flatMap((one, i) => inside(one, [...path, i]));
    if (typeof value !== "object" || value === null) return [];
    return Object.entries(value).flatMap(([key, inner]) => {
      const at = [...path, key];
      if (!speaks(key, at)) return inside(inner, at);
      if (inner === name) return [at];
      // A list may hold names and tables beside each other.
      const named = Array.isArray(inner)
        ? inner.flatMap((one, i): Path[] => (one === name ? [[...at, i]] : []))
        : [];
      return [...named, ...inside(inner, at)];
    });
  };
  return inside(source, []);
}

function formulasWith(value: unknown, name: string, path: Path): Path[] {
  if (typeof value === "string")
    return value.trimStart().startsWith("=") && wordOf(name).test(value) ? [path] : [];
  if (typeof value !== "object" || value === null) return [];
  const entries: [string | number, unknown][] = Array.isArray(value)
    ? value.map((one, i) => [i, one])
    : Object.entries(value);
  return entries.flatMap(([key, inner]) => formulasWith(inner, name, [...path, key]));
}

/** A formula with the text of a parameter in place of its name. */
export function withValue(formula: string, name: string, written: string): string {
  const bare = written.trim().replace(/^=\s*/, "");
  const body = formula.trim().replace(/^=\s*/, "");
  if (body === name) return written;
  const inner = /^[\d.]+(e[+-]?\d+)?( ?[^\s()+*/-]+)?$/i.test(bare) ? bare : `(${bare})`;
  return `= ${body.replaceAll(new RegExp(wordOf(name), "g"), inner)}`;
}

function wordOf(name: string): RegExp {
  return new RegExp(`(?<![\\w.])${name}(?!\\w)`);
}

/** The value at a path; undefined where it leads nowhere. */
export function valueAt(source: Table, path: Path): unknown {
  return path.reduce<unknown>(
    (value, key) =>
      typeof value === "object" && value !== null
        ? (value as Readonly<Record<string | number, unknown>>)[key]
        : undefined,
    source,
  );
}
