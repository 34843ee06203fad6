// Place of messages: in the picture, over its ground, beside the buttons there.

export interface Box {
  readonly left: number;
  readonly right: number;
  readonly bottom: number;
}

export interface ToastPlace {
  readonly left: number;
  readonly width: number;
  /** From the bottom of the page. */
  readonly bottom: number;
}

const WIDEST = 520;
/** Narrower than this a message cannot be read. */
const NARROWEST = 200;
const GAP = 10;
/** The height that badges and the scale take at the bottom of the picture. */
const BADGES = 40;

/** The place for messages in a picture with a card at its left and the cube at its right. */
export function toastPlace(
  stage: Box,
  card: Box | null,
  cube: Box | null,
  height: number,
): ToastPlace | null {
  const from = (card ? card.right : stage.left) + GAP;
  const to = (cube ? cube.left : stage.right) - GAP;
  const width = Math.min(WIDEST, to - from);
  if (width < NARROWEST) return null;
  const middle = (stage.left + stage.right - width) / 2;
  const left = Math.min(Math.max(middle, from), to - width);
  return { left, width, bottom: height - stage.bottom + BADGES };
}

/** The place on the page as it is; null where it shows no picture, or too small a one. */
export function toastPlaceNow(): ToastPlace | null {
  const box = (selector: string) => {
    const found = document.querySelector(selector)?.getBoundingClientRect();
    return found && found.width > 0 ? found : null;
  };
  const stage = box(".view-stage");
  return stage && toastPlace(stage, box(".picked"), box(".cube"), innerHeight);
}
