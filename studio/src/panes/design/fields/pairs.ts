// Names of the two numbers of a field: ends of a stretch, or coordinates of a point of a profile.
import type { Path } from "../edits";

/** Coordinates of the points of a profile, by the kind of its shape. */
const PROFILES: Readonly<Record<string, readonly [string, string]>> = {
  revolve: ["radius", "height"],
  prism: ["x", "y"],
};

/** Coordinates of the points in the list at a path; null where they are no profile. */
export function profileAt(source: unknown, path: Path): readonly [string, string] | null {
  if (path.at(-1) !== "points") return null;
  let shape = source;
  for (const step of path.slice(0, -1)) {
    shape = (shape as Record<string | number, unknown> | undefined)?.[step];
  }
  const kind = (shape as { kind?: unknown } | undefined)?.kind;
  return typeof kind === "string" ? (PROFILES[kind] ?? null) : null;
}

/** Names of the numbers of a field of two or three. */
export function numberNames(source: unknown, path: Path, count: number): readonly string[] {
  if (count !== 2) return ["x", "y", "z"];
  return profileAt(source, path.slice(0, -1)) ?? ["from", "to"];
}
