// Studies that are being set up, one for each document; kept between visits.
import { create } from "zustand";
import type { DocumentEvent } from "../../protocol";
import { keepAs, kept } from "../../store/page";
import { useStudio } from "../../store/studio";

export interface Sweep {
  readonly low: number;
  readonly high: number;
  readonly step: number | null;
  readonly log: boolean;
}

export interface StudyDraft {
  readonly name: string;
  /** Null until one is chosen by hand. */
  readonly sampler: string | null;
  readonly budget: number;
  readonly workers: number | null;
  readonly seed: number;
  /** Parameters that were switched on or off by hand; the others follow the design. */
  readonly chosen: Readonly<Record<string, boolean>>;
  /** Ranges that differ from those of the design. */
  readonly ranges: Readonly<Record<string, Partial<Sweep>>>;
}

/** Drafts by document, the one that was changed last at the end. */
type Drafts = Readonly<Record<string, StudyDraft>>;

const NEW: StudyDraft = {
  name: "",
  sampler: null,
  budget: 60,
  workers: null,
  seed: 0,
  chosen: {},
  ranges: {},
};
const KEY = "voxsoft.studies";
/** Documents whose drafts are kept. */
const MOST = 30;

const useDrafts = create<{ drafts: Drafts }>(() => ({ drafts: kept<Drafts>(KEY) as Drafts }));

/** Name of a document among the drafts. */
function keyOf(document: DocumentEvent | null): string {
  return document?.id ?? "";
}

/** The draft of the open document. */
export function useStudyDraft(): StudyDraft {
  const key = useStudio((state) => keyOf(state.document));
  return useDrafts(({ drafts }) => drafts[key]) ?? NEW;
}

/** Change the draft of the open document. */
export function changeDraft(change: (draft: StudyDraft) => Partial<StudyDraft>): void {
  const key = keyOf(useStudio.getState().document);
  const { [key]: before, ...others } = useDrafts.getState().drafts;
  const draft = before ?? NEW;
  const all = Object.entries({ ...others, [key]: { ...draft, ...change(draft) } });
  const drafts = Object.fromEntries(all.slice(-MOST));
  useDrafts.setState({ drafts });
  keepAs(KEY, drafts);
}

export function toggleSweep(parameter: string, on: boolean): void {
  changeDraft((draft) => ({ chosen: { ...draft.chosen, [parameter]: on } }));
}

export function changeRange(parameter: string, change: Partial<Sweep>): void {
  changeDraft((draft) => ({
    ranges: { ...draft.ranges, [parameter]: { ...draft.ranges[parameter], ...change } },
  }));
}
