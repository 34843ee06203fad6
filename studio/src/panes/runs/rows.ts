// Searching and naming rows of the list of runs.
import type { RunRow } from "../../protocol";

/** Check if all words of a search stand somewhere in a row. */
export function matchesSearch(row: RunRow, search: string): boolean {
  const text = [row.name, row.kind, row.status, row.best, row.message].join(" ").toLowerCase();
  return search
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
}

const STEPS: readonly (readonly [seconds: number, word: string])[] = [
  [60, "second"],
  [3600, "minute"],
  [86_400, "hour"],
  [2_592_000, "day"],
];

/** Time since an instant, in words; the date where it is more than a month. */
export function ago(when: string, now: number): string {
  const then = Date.parse(when);
  if (Number.isNaN(then)) return "–";
  const seconds = Math.max(0, (now - then) / 1000);
  if (seconds < 10) return "just now";
  let unit = 1;
  for (const [limit, word] of STEPS) {
    if (seconds < limit) {
      const count = Math.floor(seconds / unit);
      return `${count} ${word}${count === 1 ? "" : "s"} ago`;
    }
    unit = limit;
  }
  return when.slice(0, 10);
}

/** The id under which a deleted folder lies in the trash: its own, or with a number behind it. */
export function inTrash(trash: readonly RunRow[], id: string): string {
  const own = trash.filter(
    (row) =>
      row.id === id || (row.id.startsWith(`${id}-`) && /^\d+$/.test(row.id.slice(id.length + 1))),
  );
  const numbered = (row: RunRow) => Number(row.id.slice(id.length + 1) || 0);
  return own.sort((a, b) => numbered(b) - numbered(a))[0]?.id ?? id;
}
