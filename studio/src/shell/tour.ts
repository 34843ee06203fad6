import { keepAs, kept, type Mode } from "../store/page";

export interface Step {
  readonly title: string;
  readonly text: string;
  readonly mode?: Mode;
}

export const STEPS: readonly Step[] = [
  {
    title: "A robot is a page of text",
    text: "Pick a template, or drop a .toml, .stl or .obj file on the page. The form and the text beside it are one document: change either, and the other follows.",
    mode: "design",
  },
  {
    title: "See what it is made of",
    text: "Turn the body by dragging beside it, zoom with the wheel, press F to fit. Color it by displacement, stretch or stress; cut it open with the section plane; look at voxels, tetrahedra and cavities.",
    mode: "design",
  },
  {
    title: "Let it move, and pull on it",
    text: "Space starts and stops time. Every load has a slider that works while time runs. Press on the body and drag: a spring pulls at that vertex, and its force is shown. R solves for the equilibrium and gives its numbers.",
    mode: "simulate",
  },
  {
    title: "Make it match your material",
    text: "Drop a table of measured points: the constants of the material are fitted to them, with measured and simulated shapes over each other, and the result tells which constants the data really fix.",
    mode: "calibrate",
  },
  {
    title: "Let it search, and take the result away",
    text: "Choose parameters, goals and a budget; click any point of a plot to open that design. It goes on when the page is closed, and Runs keeps all of it. Export gives STL, VTU, CSV, pictures, or a live page that needs no VoxSoft.",
    mode: "optimize",
  },
  {
    title: "Cast it",
    text: "Make writes printed molds, cores and plates for the robot, with a sheet: grams of both components, pot life, each step with a picture, and the proofs that the molds come apart and hold no air.",
    mode: "make",
  },
];

const KEY = "voxsoft.tour";

export function wantsTour(): boolean {
  return kept<{ seen: boolean }>(KEY).seen !== true;
}

export function tourSeen(): void {
  keepAs(KEY, { seen: true });
}
