// What a finding is about, in words: the path "loads[0]" of a design is "Load 1".

const ENTRY = /^(parts|layers|clamps|loads)\[(\d+)\]/;
const NAMED = /^(shapes|probes|materials|parameters|objectives|constraints|chambers)\.([^.[]+)/;

/** The subject of a finding by the place that it names; "" where that is the body itself. */
export function subjectOf(where: string): string {
  const entry = ENTRY.exec(where);
  if (entry) return `${single(entry[1] as string)} ${Number(entry[2]) + 1}`;
  const named = NAMED.exec(where);
  if (named) return `${single(named[1] as string)} ${named[2]}`;
  if (/^(voxels?|mesh|body)\b/.test(where)) return "";
  return where.charAt(0).toUpperCase() + where.slice(1).replaceAll("_", " ");
}

function single(section: string): string {
  const name = section.slice(0, -1);
  return name.charAt(0).toUpperCase() + name.slice(1);
}
