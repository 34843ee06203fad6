// Pages of the documentation that lead by the hand, of which some begin with a robot of the screen.

const PAGES = "https://github.com/voxsoft/voxsoft/blob/main/docs/";

export interface Tutorial {
  readonly title: string;
  readonly about: string;
  readonly page: string;
}

export const TUTORIALS: readonly Tutorial[] = [
  { title: "Five minutes", about: "See something move", page: "start.md" },
  {
    title: "Work in the studio",
    about: "Build, press, cut and solve",
    page: "how-to/studio.md",
  },
  {
    title: "A PneuNet",
    about: "Chambers that touch, beside CalculiX",
    page: "tutorials/pneunet.md",
  },
  { title: "A trunk", about: "Four tendons and where they reach", page: "tutorials/trunk.md" },
  { title: "A gripper", about: "A pump, two valves and a can", page: "tutorials/gripper.md" },
  {
    title: "Calibrate a beam",
    about: "Constants from a photograph",
    page: "tutorials/calibrate-a-beam.md",
  },
];

export function addressOf(tutorial: Tutorial): string {
  return `${PAGES}${tutorial.page}`;
}
