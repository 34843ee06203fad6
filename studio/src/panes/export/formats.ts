// Formats of export, with the purpose of each.

import { WRITTEN } from "../../protocol";

export interface Format {
  readonly id: string;
  readonly title: string;
  readonly ending: string;
  readonly purpose: string;
  /** Made in this page from the view. */
  readonly here?: boolean;
  /** Asks for the unit of lengths, which the file itself cannot tell. */
  readonly asksUnit?: boolean;
  /** Can be written as the body was built, or as it is now. */
  readonly asksShape?: boolean;
  /** Moves where it is looked at. */
  readonly live?: boolean;
}

export const FORMATS: readonly Format[] = [
  ...Object.entries(WRITTEN).map(([ending, format]) => ({
    id: ending.slice(1),
    ending,
    ...format,
  })),
  {
    id: "molds",
    title: "Molds",
    ending: ".zip",
    purpose: "To cast the robot: parts to print, and a sheet that says how to mix, pour and bond.",
  },
  {
    id: "run",
    title: "Run folder",
    ending: ".zip",
    purpose: "To keep design, numbers and mesh together, so that anyone can repeat them.",
  },
  {
    id: "png",
    title: "Picture",
    ending: ".png",
    purpose: "For a paper or a slide: the view as it is, with its legend.",
    here: true,
  },
  {
    id: "html",
    title: "Live page",
    ending: ".html",
    purpose: "For people without VoxSoft: one file to turn, pull and inflate in any browser.",
    live: true,
  },
];

export const UNITS = ["mm", "cm", "m", "in"] as const;
export type Unit = (typeof UNITS)[number];

export interface Options {
  readonly unit: Unit | null;
  readonly shape: "rest" | "now";
  readonly scale: number;
}

/** Why a format cannot be written now, in words; null where it can. */
export function obstacle(
  format: Format,
  options: Options,
  open: boolean,
  refused: Readonly<Record<string, string>> = {},
): string | null {
  if (!open) return "Open a design first.";
  if (format.live && refused.page) return refused.page;
  if (format.asksUnit && options.unit === null) {
    return "Choose the unit: the file itself does not tell it.";
  }
  return null;
}

/** Request to the server. */
export function request(format: Format, options: Options): Record<string, unknown> {
  return {
    format: format.id,
    options: {
      ...(format.asksUnit ? { unit: options.unit } : {}),
      ...(format.asksShape ? { deformed: options.shape === "now" } : {}),
    },
  };
}
