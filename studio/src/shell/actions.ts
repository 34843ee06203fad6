// Every action with a name: the palette lists them, keys start them, the help sheet shows them.

import { nextPace } from "../engine/pace";
import { EMPTY } from "../panes/design/empty";
import { newestFilm, toggleFilm } from "../run/film";
import {
  MODE_TITLES,
  MODES,
  type Mode,
  openSheet,
  type Pending,
  setMode,
  type ThemeChoice,
  usePage,
} from "../store/page";
import { send } from "../store/session";
import { showAskedPace, useStudio } from "../store/studio";
import { setView } from "../store/view";
import { reachActions } from "./reach";

export interface Action {
  readonly id: string;
  readonly title: string;
  readonly group:
    | "Document"
    | "Simulation"
    | "View"
    | "Form"
    | "Export"
    | "Panes"
    | "Page"
    | "Templates";
  /** Other words for it, by which it is found too. */
  readonly words?: string;
  /** Such as "Ctrl+K", "Shift+ArrowRight", "f". */
  readonly keys?: readonly string[];
  readonly hint?: string;
  run(): void;
}

export interface DockActions {
  readonly panes: readonly { readonly id: string; readonly title: string }[];
  /** Bring a pane to the front, in another mode if one is named. */
  show(id: string, mode?: Mode): void;
  /** Panes that are seen. */
  front(): readonly string[];
  reset(): void;
}

let viewActions: readonly Action[] = [];
let dock: DockActions | null = null;

/** The view brings its own actions when it is loaded. */
export function provideViewActions(actions: readonly Action[]): void {
  viewActions = actions;
}

/** The dock brings its panes; a page without one has none to show. */
export function provideDock(actions: DockActions): void {
  dock = actions;
}

/** Bring a pane to the front, in another mode if one is named. */
export function showPane(id: string, mode?: Mode): void {
  dock?.show(id, mode);
}

/** Panes that are seen. */
export function frontPanes(): readonly string[] {
  return dock?.front() ?? [];
}

export function togglePlay(): void {
  const { stat, body, moments } = useStudio.getState();
  const state = stat?.state;
  // Time does not run for a body that may touch something: the solved motion is shown again.
  if (body?.not_live && newestFilm(moments).length > 1) {
    toggleFilm();
    return;
  }
  send({ t: state === "playing" ? "pause" : "play" });
}

/** Move by `count` frames: through stored ones where a past one is shown, else forward in time. */
export function stepFrames(count: number): void {
  const stat = useStudio.getState().stat;
  if (!stat) return;
  const live = !useStudio.getState().body?.not_live;
  if (live && stat.state !== "past" && count > 0) {
    send({ t: "step", n: count });
    return;
  }
  const next = Math.min(stat.last_frame, Math.max(stat.first_frame, stat.frame + count));
  send({ t: "seek", frame: next });
}

/** Show time slower by a step of 1, or faster by one of −1. */
function changePace(steps: number): void {
  const stat = useStudio.getState().stat;
  if (!stat) return;
  choosePace(nextPace(stat.pace, steps));
}

/** Show time at a pace, or with null as fast as the motion can be seen. */
export function choosePace(factor: number | null): void {
  // Two quick presses are two steps, though the first was not answered yet.
  if (send({ t: "pace", factor }) > 0) showAskedPace(factor);
}

export function setTheme(theme: ThemeChoice): void {
  usePage.setState({ theme });
}

export function save(): void {
  const document = useStudio.getState().document;
  if (!document) return;
  if (document.path) send({ t: "save" });
  else openSheet("save");
}

