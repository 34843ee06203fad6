// The kinds of shapes in groups, as the picker shows them.
import type { SHAPE_KINDS } from "../../../protocol";

export type ShapeKind = (typeof SHAPE_KINDS)[number];

export interface ShapeGroup {
  readonly title: string;
  readonly kinds: readonly ShapeKind[];
}

/** Shapes with which most robots begin. */
export const FIRST_KINDS: readonly ShapeKind[] = ["box", "cylinder", "sphere"];

/** Every kind stands in one group. */
export const SHAPE_GROUPS: readonly ShapeGroup[] = [
  {
    title: "Solids",
    kinds: [
      ...(["box", "rounded-box", "sphere", "ellipsoid", "cylinder"] as const),
      ...(["tube", "cone", "capsule", "torus", "half-space"] as const),
    ],
  },
  { title: "Extrude and revolve", kinds: ["prism", "revolve"] },
  { title: "Combine", kinds: ["union", "difference", "intersection", "blend"] },
  {
    title: "Move and repeat",
    kinds: ["translate", "rotate", "scale", "mirror", "array", "polar-array"],
  },
  { title: "Deform", kinds: ["bend", "twist", "taper"] },
  { title: "Walls", kinds: ["offset", "shell", "grade"] },
  {
    title: "Lattices and surfaces",
    kinds: [
      ...(["gyroid", "schwarz-p", "schwarz-d", "neovius", "iwp"] as const),
      ...(["cubic", "bcc", "fcc", "octet"] as const),
    ],
  },
  { title: "Files and formulas", kinds: ["mesh", "expression"] },
];

/** The groups with those kinds that a search leaves: by name, by group, or by description. */
export function foundGroups(
  search: string,
  groups: readonly ShapeGroup[],
  about: (kind: ShapeKind) => string,
): readonly ShapeGroup[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  const holds = (text: string) => words.every((word) => text.toLowerCase().includes(word));
  return groups
    .map(({ title, kinds }) => ({
      title,
      kinds: kinds.filter((kind) => holds(`${kind} ${title} ${about(kind)}`)),
    }))
    .filter(({ kinds }) => kinds.length > 0);
}

/** Which of the kinds that were found is chosen first: the one whose name begins as the search does. */
export function firstFound(search: string, kinds: readonly ShapeKind[]): number {
  const wanted = search.trim().toLowerCase();
  const begins = kinds.findIndex((kind) => wanted !== "" && kind.startsWith(wanted));
  const named = kinds.findIndex((kind) => wanted !== "" && kind.includes(wanted));
  return Math.max(begins >= 0 ? begins : named, 0);
}
