// The part that the materials browser chooses for, and the way there.
import { create } from "zustand";
import { showPane } from "../../shell/actions";

/** The index of the part, where one was asked for. */
export const useWanted = create<{ readonly part: number | null }>(() => ({ part: null }));

/** Show the browser, to choose for a part where one is named. */
export function browseMaterials(part: number | null = null): void {
  if (part !== null) useWanted.setState({ part });
  showPane("materials");
}
