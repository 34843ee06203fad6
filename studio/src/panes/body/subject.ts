import { single } from "../design/fields/schema";

// Subjects of findings, in words: the path "loads[0]" of a design is "Load 1".

const ENTRY = /^(\w+)\[(\d+)\]/;
const NAMED = /^(shapes|probes|materials|parameters|objectives|constraints|chambers)\.([^.[]+)/;

/** The subject of a finding by the place that it names; "" where that is the body itself. */
export function subjectOf(where: string): string {
  if (/^(voxels?|mesh|body)\b/.test(where)) return "";
  const entry = ENTRY.exec(where);
  if (entry) return `${single(entry[1] as string)} ${Number(entry[2]) + 1}`;
  const named = NAMED.exec(where);
  if (named) return `${single(named[1] as string)} ${named[2]}`;
  return where.charAt(0).toUpperCase() + where.slice(1).replaceAll("_", " ");
}
