// State of this page alone: mode, theme, open sheets. Kept between visits; the mode
// stands in the address, so that a reload or a copied address shows the same.
import { create } from "zustand";
import type { OpenCommand } from "../protocol";
import { finishTyping } from "./typing";

export const MODES = ["design", "simulate", "calibrate", "optimize", "make", "runs"] as const;
export type Mode = (typeof MODES)[number];

export const MODE_TITLES: Readonly<Record<Mode, string>> = {
  design: "Design",
  simulate: "Simulate",
  calibrate: "Calibrate",
  optimize: "Optimize",
  make: "Make",
  runs: "Runs",
};

export type ThemeChoice = "system" | "dark" | "light";
export type Sheet =
  | "start"
  | "palette"
  | "shortcuts"
  | "tour"
  | "save"
  | "versions"
  | "discard"
  | "remove"
  | "import"
  | null;

/** File to be opened once the open design has been saved or given up. */
export type Pending = Pick<OpenCommand, "t" | "what" | "name" | "mesh">;

export interface Page {
  mode: Mode;
  theme: ThemeChoice;
  sheet: Sheet;
  pending: Pending | null;
  /** The study or calibration that the panes speak of. */
  job: string | null;
}

const KEY = "voxsoft.page";

function readAddress(): Partial<Page> {
  const given = new URLSearchParams(globalThis.location?.hash.slice(1) ?? "");
  const mode = given.get("mode") as Mode | null;
  const job = given.get("job");
  return {
    ...(mode && MODES.includes(mode) ? { mode } : {}),
    ...(job ? { job } : {}),
  };
}

/** State kept under `key`, or an empty object where nothing readable was. */
export function kept<T extends object>(key: string): Partial<T> {
  try {
    const value: unknown = JSON.parse(localStorage.getItem(key) ?? "{}");
    return typeof value === "object" && value !== null ? (value as Partial<T>) : {};
  } catch {
    return {}; // storage is switched off, or holds something else
  }
}

export function keepAs(key: string, value: unknown): void {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch {
    // storage is switched off or full: the page works without its memory
  }
}

export const usePage = create<Page>(() => ({
  mode: "design",
  theme: "system",
  sheet: null,
  pending: null,
  job: null,
  ...kept<Pick<Page, "theme">>(KEY),
  ...readAddress(),
}));

export function setMode(mode: Mode): void {
  finishTyping();
  usePage.setState({ mode });
}

/** Choose the study or calibration of which the panes speak. */
export function setJob(job: string | null): void {
  usePage.setState({ job });
}

export function openSheet(sheet: Sheet, pending: Pending | null = null): void {
  usePage.setState({ sheet, pending });
}

/** The theme that is in force. */
export function themeInForce(choice: ThemeChoice): "dark" | "light" {
  if (choice !== "system") return choice;
  return matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
}

/** Keep the theme in step with the store and the system; called once. */
export function watchTheme(): void {
  const show = ({ theme }: Page) => {
    document.documentElement.dataset.theme = themeInForce(theme);
    keepAs(KEY, { theme });
  };
  show(usePage.getState());
  usePage.subscribe(show);
  matchMedia("(prefers-color-scheme: light)").addEventListener("change", () =>
    show(usePage.getState()),
  );
}

/** Keep the address in step with the store; called once. */
export function watchAddress(): void {
  const show = (page: Page) => {
    const hash = `#${new URLSearchParams({ mode: page.mode, ...(page.job ? { job: page.job } : {}) })}`;
    if (location.hash !== hash) history.replaceState(null, "", hash);
  };
  show(usePage.getState());
  usePage.subscribe(show);
  addEventListener("hashchange", () => usePage.setState(readAddress()));
}
