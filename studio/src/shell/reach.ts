// Ways from a name to a control in a pane, for the palette: the pane comes to the front, and its
// control is pressed, or gets the focus where it wants a choice.

import { SHAPE_GROUPS } from "../panes/design/shapes/shapeKinds";
import { FORMATS } from "../panes/export/formats";
import { type Mode, setMode, usePage } from "../store/page";
import type { Action } from "./actions";

/** Longest time until a pane that is loaded now has drawn its controls, ms. */
const PATIENCE = 30_000;

/** The element of a selector, as soon as it is on the page; null where it does not come. */
function appears(selector: string): Promise<HTMLElement | null> {
  const find = () => document.querySelector<HTMLElement>(selector);
  const now = find();
  if (now) return Promise.resolve(now);
  return new Promise((resolve) => {
    const end = () => {
      watch.disconnect();
      clearTimeout(timer);
      resolve(find());
    };
    const watch = new MutationObserver(() => find() && end());
    const timer = setTimeout(end, PATIENCE);
    const root = document.documentElement;
    watch.observe(root, { childList: true, subtree: true, attributeFilter: ["data-layout"] });
  });
}

/** Press a button; a choice or a text field gets the focus. */
function use(control: HTMLElement): void {
  control.scrollIntoView({ block: "center" });
  control.focus();
  if (control instanceof HTMLButtonElement || control.role === "option") control.click();
}

interface Goal {
  readonly mode?: Mode;
  readonly pane: string;
  /** Selectors of the controls to press one after the other. */
  readonly press: readonly string[];
  readonly focusOnly?: boolean;
}

async function reach(goal: Goal, show: (pane: string) => void): Promise<void> {
  if (goal.mode && usePage.getState().mode !== goal.mode) {
    setMode(goal.mode);
    // A pane that is shown before belongs to the layout of the mode that is left.
    if (!(await appears(`html[data-layout=${goal.mode}]`))) return;
  }
  show(goal.pane);
  for (const selector of goal.press) {
    const control = await appears(selector);
    if (!control) return;
    if (goal.focusOnly) {
      control.scrollIntoView({ block: "center" });
      control.focus();
    } else use(control);
  }
}

/** Sections of the form, and other names for each. */
const ADDED: Readonly<Record<string, string>> = {
  "a parameter": "variable, slider",
  "a body": "assembly, second design, finger",
  "a material": "silicone, rubber, card",
  "a part": "solid",
  "a layer": "fabric, paper, sheet",
  "an object to grip": "rigid, ball, cube, obstacle",
  "a clamp": "support, fixture, fix, hold, boundary condition",
  "a load": "pressure, force, gravity, inflate, traction",
  "a history": "curve over time, ramp, schedule",
  "a floor": "ground, table",
  "a chamber": "cavity, air, inlet",
  "a probe": "marker, sensor, measure a displacement",
  "an objective": "goal, maximize, minimize, optimize",
  "a constraint": "limit, bound, at most, at least",
  "a supply": "pump, syringe, valve, flow",
  "a tendon": "cable, rope, wire",
  "a spring": "elastic",
  "a connection": "tube, hose between chambers",
  "a symmetry": "half, quarter, mirror plane",
  "an activation": "magnet, heat, swell, field",
};

const SHAPE_WORDS: Readonly<Record<string, string>> = {
  mirror: "reflect, halve",
  array: "repeat, pattern, linear, copies",
  "polar-array": "repeat around, circular pattern",
  difference: "cut, subtract, hole",
  union: "join, add",
  shell: "hollow, wall",
  offset: "thicken, grow, shrink",
  blend: "fillet, smooth join",
  revolve: "lathe, turn, profile",
  prism: "extrude, profile",
  mesh: "import STL, STEP, OBJ, 3MF, CAD file",
  bellows: "convolution, wave, actuator",
  fold: "convolution, joint",
  finger: "bending actuator",
  "chamber-row": "PneuNet, bending actuator",
};

/** Actions that lead to controls of the form and of other panes; `show` brings a pane to the front. */
export function reachActions(show: (pane: string) => void): Action[] {
  const action = (
    id: string,
    title: string,
    group: Action["group"],
    words: string,
    goal: Goal,
  ): Action => ({ id, title, group, words, run: () => void reach(goal, show) });
  const added = Object.entries(ADDED).map(([what, words]) =>
    action(`add-${what}`, `Add ${what}`, "Form", words, {
      mode: "design",
      pane: "design",
      press: [`[data-testid=design-form] [aria-label="Add ${what}"]`],
    }),
  );
  const shapes = SHAPE_GROUPS.flatMap(({ kinds }) => kinds).map((kind) =>
    action(`shape-${kind}`, `Add a shape: ${kind}`, "Form", SHAPE_WORDS[kind] ?? "", {
      mode: "design",
      pane: "design",
      press: ["[data-testid=add-shape]", `[data-testid=kind-${kind}]`],
    }),
  );
  const exports = FORMATS.map((format) =>
    action(
      `export-${format.id}`,
      `Export ${format.title.toLowerCase()} (${format.ending})`,
      "Export",
      `${format.id} ${format.purpose} save as, write, download`,
      {
        pane: "export",
        press: [`[data-testid=export-${format.id}] :is(select, button):enabled`],
        focusOnly: true,
      },
    ),
  );
  return [
    ...added,
    ...shapes,
    ...exports,
    action(
      "fit-coupons",
      "Fit a material to tensile tests",
      "Form",
      "tension, stress strain curve, CSV, specimen, dumbbell",
      {
        mode: "calibrate",
        pane: "coupon",
        press: [],
      },
    ),
    action(
      "fit-material",
      "Calibrate a material on a measured specimen",
      "Form",
      "fit, inverse, beam, markers, CSV, constants",
      {
        mode: "calibrate",
        pane: "calibrate",
        press: [],
      },
    ),
    action(
      "check-body",
      "Check the body: thinnest walls, cavities, volumes",
      "Form",
      "thickness, wall, leak, voxels",
      {
        mode: "design",
        pane: "body",
        press: [],
      },
    ),
    action(
      "vary",
      "Try many designs: vary parameters",
      "Form",
      "study, sweep, optimize, design of experiments",
      {
        mode: "optimize",
        pane: "study",
        press: [],
      },
    ),
  ];
}
