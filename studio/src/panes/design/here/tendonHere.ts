// A tendon from one pressed place of the body to the next, and on to others.
import type { WrittenPlace } from "../../../store/face";
import type { Face } from "../../../view/hands/face";
import { written, writtenPlace } from "../bodies/placing";
import type { Change } from "../edits";
import { freeName } from "../fields/starters";

type Table = Readonly<Record<string, unknown>>;

/** Depth of the line below the surface, and radius of the pull around its anchor, in voxels. */
const BELOW = 0.5;
const AROUND = 1.5;
/** Tension of a new tendon. */
const TENSION = "100 mN";

const listOf = (source: Table, section: string) =>
  (source[section] as readonly Table[] | undefined) ?? [];

/** The place for a tendon where a face was pressed: half a voxel inside of the material. */
export function placeIn(face: Face): WrittenPlace {
  const inside = face.point.map((x, i) => x - BELOW * face.voxelSize * face.normal[i]!);
  return writtenPlace(inside as [number, number, number]);
}

const anchorAt = (point: WrittenPlace, voxel: number) => ({
  point,
  radius: written(AROUND * voxel),
});

/** Check if points of the body can be those of a tendon: in designs of several bodies they belong to one of them. */
export const canHaveTendons = (source: Table) => listOf(source, "bodies").length === 0;

/** A new tendon between two places, straight where it leaves the body. */
export function tendonBetween(
  from: WrittenPlace,
  to: WrittenPlace,
  voxel: number,
  source: Table,
): Change {
  const tendons = listOf(source, "tendons");
  const names = tendons.map(({ name }) => String(name ?? ""));
  return {
    path: ["tendons", tendons.length],
    value: {
      name: freeName("tendon", names),
      guide: "eyelets",
      through: [from, anchorAt(to, voxel)],
      tension: TENSION,
    },
  };
}

/** Changes that continue the last tendon to another place; null where its end is not a place that was pressed. */
export function tendonOn(to: WrittenPlace, voxel: number, source: Table): Change[] | null {
  const last = listOf(source, "tendons").length - 1;
  const through = listOf(source, "tendons")[last]?.through;
  if (!Array.isArray(through) || through.length === 0) return null;
  const end = through[through.length - 1] as { point?: unknown; radius?: unknown };
  if (!Array.isArray(end.point) || end.radius === undefined) return null;
  const path = ["tendons", last, "through"];
  return [
    { path: [...path, through.length - 1], value: end.point },
    { path: [...path, through.length], value: anchorAt(to, voxel) },
  ];
}
