// The kinds of shapes in groups, as the picker shows them.
import { FEATURES, type SHAPE_KINDS } from "../../../protocol";

export type ShapeKind = (typeof SHAPE_KINDS)[number];

/** A ready feature: several shapes with parameters. */
export type FeatureName = keyof typeof FEATURES;
export const FEATURE_NAMES = Object.keys(FEATURES) as FeatureName[];

export function isFeature(name: string): name is FeatureName {
  return name in FEATURES;
}

/** Choices of the picker. */
export type Addable = ShapeKind | FeatureName;

export interface ShapeGroup {
  readonly title: string;
  readonly kinds: readonly Addable[];
}

/** Shapes and features with which most robots begin. */
export const FIRST_KINDS: readonly Addable[] = [
  ...(["box", "cylinder", "sphere"] as const),
  ...(["bellows", "finger", "chamber-row"] as const),
];

/** Every kind stands in one group; those that most robots begin with come first. */
export const SHAPE_GROUPS: readonly ShapeGroup[] = [
  { title: "Ready features", kinds: FEATURE_NAMES },
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
  about: (kind: Addable) => string,
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
export function firstFound(search: string, kinds: readonly Addable[]): number {
  const wanted = search.trim().toLowerCase();
  const begins = kinds.findIndex((kind) => wanted !== "" && kind.startsWith(wanted));
  const named = kinds.findIndex((kind) => wanted !== "" && kind.includes(wanted));
  return Math.max(begins >= 0 ? begins : named, 0);
}
