// Overlaps of the body with itself: marks in the picture, the deepest with its words.
import type { Vector3 } from "three";
import { formatQuantity } from "../../controls/units";
import type { OverlapEvent, OverlapPlace } from "../../protocol";
import { useStudio } from "../../store/studio";
import type { Label } from "./labels";

/** Overlap of the shown body with itself; null where there is none, or another body came. */
export function useOverlap(): OverlapEvent | null {
  return useStudio(({ overlap, body }) => overlapOf(overlap, body?.topology));
}

export function overlapOf(
  overlap: OverlapEvent | null,
  topology: number | undefined,
): OverlapEvent | null {
  return overlap && overlap.topology === topology && overlap.places.length > 0 ? overlap : null;
}

/** Position where a place is drawn: its present one, its displacement drawn as large as all others. */
export function drawnAt({ rest, now }: OverlapPlace, exaggeration: number, out: Vector3): Vector3 {
  const along = (axis: 0 | 1 | 2) => rest[axis] + exaggeration * (now[axis] - rest[axis]);
  return out.set(along(0), along(1), along(2));
}

export function overlapLabels(
  overlap: OverlapEvent | null,
  exaggeration: number,
  go: (place: OverlapPlace) => void,
): Label[] {
  return (overlap?.places ?? []).map((place, i) => ({
    key: `overlap-${i}`,
    kind: "overlap",
    text: formatQuantity(place.depth, "m", 2),
    title: "The body is in itself here",
    at: (out) => drawnAt(place, exaggeration, out),
    onClick: () => go(place),
  }));
}
