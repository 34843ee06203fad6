// Changes of the document, from the form and from other panes; all end in the one text.
import type { Diagnostic, OpenCommand, RenameCommand } from "../../protocol";
import { openDocument } from "../../shell/actions";
import { send } from "../../store/session";
import { stroke } from "../../store/stroke";
import { useStudio } from "../../store/studio";

/** Sections whose entries have names that the rest of the text speaks of. */
export type Named = RenameCommand["section"];

export type Path = readonly (string | number)[];

/** Shortest time between two changes while a slider moves, ms. */
const SPACING = 60;

/** Set one value of the document; null removes it. */
export function edit(path: Path, value: unknown): void {
  const rev = useStudio.getState().document?.rev ?? 0;
  send({ t: "edit", rev, path: [...path], value, stroke: stroke() });
}

/** One change of the document. */
export interface Change {
  readonly path: Path;
  readonly value: unknown;
}

/** Set several values as one step, which is undone together. */
export function editAll(changes: readonly Change[]): void {
  const rev = useStudio.getState().document?.rev ?? 0;
  send({
    t: "edits",
    rev,
    changes: changes.map(({ path, value }) => ({ path: [...path], value })),
  });
}

/** Give a named thing another name, everywhere the text speaks of it. */
export function rename(section: Named, name: string, to: string): void {
  send({ t: "rename", section, name, to });
}

/** Exchange two entries of a list; their values stay those of the newest text. */
export function swap(path: Path, first: number, second: number): void {
  send({ t: "swap", path: [...path], first, second });
}

/** Problem of a name that something is to get, or null. */
export function problemOfName(
  name: string,
  section: Named,
  taken: readonly string[],
): string | null {
  // Formulas read a minus sign where the name of a parameter had one.
  const formulas = section === "parameters";
  if (!(formulas ? /^[A-Za-z_]\w*$/ : /^[A-Za-z_][\w-]*$/).test(name)) {
    return formulas ? "letters, digits and _ only" : "letters, digits, _ and - only";
  }
  return taken.includes(name) ? `“${name}” is taken` : null;
}

type Table = Readonly<Record<string, unknown>>;

/** Changes that turn a table into another one: keys alone, so that a pending change of another key stays. */
export function changesOf(path: Path, before: Table, after: Table): readonly Change[] {
  const gone = Object.keys(before).filter((key) => !(key in after));
  const other = Object.entries(after).filter(
    ([key, value]) => JSON.stringify(before[key]) !== JSON.stringify(value),
  );
  return [
    ...gone.map((key) => ({ path: [...path, key], value: null })),
    ...other.map(([key, value]) => ({ path: [...path, key], value })),
  ];
}

/** Open another document. */
export function openHere(what: OpenCommand["what"], name: string): void {
  openDocument({ t: "open", what, name });
}

interface Sliding {
  value: unknown;
  timer: ReturnType<typeof setTimeout> | null;
}

const sliding = new Map<string, Sliding>();

/** Like `edit` while a slider moves: the newest value is sent, not more often than makes sense. */
export function slide(path: Path, value: unknown, settled: boolean): void {
  const key = JSON.stringify(path);
  const known = sliding.get(key);
  if (settled) {
    if (known?.timer) clearTimeout(known.timer);
    sliding.delete(key);
    edit(path, value);
    return;
  }
  if (known) {
    known.value = value;
    return;
  }
  edit(path, value);
  const entry: Sliding = { value, timer: null };
  entry.timer = setTimeout(() => {
    sliding.delete(key);
    if (entry.value !== value) slide(path, entry.value, false);
  }, SPACING);
  sliding.set(key, entry);
}

/** A path as VoxSoft's messages write it: `parts[0].material`. */
export function placeText(path: Path): string {
  return path
    .map((step, i) => (typeof step === "number" ? `[${step}]` : i ? `.${step}` : step))
    .join("");
}

/** Problems at a place or anywhere below it. */
export function problemsAt(diagnostics: readonly Diagnostic[], path: Path): readonly Diagnostic[] {
  const place = placeText(path);
  return diagnostics.filter(
    ({ where }) =>
      where === place || (where.startsWith(place) && /[.[]/.test(where[place.length] ?? "")),
  );
}

/** One sentence for a field: the problem, and a remedy. */
export function problemText(diagnostics: readonly Diagnostic[]): string | undefined {
  const first = diagnostics[0];
  if (!first) return undefined;
  return first.hint ? `${first.what}. Try: ${first.hint}` : first.what;
}
