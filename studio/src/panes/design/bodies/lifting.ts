// Gripping and lifting as a program over time: grippers close on an object, then go up with it.
import type { Change } from "../edits";
import { type Room, written } from "./placing";

type Table = Readonly<Record<string, unknown>>;

/** When fingers close, when they go up, and until when it is watched, s. */
const CLOSING = [0.1, 0.4] as const;
const LIFTING = [0.5, 0.8] as const;
const END = 1;
/** Weight comes on in some steps: an object that drops onto a floor bounces. */
const WEIGHT = 0.1;
/** Contact that changes much within a step halves it by itself. */
const STEP = "20 ms";
/** Gap between an object and the floor that it stands on, in voxels. */
const ABOVE_FLOOR = 0.01;
/** Keys of a solver that any method takes. */
const OF_ALL = ["refine", "error"] as const;

const listOf = (source: Table, section: string) =>
  (source[section] as readonly Table[] | undefined) ?? [];
const ramp = ([from, to]: readonly [number, number]) => ({
  time: [`${from} s`, `${to} s`],
  factor: [0, 1],
});

/** Height by which an object is lifted, m: its own height, to one digit. */
export const liftOf = ({ low, high }: Room): number => Number((high[2] - low[2]).toPrecision(1));

/**
 * The changes by which a free object is gripped and lifted; empty where nothing of the design could do it.
 *
 * `object` and `body` are their boxes in m. Things with a history or a motion of their own keep it.
 */
export function lifting(source: Table, object: Room, body: Room, voxel: number): Change[] {
  const clamps = listOf(source, "clamps");
  const free = clamps.map((clamp) => clamp.motion === undefined && (clamp.axes ?? "xyz") === "xyz");
  if (listOf(source, "bodies").length > 0 || !free.includes(true)) return [];
  const known = Object.keys((source.histories as Table | undefined) ?? {});
  const changes: Change[] = [];
  /** The name of a history, which is written where it is new. */
  const history = (name: string, times: readonly [number, number]) => {
    if (!known.includes(name)) {
      known.push(name);
      changes.push({ path: ["histories", name], value: ramp(times) });
    }
    return name;
  };
  // A body that hangs lower than the object leaves no room for a floor: it is held first, and heavy then.
  const stands = source.floor !== undefined || object.low[2] < body.low[2];
  if (stands && source.floor === undefined) {
    const z = written(object.low[2] - ABOVE_FLOOR * voxel);
    changes.push({ path: ["floor"], value: { z } });
  }
  const heavy: readonly [number, number] = stands ? [0, WEIGHT] : [CLOSING[1], LIFTING[0]];
  const loads = listOf(source, "loads");
  loads.forEach((load, i) => {
    if (load.history !== undefined) return;
    const is = load.kind === "gravity" ? history("weight", heavy) : history("close", CLOSING);
    changes.push({ path: ["loads", i, "history"], value: is });
  });
  if (!loads.some((load) => load.kind === "gravity")) {
    const value = { kind: "gravity", history: history("weight", heavy) };
    changes.push({ path: ["loads", loads.length], value });
  }
  listOf(source, "tendons").forEach((tendon, i) => {
    if (tendon.history !== undefined) return;
    changes.push({ path: ["tendons", i, "history"], value: history("close", CLOSING) });
  });
  const displacement = [0, 0, written(liftOf(object))];
  free.forEach((isFree, i) => {
    if (!isFree) return;
    const value = { displacement, history: history("lift", LIFTING) };
    changes.push({ path: ["clamps", i, "motion"], value });
  });
  const solver = (source.solver as Table | undefined) ?? {};
  const kept = Object.fromEntries(OF_ALL.filter((key) => key in solver).map((k) => [k, solver[k]]));
  changes.push({
    path: ["solver"],
    value: { ...kept, method: "dynamics", time_step: STEP, end_time: `${END} s` },
  });
  return changes;
}
