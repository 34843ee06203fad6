// Words for the keys of a design file that a path is over, and for the numbers along it.
import type { Changeable } from "./lines";

/** The value that changes, as the choice of it has it; a key that the design has no more stays. */
export function overWords(key: string, choices: readonly Changeable[]): string {
  return choices.find((one) => one.key === key)?.label ?? key;
}

/** A number along the path: `tip.x`, `left.volume`, `cavity_volume`, or a name of the design. */
export function columnWords(name: string): string {
  const [, owner, what] = /^(.+)\.([^.]+)$/.exec(name) ?? [];
  if (owner && what && "xyz".includes(what)) return `displacement of ${owner} along ${what}`;
  if (owner && what) return `${what} of ${owner}`;
  return name.replaceAll("_", " ");
}

/** Words as they begin a label. */
export function capital(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}
