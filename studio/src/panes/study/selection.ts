// Pointed, marked and brushed trials; all plots of a study show the same.

import { create } from "zustand";
import { showPane } from "../../shell/actions";
import { send } from "../../store/session";
import { openHere } from "../design/edits";
import type { Brushes } from "./trials";

export interface Selection {
  readonly job: string | null;
  readonly hovered: number | null;
  /** Trials to set side by side, two at most. */
  readonly pinned: readonly number[];
  /** The trial that the view shows. */
  readonly opened: number | null;
  /** The trial that the atlas tells more of. */
  readonly selected: number | null;
  readonly brushes: Brushes;
}

const NOTHING = { hovered: null, pinned: [], opened: null, selected: null, brushes: {} } as const;

export const useSelection = create<Selection>(() => ({ job: null, ...NOTHING }));

/** Forget the marks of another study. */
export function attend(job: string | null): void {
  if (useSelection.getState().job !== job) useSelection.setState({ job, ...NOTHING });
}

export function hover(trial: number | null): void {
  if (useSelection.getState().hovered !== trial) useSelection.setState({ hovered: trial });
}

export function brush(key: string, stretch: readonly [number, number] | null): void {
  useSelection.setState((state) => {
    const { [key]: _, ...others } = state.brushes;
    return { brushes: stretch ? { ...others, [key]: stretch } : others };
  });
}

export function clearBrushes(): void {
  useSelection.setState({ brushes: {} });
}

/** Mark a trial for comparing, or take the mark away; the third one replaces the first. */
export function pin(trial: number): void {
  useSelection.setState((state) => ({
    pinned: state.pinned.includes(trial)
      ? state.pinned.filter((one) => one !== trial)
      : [...state.pinned, trial].slice(-2),
  }));
}

/** Show the design of a trial in the view, or mark it where `mark` is set; the study goes on. */
export function choose(job: string, trial: number, mark: boolean): void {
  if (mark) {
    pin(trial);
    return;
  }
  useSelection.setState({ opened: trial });
  openHere("trial", `${job}/${trial}`);
}

/** Tell more of a trial, or mark it where `mark` is set. */
export function select(trial: number | null, mark = false): void {
  if (mark && trial !== null) pin(trial);
  else useSelection.setState({ selected: trial });
}

/** Write the parameters of a trial into the open design, which undo takes back as one step. */
export function take(job: string, trial: number): void {
  send({ t: "take", trial: `${job}/${trial}` });
}

export function comparePinned(job: string): void {
  const [a, b] = useSelection.getState().pinned;
  if (a === undefined || b === undefined) return;
  send({ t: "compare", a: `${job}/${a}`, b: `${job}/${b}` });
  showPane("compare");
}