function simple(): Action[] {
  return [
    { id: "save", title: "Save the design", group: "Document", keys: ["Ctrl+S"], run: save },
    {
      id: "save-as",
      title: "Save the design as…",
      group: "Document",
      keys: ["Ctrl+Shift+S"],
      run: () => useStudio.getState().document && openSheet("save"),
    },
    {
      id: "versions",
      title: "Versions of the design: look at them, restore one…",
      group: "Document",
      run: () => useStudio.getState().document && openSheet("versions"),
    },
    {
      id: "start",
      title: "Start screen: new, open, recent, finished robots",
      group: "Document",
      keys: ["Ctrl+O"],
      run: () => openSheet("start"),
    },
    {
      id: "undo",
      title: "Undo",
      group: "Document",
      keys: ["Ctrl+Z"],
      run: () => send({ t: "undo" }),
    },
    {
      id: "redo",
      title: "Redo",
      group: "Document",
      keys: ["Ctrl+Shift+Z", "Ctrl+Y"],
      run: () => send({ t: "redo" }),
    },
    { id: "play", title: "Play or pause", group: "Simulation", keys: [" "], run: togglePlay },
    {
      id: "step",
      title: "One frame forward",
      group: "Simulation",
      keys: ["ArrowRight"],
      run: () => stepFrames(1),
    },
    {
      id: "back",
      title: "One frame back",
      group: "Simulation",
      keys: ["ArrowLeft"],
      run: () => stepFrames(-1),
    },
    {
      id: "step10",
      title: "Ten frames forward",
      group: "Simulation",
      keys: ["Shift+ArrowRight"],
      run: () => stepFrames(10),
    },
    {
      id: "back10",
      title: "Ten frames back",
      group: "Simulation",
      keys: ["Shift+ArrowLeft"],
      run: () => stepFrames(-10),
    },
    {
      id: "slower",
      title: "Show time slower",
      group: "Simulation",
      keys: [",", "<"],
      run: () => changePace(1),
    },
    {
      id: "faster",
      title: "Show time faster",
      group: "Simulation",
      keys: [".", ">"],
      run: () => changePace(-1),
    },
    {
      id: "pace-auto",
      title: "Show time as fast as the motion can be seen",
      group: "Simulation",
      run: () => choosePace(null),
    },
    {
      id: "live",
      title: "Back to the present",
      group: "Simulation",
      keys: ["l"],
      run: () => send({ t: "live" }),
    },
    {
      id: "reset",
      title: "Back to the unloaded shape",
      group: "Simulation",
      keys: ["0"],
      run: () => send({ t: "reset" }),
    },
    {
      id: "rest",
      title: "Solve for the equilibrium",
      group: "Simulation",
      keys: ["r"],
      run: () => send({ t: "rest" }),
    },
    {
      id: "cancel",
      title: "Cancel solving",
      group: "Simulation",
      keys: ["Escape"],
      run: () => useStudio.getState().stat?.state === "solving" && send({ t: "pause" }),
    },
    {
      id: "palette",
      title: "Find an action",
      group: "Page",
      keys: ["Ctrl+K", "Ctrl+Shift+P"],
      run: () => openSheet("palette"),
    },
    {
      id: "shortcuts",
      title: "Help: keyboard shortcuts",
      group: "Page",
      keys: ["?"],
      run: () => openSheet("shortcuts"),
    },
    { id: "tour", title: "Help: take the tour", group: "Page", run: () => openSheet("tour") },
    {
      id: "layout",
      title: "Reset the layout of this mode",
      group: "Page",
      run: () => dock?.reset(),
    },
    { id: "theme-dark", title: "Dark theme", group: "Page", run: () => setTheme("dark") },
    { id: "theme-light", title: "Light theme", group: "Page", run: () => setTheme("light") },
    {
      id: "theme-system",
      title: "Theme of the system",
      group: "Page",
      run: () => setTheme("system"),
    },
  ];
}

const ALONE = new Set([
  ...["play", "step", "back", "step10", "back10", "live", "reset"],
  ...["slower", "faster", "pace-auto"],
  ...["palette", "shortcuts", "theme-dark", "theme-light", "theme-system"],
]);

/** All actions that make sense now. */
export function actions(): Action[] {
  const modes = MODES.map(
    (mode, i): Action => ({
      id: `mode-${mode}`,
      title: `Go to ${MODE_TITLES[mode]}`,
      group: "Page",
      keys: [`Alt+${i + 1}`],
      run: () => setMode(mode),
    }),
  );
  const panes = (dock?.panes ?? []).map(
    (pane): Action => ({
      id: `pane-${pane.id}`,
      title: `Show ${pane.title}`,
      group: "Panes",
      run: () => dock?.show(pane.id),
    }),
  );
  const templates = [EMPTY, ...(useStudio.getState().hello?.templates ?? [])].map(
    (template): Action => ({
      id: `template-${template.name}`,
      title: `New from template: ${template.title}`,
      group: "Templates",
      run: () => openDocument({ t: "open", what: "template", name: template.name }),
    }),
  );
  // A page that runs by itself has a body and time, and no document, modes or panes.
  if (!dock) return [...simple().filter((one) => ALONE.has(one.id)), ...viewActions];
  return [
    ...simple(),
    ...neighbors(),
    ...viewActions,
    ...reachActions(showPane),
    ...modes,
    ...panes,
    ...templates,
  ];
}

