// Appearance of the body: the chosen one, or until a hand chooses the one that suits the body.
import type { BodyEvent } from "../protocol";

export type Appearance = "voxels" | "smooth" | "tets" | "wireframe";
/** Choice of a hand; "auto" before there is one. */
export type ChosenAppearance = Appearance | "auto";

/**
 * Decide how a body is drawn. Cut voxels are drawn in full, stairs and all: the smooth shape suits
 * their body better. Voxels stand for it until it is traced, and where their chambers are shown.
 */
export function appearanceOf(
  { appearance, cavities }: { appearance: ChosenAppearance; cavities: boolean },
  body: Pick<BodyEvent, "smooth" | "cut"> | null,
): Appearance {
  const wanted = appearance === "auto" ? (body?.cut ? "smooth" : "voxels") : appearance;
  const traced = body?.smooth ?? false;
  return wanted === "smooth" && (!traced || cavities) ? "voxels" : wanted;
}
