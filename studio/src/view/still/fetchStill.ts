// Bodies at rest beside the one of the view: of runs, of designs of studies, of calibrations.
import { decodeAll, type Frame, type Smooth, type Topology } from "../../engine/frames";
import { STILL_OBJECTS } from "../../protocol";
import { colorRange } from "../body/colorRange";

export interface Still {
  readonly topology: Topology;
  /** One frame for each field that can be told, by the field's number. */
  readonly frames: ReadonlyMap<number, Frame>;
  /** The shape that cuts the voxels of the body; null where none does. */
  readonly smooth: Smooth | null;
  /** The surface of all rigid objects around it, where they are; null where there is none. */
  readonly objects: Topology | null;
}

interface Refusal {
  readonly where: string;
  readonly what: string;
  readonly hint: string;
}

/** Ask for a body by its name; aborting ends the solver that works on it. */
export async function fetchStill(name: string, signal: AbortSignal): Promise<Still> {
  const answer = await fetch(`/still?${new URLSearchParams({ of: name })}`, { signal });
  if (!answer.ok) throw new Error(sentenceOf((await answer.json()) as Refusal));
  return stillOf(await answer.arrayBuffer());
}

/** Read an answer: a surface, frames of it, the shape of cut voxels, and the objects around it. */
export function stillOf(buffer: ArrayBuffer): Still {
  let topology: Topology | null = null;
  let smooth: Smooth | null = null;
  let objects: Topology | null = null;
  const frames = new Map<number, Frame>();
  for (const message of decodeAll(buffer)) {
    if (message.kind === "topology" && message.id === STILL_OBJECTS) objects = message;
    else if (message.kind === "topology") topology = message;
    else if (message.kind === "frame") frames.set(message.field, message);
    else smooth = message;
  }
  if (!topology || frames.size === 0) throw new Error("The body came without a shape.");
  return { topology, frames, smooth, objects };
}

/** A refusal as a sentence for people. */
function sentenceOf({ where, what, hint }: Refusal): string {
  const cause = [where, what].filter(Boolean).join(": ");
  return hint ? `${cause}. Try: ${hint}.` : `${cause}.`;
}

/** The range of colors that several bodies share for a field; null where none is told. */
export function commonRange(
  stills: readonly Still[],
  field: number,
): { low: number; high: number; clipped: boolean } | null {
  const ranges = stills.flatMap(({ topology, frames }) => {
    const frame = frames.get(field);
    return frame ? [colorRange(frame, topology)] : [];
  });
  if (ranges.length === 0) return null;
  return {
    low: Math.min(...ranges.map((one) => one.low)),
    high: Math.max(...ranges.map((one) => one.high)),
    clipped: ranges.some((one) => one.clipped.length > 0),
  };
}
