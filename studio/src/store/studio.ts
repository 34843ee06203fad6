// What the page knows. Events of the engine are folded in by `apply`; panes read by selectors.
import { create } from "zustand";
import type { Link } from "../engine/engine";
import type {
  AnyEvent,
  BodyEvent,
  CalibratedEvent,
  ComparedEvent,
  DocumentEvent,
  GenerationEvent,
  HelloEvent,
  JobEvent,
  LogEvent,
  MeasuredEvent,
  OverlayEvent,
  PickedEvent,
  RecipeEvent,
  RunsEvent,
  StatEvent,
  TrialEvent,
  TrialsEvent,
} from "../protocol";
import { PlotHistory } from "./history";

export interface Toast {
  readonly id: number;
  readonly level: "info" | "good" | "warning" | "error";
  readonly what: string;
  readonly hint: string;
  readonly action?: { readonly label: string; run(): void };
}

export interface LogLine extends Pick<LogEvent, "level" | "text"> {
  readonly id: number;
  readonly at: number;
}

export interface Studio {
  link: Link;
  hello: HelloEvent | null;
  document: DocumentEvent | null;
  body: BodyEvent | null;
  stat: StatEvent | null;
  picked: PickedEvent | null;
  jobs: Readonly<Record<string, JobEvent>>;
  trials: Readonly<Record<string, TrialsEvent>>;
  generations: Readonly<Record<string, readonly GenerationEvent[]>>;
  overlays: Readonly<Record<string, OverlayEvent>>;
  calibrated: Readonly<Record<string, CalibratedEvent>>;
  recipes: Readonly<Record<string, RecipeEvent>>;
  runs: RunsEvent | null;
  compared: ComparedEvent | null;
  measured: Readonly<Record<string, MeasuredEvent>>;
  log: readonly LogLine[];
  toasts: readonly Toast[];
  /** Grows with each row of `history`, which itself stays the same object. */
  plotted: number;
  history: PlotHistory;
}

const LONGEST_LOG = 500;
const MOST_TOASTS = 4;

export const useStudio = create<Studio>(() => ({
  link: { state: "connecting", attempt: 0, retryAt: null, reason: "" },
  hello: null,
  document: null,
  body: null,
  stat: null,
  picked: null,
  jobs: {},
  trials: {},
  generations: {},
  overlays: {},
  calibrated: {},
  recipes: {},
  runs: null,
  compared: null,
  measured: {},
  log: [],
  toasts: [],
  plotted: 0,
  history: new PlotHistory(),
}));

let nextId = 1;

/** Show a message that goes away by itself; errors stay until they are closed. */
export function toast(message: Omit<Toast, "id">): number {
  const id = nextId++;
  useStudio.setState((state) => {
    const others = state.toasts.filter((one) => one.what !== message.what);
    return { toasts: [...others, { ...message, id }].slice(-MOST_TOASTS) };
  });
  if (message.level !== "error") setTimeout(() => dismiss(id), message.action ? 10_000 : 5000);
  return id;
}

export function dismiss(id: number): void {
  useStudio.setState((state) => ({ toasts: state.toasts.filter((one) => one.id !== id) }));
}

export function note(level: LogEvent["level"], text: string): void {
  const line: LogLine = { id: nextId++, at: Date.now(), level, text };
  useStudio.setState((state) => ({ log: [...state.log, line].slice(-LONGEST_LOG) }));
}

/** Fold one event of the engine into what the page knows. */
export function apply(event: AnyEvent): void {
  const set = useStudio.setState;
  switch (event.t) {
    case "hello":
      // All jobs that this server knows are told anew; others are asked for (watchJob).
      set({ hello: event, jobs: {} });
      break;
    case "document":
      set({ document: event });
      break;
    case "body":
      set({ body: event, picked: null });
      break;
    case "stat":
      set({ stat: event });
      break;
    case "plot":
      set((state) => {
        state.history.append(event);
        return { plotted: state.plotted + 1 };
      });
      break;
    case "picked":
      set({ picked: event });
      break;
    case "job":
      set((state) => ({ jobs: { ...state.jobs, [event.id]: event } }));
      break;
    case "trials":
      set((state) => ({ trials: { ...state.trials, [event.job]: event } }));
      break;
    case "trial":
      set((state) => ({ trials: withTrial(state, event) }));
      break;
    case "generation":
      set((state) => ({
        generations: {
          ...state.generations,
          [event.job]: withGeneration(state.generations[event.job] ?? [], event),
        },
      }));
      break;
    case "overlay":
      set((state) => ({ overlays: { ...state.overlays, [event.job]: event } }));
      break;
    case "calibrated":
      set((state) => ({ calibrated: { ...state.calibrated, [event.job]: event } }));
      break;
    case "recipe":
      set((state) => ({ recipes: { ...state.recipes, [event.job]: event } }));
      break;
    case "runs":
      set({ runs: event });
      break;
    case "compared":
      set({ compared: event });
      break;
    case "measured":
      set((state) => ({ measured: { ...state.measured, [event.name]: event } }));
      break;
    case "saved":
      toast({ level: "good", what: `Saved ${event.path}`, hint: "" });
      note("info", `saved ${event.path}`);
      break;
    case "exported":
      note("info", `${event.name} is ready`);
      break;
    case "error":
      toast({
        level: "error",
        what: event.where ? `${event.where}: ${event.what}` : event.what,
        hint: event.hint,
      });
      note("error", [event.where, event.what, event.hint].filter(Boolean).join(" · "));
      break;
    case "log":
      note(event.level, event.text);
  }
}

function withTrial(state: Studio, trial: TrialEvent): Studio["trials"] {
  const job = state.jobs[trial.job];
  const known = state.trials[trial.job] ?? {
    t: "trials",
    job: trial.job,
    parameters: job?.parameters ?? Object.keys(trial.parameters),
    objectives: job?.objectives ?? Object.keys(trial.objectives ?? {}),
    directions: job?.directions ?? [],
    kinds: {},
    trials: [],
  };
  const trials = known.trials.filter((one) => one.index !== trial.index);
  trials.push(trial);
  return { ...state.trials, [trial.job]: { ...known, trials } };
}

function withGeneration(
  known: readonly GenerationEvent[],
  event: GenerationEvent,
): readonly GenerationEvent[] {
  // A job that is told again from its start replaces what was known from there on.
  return [...known.filter((one) => one.index < event.index), event];
}
