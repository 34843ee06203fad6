// Molds that were made last, and the options for the next ones. Kept while the page is there.
import { create } from "zustand";
import type { ErrorEvent, MoldsEvent } from "../../protocol";
import { showPane } from "../../shell/actions";
import { usePage } from "../../store/page";
import { ask } from "../../store/session";
import { toast } from "../../store/studio";

/** Limits of the printer that the pane asks for, as text with units; empty for those of the design. */
export interface PrinterLimits {
  readonly wall: string;
  readonly tube: string;
  readonly draft: string;
  readonly volume: string;
}

export interface MoldOptions {
  /** Way to take; empty for the first that the shape allows. */
  readonly way: string;
  /** Body of a design with several. */
  readonly body: string;
  readonly shrinkage: string;
  readonly printer: PrinterLimits;
}

interface Making {
  options: MoldOptions;
  /** True while the server makes molds. */
  busy: boolean;
  made: MoldsEvent | null;
  /** Id of the document of which they were made. */
  of: string;
}

export const useMaking = create<Making>(() => ({
  options: {
    way: "",
    body: "",
    shrinkage: "",
    printer: { wall: "", tube: "", draft: "", volume: "" },
  },
  busy: false,
  made: null,
  of: "",
}));

export function choose(change: Partial<MoldOptions>): void {
  useMaking.setState(({ options }) => ({ options: { ...options, ...change } }));
}

/** Request to the server. */
export function request(options: MoldOptions): Record<string, unknown> {
  const { volume, ...limits } = options.printer;
  const sides = volume === "" ? null : volume.split(",").map((side) => side.trim());
  return { ...options, printer: { ...limits, volume: sides } };
}

/** Make molds of the document as it stands; a press while they are made does nothing. */
export async function makeMolds(of: string): Promise<void> {
  if (useMaking.getState().busy) return;
  useMaking.setState({ busy: true });
  try {
    const reply = await ask("/molds", request(useMaking.getState().options));
    const said: unknown = await reply.json().catch(() => null);
    if (!reply.ok) {
      const problem = said as Partial<ErrorEvent> | null;
      const what = problem?.what ?? `Molds could not be made (${reply.status})`;
      toast({
        level: "error",
        what: problem?.where ? `${problem.where}: ${what}` : what,
        hint: problem?.hint ?? "",
      });
      return;
    }
    const made = said as MoldsEvent;
    useMaking.setState({ made, of });
    if (made.sheet && usePage.getState().mode === "make") showPane("sheet");
  } catch {
    toast({
      level: "error",
      what: "Molds could not be made",
      hint: "VoxSoft does not answer; try again when it does.",
    });
  } finally {
    useMaking.setState({ busy: false });
  }
}