/** Ways to the documents with unsaved changes that were open before and after this one. */
function neighbors(): Action[] {
  const { before, after } = useStudio.getState().document ?? {};
  const lead = (way: "undo" | "redo", title: string): Action => ({
    id: `beyond-${way}`,
    title,
    group: "Document",
    run: () => send({ t: way, beyond: true }),
  });
  return [
    ...(before ? [lead("undo", `Back to ${before}, which was open before`)] : []),
    ...(after ? [lead("redo", `On to ${after}, which was open after this`)] : []),
  ];
}

/** Open a document; where it takes the place of edited work, that is asked first. */
export function openDocument(draft: Pending): void {
  const edited = useStudio.getState().document?.dirty ?? false;
  // Runs and designs of studies are looked at one after the other: a way back stays from those.
  const asks = ["template", "robot", "start", "file", "upload", "unsaved"].includes(draft.what);
  if (edited && asks) openSheet("discard", draft);
  else openNow(draft);
}

/** Open a document without asking. */
export function openNow(draft: Pending): void {
  setView({ shape: null }); // another design may have one of the same name
  if (draft.what === "template" && draft.name === EMPTY.name) setMode("design");
  send(draft);
}

/** The name of a key press as actions spell it, such as "Ctrl+Shift+Z". */
function keyName(
  event: Pick<KeyboardEvent, "key" | "code" | "ctrlKey" | "metaKey" | "altKey" | "shiftKey">,
): string {
  const digit = event.altKey && /^Digit\d$/.test(event.code) ? event.code.slice(5) : null;
  const key =
    digit ?? (event.key.length === 1 && event.ctrlKey ? event.key.toUpperCase() : event.key);
  const single = key.length === 1 && !event.ctrlKey && !event.metaKey && !event.altKey;
  return [
    event.ctrlKey || event.metaKey ? "Ctrl+" : "",
    event.altKey ? "Alt+" : "",
    // A single character says by itself whether Shift was held.
    event.shiftKey && !single ? "Shift+" : "",
    key,
  ].join("");
}

// The button that has the focus from a click. Browsers show the focus of such a button once a key
// is pressed, so :focus-visible does not tell it from one that was reached by keyboard.
let clicked: Element | null = null;

/** Check if a key belongs to the element that has the focus, and not to the page. */
function ownsKey(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target.closest(".cm-editor")) return true;
  if (target instanceof HTMLButtonElement) {
    // After a click Space is the page's, as if the button had never had the focus.
    return key === "Enter" || (key === " " && target !== clicked);
  }
  if (target instanceof HTMLInputElement) {
    if (target.type === "range") return key !== " ";
    return target.type !== "checkbox" || key === " ";
  }
  return target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement;
}

/** Start actions by their keys, wherever the focus is outside of text fields. */
export function listenForKeys(): () => void {
  const onKey = (event: KeyboardEvent) => {
    const name = keyName(event);
    const owned = ownsKey(event.target, event.key);
    const global = ["Ctrl+K", "Ctrl+O", "Ctrl+S", "Ctrl+Shift+S", "Ctrl+Shift+P"].includes(name);
    if (owned && !global) return;
    if (usePage.getState().sheet !== null && !global) return;
    const action = actions().find((one) => one.keys?.includes(name));
    if (!action) return;
    event.preventDefault();
    action.run();
  };
  const onPointerDown = (event: PointerEvent) => {
    clicked = event.target instanceof Element ? event.target.closest("button") : null;
  };
  const onFocusOut = (event: FocusEvent) => {
    if (event.target === clicked) clicked = null;
  };
  // Firefox presses a button when Space comes up, whatever was made of its going down.
  const onKeyUp = (event: KeyboardEvent) => {
    if (event.key === " " && event.target instanceof HTMLButtonElement) {
      if (!ownsKey(event.target, " ")) event.preventDefault();
    }
  };
  addEventListener("keydown", onKey);
  addEventListener("keyup", onKeyUp);
  addEventListener("pointerdown", onPointerDown, true);
  addEventListener("focusout", onFocusOut, true);
  return () => {
    removeEventListener("keydown", onKey);
    removeEventListener("keyup", onKeyUp);
    removeEventListener("pointerdown", onPointerDown, true);
    removeEventListener("focusout", onFocusOut, true);
  };
}
