// Removal of an entry together with all that cannot be without it, of all depths.
import type { Change, Path } from "../edits";
import { single } from "../fields/schema";
import { mentions, type Spoken, valueAt, withValue } from "./mentions";

type Table = Readonly<Record<string, unknown>>;

export interface Removal {
  /** Entries that go along, in words. */
  readonly along: readonly string[];
  /** Entries that stay, and change. */
  readonly kept: readonly string[];
  readonly changes: readonly Change[];
}

/** Kinds of shapes that may lose an operand. */
const SHRINKING: ReadonlySet<unknown> = new Set(["union", "difference", "intersection"]);
const key = (path: Path) => JSON.stringify(path);

/** Everything that has to be changed for an entry to go. */
export function removalOf(source: Table, asked: Path): Removal {
  const gone = new Map<string, Path>([[key(asked), asked]]);
  const changed = new Map<string, Change>();
  const waiting = [asked];
  const go = (path: Path) => {
    if (gone.has(key(path))) return;
    gone.set(key(path), path);
    waiting.push(path);
  };
  while (waiting.length > 0) {
    const path = waiting.shift() as Path;
    const named = nameOf(source, path);
    if (!named) continue;
    const [section, name] = named;
    for (const at of mentions(source, section, name)) {
      if (gone.has(key(entryOf(at)))) continue;
      if (section === "histories") {
        changed.set(key(at), { path: at, value: null });
      } else if (section === "parameters") {
        const before = changed.get(key(at))?.value ?? valueAt(source, at);
        changed.set(key(at), {
          path: at,
          value: withValue(String(before), name, written(source, path)),
        });
      } else {
        const left = operandsLeft(source, at, changed, name);
        if (left) changed.set(key(left.path), left);
        else go(entryOf(at));
      }
    }
  }
  const others = [...gone.values()].slice(1);
  // An entry that goes as a whole is not changed before.
  const kept = [...changed.values()].filter(({ path }) => !gone.has(key(entryOf(path))));
  return {
    along: others.map((path) => wordsOf(source, path)),
    kept: [...new Set(kept.map(({ path }) => wordsOf(source, entryOf(path))))],
    changes: [...kept, ...removals([...gone.values()])],
  };
}

/** Removals one after the other: the later entries of a list first, as the others move up. */
function removals(paths: readonly Path[]): Change[] {
  const index = (path: Path) => {
    const last = path.at(-1);
    return typeof last === "number" ? last : Number.POSITIVE_INFINITY;
  };
  const ordered = paths.toSorted((a, b) => b.length - a.length || compare(index(b), index(a)));
  return ordered.map((path) => ({ path, value: null }));
}

function compare(a: number, b: number): number {
  return a === b ? 0 : a - b;
}

/** The section and the name by which others speak of an entry. */
function nameOf(source: Table, path: Path): readonly [Spoken, string] | null {
  const [section, name] = path;
  if (path.length !== 2) return null;
  switch (section) {
    case "parameters":
    case "shapes":
    case "materials":
    case "histories":
    case "chambers":
    case "probes":
      return [section, String(name)];
    case "parts":
    case "tendons":
    case "clamps": {
      const entry = valueAt(source, path) as Table | undefined;
      const own = entry?.name ?? (section === "parts" ? entry?.shape : undefined);
      const all = (source[section] as readonly Table[] | undefined) ?? [];
      const alike = all.filter((one) => (one.name ?? one.shape) === own);
      return typeof own === "string" && alike.length === 1 ? [section, own] : null;
    }
    default:
      return null;
  }
}

/** The list of operands without one of them, where the shape goes on with the others. */
function operandsLeft(
  source: Table,
  at: Path,
  changed: ReadonlyMap<string, Change>,
  name: string,
): Change | null {
  const [list, index] = [at.slice(0, -1), at.at(-1)];
  if (list.at(-1) !== "of" || typeof index !== "number") return null;
  const { kind } = (valueAt(source, list.slice(0, -1)) ?? {}) as Table;
  const before = changed.get(key(list))?.value ?? valueAt(source, list);
  if (!SHRINKING.has(kind) || !Array.isArray(before)) return null;
  const left = before.filter((one) => one !== name);
  // The first operand of a difference is all there is of it.
  const stays = kind !== "difference" || before[0] !== name;
  return stays && left.length > 0 ? { path: list, value: left } : null;
}

/** Path of the entry of a section in which a path lies. */
function entryOf(path: Path): Path {
  const [section, , inner] = path;
  if (section === "bodies" && inner === "parts") return path.slice(0, 4);
  if (section === "contact" && path[1] === "pairs") return path.slice(0, 3);
  return path.slice(0, 2);
}

function written(source: Table, path: Path): string {
  const value = valueAt(source, path);
  const own = typeof value === "object" && value !== null ? (value as Table).value : value;
  return String(own);
}

function wordsOf(source: Table, path: Path): string {
  const [section, name] = [String(path[0]), path.at(-1)];
  const entry = valueAt(source, path) as Table | undefined;
  const word = section === "contact" ? "pair of contact" : single(section).toLowerCase();
  if (typeof name === "string") return `${word} ${name}`;
  const own = typeof entry?.name === "string" ? entry.name : entry?.shape;
  const called = typeof own === "string" ? ` (${own})` : "";
  return `${word} ${Number(name) + 1}${called}`;
}
