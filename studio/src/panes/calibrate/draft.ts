// The calibration that is being set up: tables that were dropped, and constants to fit.
import { create } from "zustand";
import type { ColumnMap } from "../../protocol";
import { onAnotherDocument } from "../../store/another";
import { send } from "../../store/session";

export interface MeasuredFile {
  readonly name: string;
  readonly text: string;
  /** Columns as mapped by hand; null while VoxSoft guesses. */
  readonly columns: readonly ColumnMap[] | null;
  readonly select: string | null;
}

export interface Bound {
  readonly on: boolean;
  /** SI; null: the usual range. */
  readonly low: number | null;
  readonly high: number | null;
}

export interface CalibrateDraft {
  readonly files: readonly MeasuredFile[];
  readonly name: string;
  readonly method: string;
  readonly generations: number;
  readonly population: number;
  readonly seed: number;
  readonly freeScale: boolean;
  readonly refine: boolean;
  readonly identify: boolean;
  /** Ranges of constants that differ from the usual ones, by constant. */
  readonly bounds: Readonly<Record<string, Bound>>;
}

export const useCalibrateDraft = create<CalibrateDraft>(() => ({
  files: [],
  name: "",
  method: "genetic",
  generations: 50,
  population: 30,
  seed: 0,
  freeScale: false,
  refine: true,
  identify: true,
  bounds: {},
}));

// Measured tables stay for the next specimen; the name and the ranges are of the one before.
onAnotherDocument(() => useCalibrateDraft.setState({ name: "", bounds: {} }));

function ask(file: MeasuredFile): void {
  send({
    t: "measurement",
    name: file.name,
    text: file.text,
    columns: file.columns === null ? null : [...file.columns],
    select: file.select,
  });
}

/** Send all tables again, as after the server was started anew. */
export function askAgain(): void {
  for (const file of useCalibrateDraft.getState().files) ask(file);
}

/** Take a table of measurements; its columns are guessed first. */
export function addTable(name: string, text: string): void {
  const file: MeasuredFile = { name, text, columns: null, select: null };
  useCalibrateDraft.setState((draft) => ({
    files: [...draft.files.filter((one) => one.name !== name), file],
  }));
  ask(file);
}

export function removeFile(name: string): void {
  useCalibrateDraft.setState((draft) => ({
    files: draft.files.filter((file) => file.name !== name),
  }));
}

export function changeFile(
  name: string,
  change: Partial<Pick<MeasuredFile, "columns" | "select">>,
): void {
  const { files } = useCalibrateDraft.getState();
  const next = files.map((file) => (file.name === name ? { ...file, ...change } : file));
  useCalibrateDraft.setState({ files: next });
  const changed = next.find((file) => file.name === name);
  if (changed) ask(changed);
}
