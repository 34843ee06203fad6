import type { StatEvent } from "../../protocol";

/** Check if the body is drawn as it was built: no time has run and nothing was solved. */
export function isAsBuilt(stat: Pick<StatEvent, "state" | "time"> | null): boolean {
  if (stat === null) return true;
  const moved: readonly StatEvent["state"][] = ["at-rest", "playing", "solving", "diverged"];
  return stat.time === 0 && !moved.includes(stat.state);
}
