// Reading of a mesh: its unit is asked for, unless the file says it.
import { create } from "zustand";
import { factorOf } from "../controls/units";
import type { ErrorEvent, MeshFactsEvent, MeshImport, Triple } from "../protocol";
import { openSheet, type Sheet, usePage } from "../store/page";
import { ask } from "../store/session";
import { toast } from "../store/studio";

interface Importing {
  readonly facts: MeshFactsEvent | null;
  /** Takes the answer of the sheet. */
  confirm(how: MeshImport): void;
}

export const useImporting = create<Importing>(() => ({ facts: null, confirm: () => {} }));

/** A mesh that was uploaded, and how it is to be read. */
export interface ReadMesh {
  readonly facts: MeshFactsEvent;
  readonly how: MeshImport;
}

/** Ask for the unit of a mesh that was uploaded, unless it says it; null where it was given up. */
export async function askImport(name: string): Promise<ReadMesh | null> {
  const facts = await factsOf(name);
  if (facts === null) return null;
  if (facts.stated) return { facts, how: { unit: facts.unit } };
  const before: Sheet = usePage.getState().sheet;
  const how = await new Promise<MeshImport | null>((resolve) => {
    useImporting.setState({ facts, confirm: resolve });
    openSheet("import");
    const stop = usePage.subscribe(({ sheet }) => {
      if (sheet === "import" && useImporting.getState().facts === facts) return;
      stop();
      resolve(null);
    });
  });
  if (how === null && before === "start" && usePage.getState().sheet === null) openSheet(before);
  return how && { facts, how };
}

async function factsOf(name: string): Promise<MeshFactsEvent | null> {
  try {
    const reply = await ask("/mesh", { name });
    const said: unknown = await reply.json();
    if (reply.ok) return said as MeshFactsEvent;
    const { where = name, what = "", hint = "" } = said as Partial<ErrorEvent>;
    toast({ level: "error", what: `${where}: ${what}`, hint });
  } catch {
    toast({
      level: "error",
      what: `${name} could not be read`,
      hint: "VoxSoft does not answer; drop the file again when it does.",
    });
  }
  return null;
}

type Up = NonNullable<MeshImport["up"]>;

/** Turn about an axis that brings an axis of the file up, and the place of a point after it. */
const TURNS: Readonly<
  Record<Exclude<Up, "z">, readonly [axis: string, degrees: number, turn: (p: Triple) => Triple]>
> = {
  x: ["y", -90, ([x, y, z]) => [-z, y, x]],
  "-x": ["y", 90, ([x, y, z]) => [z, y, -x]],
  y: ["x", 90, ([x, y, z]) => [x, -z, y]],
  "-y": ["x", -90, ([x, y, z]) => [x, z, -y]],
  "-z": ["x", 180, ([x, y, z]) => [x, -y, -z]],
};

/** Box of an imported mesh in m. */
export function boxOfImport({ facts, how }: ReadMesh): { low: Triple; high: Triple } {
  const meter = factorOf(how.unit) * (how.scale ?? 1);
  const up = how.up ?? "z";
  const turn = up === "z" ? (point: Triple) => point : TURNS[up][2];
  const [a, b] = [turn(facts.low), turn(facts.high)];
  const ends = (choose: (...both: number[]) => number) =>
    a.map((x, axis) => meter * choose(x, b[axis] as number)) as Triple;
  return { low: ends(Math.min), high: ends(Math.max) };
}

/** An imported mesh as a shape of a design. */
export function shapeOfImport(how: MeshImport, path: string): Readonly<Record<string, unknown>> {
  const mesh = { kind: "mesh", path, unit: how.unit };
  const scale = how.scale ?? 1;
  const scaled = scale === 1 ? mesh : { kind: "scale", of: mesh, factor: scale };
  const up = how.up ?? "z";
  if (up === "z") return scaled;
  const [axis, degrees] = TURNS[up];
  return { kind: "rotate", of: scaled, axis, angle: `${degrees} deg` };
}
