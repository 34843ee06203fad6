// Removes an entry: at once, or after a question where others depend on it.
import { create } from "zustand";
import { openSheet } from "../../../store/page";
import { useStudio } from "../../../store/studio";
import { edit, type Path } from "../edits";
import { type Removal, removalOf } from "./removal";

interface Asked {
  /** The entry, as the form calls it. */
  readonly name: string;
  readonly removal: Removal | null;
}

/** Removal that is asked about. */
export const useRemoving = create<Asked>(() => ({ name: "", removal: null }));

/** Remove an entry of the design; where others go along or change, ask first. */
export function remove(path: Path, name: string): void {
  const removal = removalOf(useStudio.getState().document?.source ?? {}, path);
  if (removal.along.length + removal.kept.length === 0) {
    edit(path, null);
    return;
  }
  useRemoving.setState({ name, removal });
  openSheet("remove");
}
