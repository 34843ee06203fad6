// Options of the view of the body. Kept between visits; nothing here needs a round trip but the field
// and the change between surface and tetrahedra.
import { create } from "zustand";
import type { ColormapName } from "../view/body/colormaps";
import type { Clipped } from "../view/body/colorRange";
import type { Scheme } from "../view/hands/schemes";
import type { ChosenAppearance } from "./appearance";
import { keepAs, kept } from "./page";

export type Coloring = "field" | "parts";
export type RangeMode = "auto" | "locked" | "symmetric";
/** Across an axis, or in the direction that `sectionNormal` has. */
export type SectionAxis = "off" | "x" | "y" | "z" | "free";

export interface View {
  appearance: ChosenAppearance;
  coloring: Coloring;
  field: number;
  colormap: ColormapName;
  /** Flat steps of the color map; 0 for a smooth one. */
  bands: number;
  range: RangeMode;
  /** Limits of a locked range, in the field's SI unit. */
  low: number;
  high: number;
  edges: boolean;
  ghost: boolean;
  symbols: boolean;
  /** Arrows for forces of contact. */
  forces: boolean;
  cavities: boolean;
  extremes: boolean;
  grid: boolean;
  orthographic: boolean;
  exaggeration: number;
  section: SectionAxis;
  /** Place of the section, as a share of the body's bounds. */
  sectionAt: number;
  sectionFlipped: boolean;
  sectionNormal: readonly [number, number, number];
  tape: boolean;
  /** Which buttons of the mouse steer the camera. */
  scheme: Scheme;
  /** The rigid object that is chosen in the form or the picture. */
  chosen: string | null;
  /** The shape that is chosen instead. */
  shape: string | null;
  /** Spring by which the mouse pulls, N/m. */
  stiffness: number;
}

const KEY = "voxsoft.view";
// Lasting taste is kept; options of one body are not.
const KEPT = [
  "colormap",
  "bands",
  "edges",
  "symbols",
  "forces",
  "grid",
  "orthographic",
  "scheme",
  "stiffness",
] as const;

export const useView = create<View>(() => ({
  appearance: "auto",
  coloring: "field",
  field: 0,
  colormap: "viridis",
  bands: 0,
  range: "auto",
  low: 0,
  high: 1,
  edges: true,
  ghost: false,
  symbols: true,
  forces: true,
  cavities: false,
  extremes: false,
  grid: true,
  orthographic: false,
  exaggeration: 1,
  section: "off",
  sectionAt: 0.5,
  sectionFlipped: false,
  sectionNormal: [0, 0, 1],
  tape: false,
  scheme: "voxsoft",
  chosen: null,
  shape: null,
  stiffness: 50,
  ...kept<View>(KEY),
}));

useView.subscribe((view) => {
  keepAs(KEY, Object.fromEntries(KEPT.map((key) => [key, view[key]])));
});

export function setView(change: Partial<View>): void {
  // One thing is chosen at a time.
  const one = change.chosen ? { shape: null } : change.shape ? { chosen: null } : {};
  useView.setState({ ...one, ...change });
}

/** State of the view for the panes, a few times a second: drawn content, not its form. */
export interface Shown {
  frame: number;
  time: number;
  fps: number;
  /** Milliseconds from a command to the first picture that knows of it. */
  latency: number | null;
  /** The field that the frame is colored by. */
  field: number;
  /** Range of colors, and that of the values in the frame, SI. */
  low: number;
  high: number;
  min: number;
  max: number;
  /** Values beyond the colors. */
  clipped: readonly Clipped[];
  /** Length of a newton in arrows of contact forces, m; 0 where there are none. */
  forceScale: number;
  /** Length of the scale bar: meters, and pixels. */
  barLength: number;
  barPixels: number;
  diverged: boolean;
  tapeLength: number | null;
  hover: { x: number; y: number; vertex: number; value: number } | null;
  recording: "webm" | "gif" | null;
}

export const useShown = create<Shown>(() => ({
  frame: 0,
  time: 0,
  fps: 0,
  latency: null,
  field: 0,
  low: 0,
  high: 1,
  min: 0,
  max: 1,
  clipped: [],
  forceScale: 0,
  barLength: 0,
  barPixels: 0,
  diverged: false,
  tapeLength: null,
  hover: null,
  recording: null,
}));
