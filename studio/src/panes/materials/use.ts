// Giving a material to a part, and making a material of the design from a card.
import type { MaterialFacts } from "../../protocol";
import type { Change } from "../design/edits";
import { freeName } from "../design/fields/starters";

type Table = Readonly<Record<string, unknown>>;

/** Name of a dragged material among the data of the drag. */
export const DRAGGED = "application/x-voxsoft-material";

/** A part of the design, as far as its material goes. */
export interface PartChoice {
  readonly index: number;
  readonly name: string;
  readonly material: unknown;
  readonly fibers: boolean;
}

export function partsOf(source: Table): PartChoice[] {
  const parts = (source.parts as readonly Table[] | undefined) ?? [];
  return parts.map((part, index) => ({
    index,
    name: nameOf(part, index),
    material: part.material,
    fibers: Array.isArray(part.fibers) && part.fibers.length > 0,
  }));
}

function nameOf(part: Table, index: number): string {
  if (typeof part.name === "string") return part.name;
  return typeof part.shape === "string" ? part.shape : `part ${index + 1}`;
}

/** Check if a part is made of a material, by its name or by the card that this stands for. */
export function isUsed(one: MaterialFacts, part: PartChoice): boolean {
  if (typeof part.material !== "string") return false;
  if (part.material === one.name || (one.same_as !== "" && part.material === one.same_as))
    return true;
  // The server knows files by absolute paths, the design by those from its folder.
  return one.origin === "file" && one.name.endsWith(`/${part.material.replace(/^\.\//, "")}`);
}

/** Why a part cannot have a material; null where it can. */
export function refusal(one: MaterialFacts, part: PartChoice): string | null {
  if (part.fibers && one.live !== "implicit")
    return `The fibers of ${part.name} need a hyperelastic material around them.`;
  return null;
}

/** Mixture that a material makes of the design, in words; empty where there is none. */
export function mixes(
  one: MaterialFacts,
  part: PartChoice,
  parts: readonly PartChoice[],
  materials: readonly MaterialFacts[],
): string {
  if (one.live === "none") return "";
  const other = parts.find((each) => {
    if (each.index === part.index) return false;
    const known = materials.find((facts) => isUsed(facts, each));
    return known !== undefined && known.live !== "none" && known.live !== one.live;
  });
  if (!other) return "";
  const [what, beside] =
    one.live === "explicit" ? ["a spring lattice", "rubber"] : ["rubber", "a spring lattice"];
  return `Mixes ${what} with ${beside} of ${other.name}: live motion is slower, without error bars.`;
}

/** The name in a design: a file is named from its folder. */
export function writtenName(one: MaterialFacts, folder: string): string {
  const inside = one.origin === "file" && folder !== "" && one.name.startsWith(`${folder}/`);
  return inside ? one.name.slice(folder.length + 1) : one.name;
}

/** The change that gives a part a material. */
export function given(one: MaterialFacts, part: PartChoice, folder: string): Change {
  return { path: ["parts", part.index, "material"], value: writtenName(one, folder) };
}

/** The change that writes a card into the design as a material of its own, and its name there. */
export function copied(one: MaterialFacts, source: Table, taken: readonly string[]) {
  const stem = one.origin === "file" ? stemOf(one.name) : one.name;
  const own = Object.keys((source.materials as Table | undefined) ?? {});
  const name = freeName(`${stem}-own`, [...own, ...taken]);
  const change: Change = { path: ["materials", name], value: one.table };
  return { name, change };
}

function stemOf(path: string): string {
  return (path.split("/").at(-1) ?? path).replace(/\.toml$/i, "");
}
