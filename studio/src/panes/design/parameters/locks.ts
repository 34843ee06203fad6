// Parameters that are locked: neither the form nor a study changes them. A lock belongs to this
// browser and not to the design, which others may want to change.
import { create } from "zustand";
import { keepAs, kept } from "../../../store/page";
import { useStudio } from "../../../store/studio";
import { toggleSweep } from "../../study/draft";

const KEY = "voxsoft.locks";

type Locks = Readonly<Record<string, readonly string[]>>;

const useLocks = create<{ readonly of: Locks }>(() => ({ of: kept<Locks>(KEY) as Locks }));

/** The document that locks are kept for. */
function currentDocument(): string {
  const document = useStudio.getState().document;
  return document?.path ?? document?.name ?? "";
}

/** Check if a parameter of the document is locked. */
export function useLocked(parameter: string): boolean {
  const document = useStudio((state) => state.document?.path ?? state.document?.name ?? "");
  return useLocks((locks) => locks.of[document]?.includes(parameter) ?? false);
}

/** Check once if it is locked, outside of React's drawing. */
export function isLocked(parameter: string): boolean {
  return useLocks.getState().of[currentDocument()]?.includes(parameter) ?? false;
}

/** Lock a parameter, and take it out of the study; or let it be changed again. */
export function lock(parameter: string, on: boolean): void {
  const document = currentDocument();
  const { [document]: before = [], ...others } = useLocks.getState().of;
  const names = before.filter((name) => name !== parameter);
  if (on) names.push(parameter);
  const of = names.length ? { ...others, [document]: names } : others;
  useLocks.setState({ of });
  keepAs(KEY, of);
  if (on) toggleSweep(parameter, false);
}
