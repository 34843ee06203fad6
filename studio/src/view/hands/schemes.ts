// Which buttons of the mouse turn, move and zoom: VoxSoft's own way, and those of programs that
// users come from. Dragging on the body with the left button pulls it in every one of them.
import type { CameraRig } from "../drawing/camera";

export type Scheme = "voxsoft" | "onshape" | "solidworks" | "blender";
export type Motion = "turn" | "move" | "zoom";

interface Drag {
  readonly button: 0 | 1 | 2;
  readonly held?: "shift" | "ctrl";
  readonly does: Motion;
}

const LEFT = 0;
const MIDDLE = 1;
const RIGHT = 2;
// Wherever there is one button only, as on a trackpad, the view can be steered beside the body.
const BESIDE: readonly Drag[] = [
  { button: LEFT, does: "turn" },
  { button: LEFT, held: "shift", does: "move" },
];

const DRAGS: Readonly<Record<Scheme, readonly Drag[]>> = {
  voxsoft: [
    { button: RIGHT, does: "turn" },
    { button: MIDDLE, does: "move" },
  ],
  onshape: [
    { button: RIGHT, does: "turn" },
    { button: MIDDLE, does: "move" },
    { button: RIGHT, held: "ctrl", does: "move" },
  ],
  solidworks: [
    { button: MIDDLE, does: "turn" },
    { button: MIDDLE, held: "ctrl", does: "move" },
    { button: MIDDLE, held: "shift", does: "zoom" },
  ],
  blender: [
    { button: MIDDLE, does: "turn" },
    { button: MIDDLE, held: "shift", does: "move" },
    { button: MIDDLE, held: "ctrl", does: "zoom" },
  ],
};

export const SCHEMES: readonly { readonly value: Scheme; readonly label: string }[] = [
  { value: "voxsoft", label: "VoxSoft" },
  { value: "onshape", label: "Onshape" },
  { value: "solidworks", label: "SolidWorks" },
  { value: "blender", label: "Blender" },
];

const BUTTON_NAMES = ["left button beside the body", "middle button", "right button"] as const;
const HELD_NAMES = { shift: "Shift + ", ctrl: "Ctrl + " } as const;
const MOTIONS: readonly (readonly [Motion, string])[] = [
  ["turn", "Turn the view"],
  ["move", "Move the view"],
  ["zoom", "Zoom"],
];

/** Motion that a press begins, if it is meant for the camera. */
export function motionOf(
  scheme: Scheme,
  press: Pick<PointerEvent, "button" | "shiftKey" | "ctrlKey" | "metaKey">,
): Motion | null {
  const held = press.shiftKey ? "shift" : press.ctrlKey || press.metaKey ? "ctrl" : undefined;
  const drags = [...DRAGS[scheme], ...BESIDE].filter((drag) => drag.button === press.button);
  // A key that means nothing here changes nothing.
  const found = drags.find((drag) => drag.held === held) ?? drags.find((drag) => !drag.held);
  return found?.does ?? null;
}

/** Steer the camera by a drag of some pixels. */
export function steer(rig: CameraRig, motion: Motion, dx: number, dy: number): void {
  if (motion === "turn") rig.turn(dx, dy);
  else if (motion === "move") rig.move(dx, dy);
  else rig.zoom(1.006 ** dy, 0, 0);
}

/** The scheme in words: actions, and their buttons. */
export function schemeWords(scheme: Scheme): [string, string][] {
  const rows: [string, string][] = [];
  for (const [motion, title] of MOTIONS) {
    const ways = [...DRAGS[scheme], ...BESIDE]
      .filter((drag) => drag.does === motion)
      .map((drag) => (drag.held ? HELD_NAMES[drag.held] : "") + BUTTON_NAMES[drag.button]);
    if (ways.length > 0) rows.push([title, ways.join(", or ")]);
  }
  return rows;
}
