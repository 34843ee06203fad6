// A table of numbers that was dropped or chosen goes to the pane that its columns are for.

import { addTable } from "../panes/calibrate/draft";
import { addTest } from "../panes/coupon/coupons";
import { addCurve } from "../panes/path/tables";
import type { ErrorEvent, TableUsesEvent } from "../protocol";
import { type Mode, usePage } from "../store/page";
import { ask } from "../store/session";
import { toast } from "../store/studio";
import { frontPanes, showPane } from "./actions";

/** Endings of tables. */
export const TABLES: readonly string[] = [".csv", ".tsv", ".txt"];

const LARGEST = 8_000_000;

/** Use of a table. */
type TableUse = TableUsesEvent["uses"][number];

interface Way {
  readonly pane: string;
  readonly mode: Mode;
  take(name: string, text: string): void;
}

const WAYS: Readonly<Record<TableUse, Way>> = {
  coupon: { pane: "coupon", mode: "calibrate", take: addTest },
  curve: { pane: "path", mode: "simulate", take: addCurve },
  stations: { pane: "calibrate", mode: "calibrate", take: addTable },
};

/** The wanted use where the table allows it, or that of a pane in front, or the likeliest one. */
export function chosenUse(
  uses: readonly TableUse[],
  front: readonly string[],
  wanted?: TableUse,
): TableUse | undefined {
  if (wanted && uses.includes(wanted)) return wanted;
  return uses.find((use) => front.includes(WAYS[use].pane)) ?? uses[0];
}

/** Bring a table to the pane that is for it. */
export async function takeTable(file: File, wanted?: TableUse): Promise<void> {
  if (file.size > LARGEST) {
    toast({
      level: "error",
      what: `${file.name} has ${Math.round(file.size / 1e6)} MB; a table has at most 8 MB`,
      hint: "Keep the rows that are needed only.",
    });
    return;
  }
  const text = await file.text();
  const found = await usesOf(file.name, text);
  const use = found && chosenUse(found, frontPanes(), wanted);
  if (!use) return;
  if (usePage.getState().sheet === "start") usePage.setState({ sheet: null });
  const way = WAYS[use];
  way.take(file.name, text);
  showPane(way.pane, way.mode);
}

/** Uses of a table by its columns; null with a message where it is none. */
async function usesOf(name: string, text: string): Promise<readonly TableUse[] | null> {
  try {
    const reply = await ask("/table", { name, text });
    const said: unknown = await reply.json();
    if (reply.ok) return (said as TableUsesEvent).uses;
    const { where = name, what = "", hint = "" } = said as Partial<ErrorEvent>;
    toast({ level: "error", what: `${where}: ${what}`, hint });
  } catch {
    toast({
      level: "error",
      what: `${name} could not be read`,
      hint: "VoxSoft does not answer; drop the file again when it does.",
    });
  }
  return null;
}
