// The one viewport of the page. It outlives layouts: panes come and go, the picture stays.

import { provideHook } from "../hook";
import { type Action, provideViewActions } from "../shell/actions";
import { setView, useView } from "../store/view";
import type { StandardView } from "./drawing/camera";
import { SCHEMES } from "./hands/schemes";
import { savePicture } from "./recorder";
import { Viewport } from "./viewport";

const STANDARD: readonly [StandardView, string, string][] = [
  ["front", "Front view", "1"],
  ["back", "Back view", "2"],
  ["left", "Left view", "3"],
  ["right", "Right view", "4"],
  ["top", "Top view", "5"],
  ["bottom", "Bottom view", "6"],
  ["corner", "Corner view", "7"],
];

let view: Viewport | null = null;

export function viewport(): Viewport {
  if (!view) {
    view = new Viewport();
    provideViewActions(actions(view));
    provideHook();
  }
  return view;
}

type Flag =
  | "edges"
  | "ghost"
  | "symbols"
  | "cavities"
  | "extremes"
  | "grid"
  | "orthographic"
  | "tape";

function toggle(flag: Flag): void {
  setView({ [flag]: !useView.getState()[flag] });
}

function actions(shown: Viewport): Action[] {
  const flags: [Flag, string, string?][] = [
    ["edges", "Voxel edges", "e"],
    ["ghost", "Undeformed ghost", "g"],
    ["cavities", "Look into the cavities", "c"],
    ["symbols", "Clamps, layers, loads, probes"],
    ["extremes", "Mark minimum and maximum"],
    ["grid", "Ground grid"],
    ["orthographic", "Orthographic view", "o"],
    ["tape", "Measuring tape", "m"],
  ];
  return [
    {
      id: "fit",
      title: "Fit the body into the view",
      group: "View",
      keys: ["f"],
      run: () => shown.fit(),
    },
    {
      id: "section",
      title: "Section plane",
      group: "View",
      keys: ["x"],
      run: () => shown.toggleSection(),
    },
    ...STANDARD.map(
      ([name, title, key]): Action => ({
        id: `look-${name}`,
        title,
        group: "View",
        keys: [key],
        run: () => shown.look(name),
      }),
    ),
    ...flags.map(
      ([flag, title, key]): Action => ({
        id: `view-${flag}`,
        title,
        group: "View",
        ...(key ? { keys: [key] } : {}),
        run: () => toggle(flag),
      }),
    ),
    ...SCHEMES.map(
      ({ value, label }): Action => ({
        id: `mouse-${value}`,
        title: `Mouse as in ${label}`,
        group: "View",
        run: () => setView({ scheme: value }),
      }),
    ),
    ...[1, 2, 4].map(
      (scale): Action => ({
        id: `picture-${scale}`,
        title: `Save a picture${scale > 1 ? ` at ${scale} times the size` : ""}`,
        group: "View",
        run: () => void savePicture(shown, scale),
      }),
    ),
  ];
}
