// The study that is being set up; kept in this page until another document is open.
import { create } from "zustand";
import { onAnotherDocument } from "../../store/another";

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

export const useStudyDraft = create<StudyDraft>(() => ({
  name: "",
  sampler: null,
  budget: 60,
  workers: null,
  seed: 0,
  chosen: {},
  ranges: {},
}));

// Another design may have parameters of the same names.
onAnotherDocument(() => useStudyDraft.setState({ name: "", chosen: {}, ranges: {} }));

export function toggleSweep(parameter: string, on: boolean): void {
  useStudyDraft.setState((draft) => ({ chosen: { ...draft.chosen, [parameter]: on } }));
}

export function changeRange(parameter: string, change: Partial<Sweep>): void {
  useStudyDraft.setState((draft) => ({
    ranges: { ...draft.ranges, [parameter]: { ...draft.ranges[parameter], ...change } },
  }));
}
