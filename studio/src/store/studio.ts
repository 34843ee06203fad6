// State of the page. Events of the engine are folded in by `apply`; panes read by selectors.
import { create } from "zustand";
import type { Link } from "../engine/engine";
import type {
  AnyEvent,
  BodyEvent,
  CalibratedEvent,
  ChambersEvent,
  ComparedEvent,
  DesignFilesEvent,
  DocumentEvent,
  EquilibriumEvent,
  FinenessEvent,
  GenerationEvent,
  GhostsEvent,
  HelloEvent,
  JobEvent,
  LogEvent,
  MaterialsEvent,
  MeasuredEvent,
  Moment,
  OverlapEvent,
  OverlayEvent,
  PathEvent,
  PickedEvent,
  RecipeEvent,
  RunsEvent,
  SavedEvent,
  StartEvent,
  StatEvent,
  SubjectEvent,
  TrialEvent,
  TrialsEvent,
  VersionDifferenceEvent,
  VersionsEvent,
  VibrationEvent,
} from "../protocol";
import type { Gathered } from "./gather";
import { PlotHistory } from "./history";

export interface Toast {
  readonly id: number;
  readonly level: "info" | "good" | "warning" | "error";
  readonly what: string;
  readonly hint: string;
  readonly action?: { readonly label: string; run(): void };
  /** Subject, where a newer message about the same takes its place. */
  readonly about?: string;
}

export interface LogLine extends Pick<LogEvent, "level" | "text"> {
  readonly id: number;
  readonly at: number;
}

/** A pace that was asked for: null is the automatic one; and which of the engine's choices it will be. */
export interface AskedPace {
  readonly factor: number | null;
  readonly choice: number;
}

export interface Studio {
  link: Link;
  hello: HelloEvent | null;
  /** Content of the start screen. */
  start: StartEvent | null;
  document: DocumentEvent | null;
  /** Design files beside it. */
  designs: DesignFilesEvent | null;
  /** Data of all materials, once a pane asked for them. */
  materials: MaterialsEvent | null;
  /** Shapes by themselves, as this tab asked for them. */
  ghosts: GhostsEvent | null;
  body: BodyEvent | null;
  stat: StatEvent | null;
  /** The last pace that was asked for and is not confirmed yet. */
  askedPace: AskedPace | undefined;
  /** Overlap of the body with itself as it is shown. */
  overlap: OverlapEvent | null;
  equilibrium: EquilibriumEvent | null;
  /** Cost of finer voxels, once it was asked. */
  fineness: FinenessEvent | null;
  vibration: VibrationEvent | null;
  /** State of supplies in the motion that is shown. */
  chambers: ChambersEvent | null;
  /** Moments of frames of a solution with contact, by their numbers. */
  moments: ReadonlyMap<number, Moment>;
  picked: PickedEvent | null;
  jobs: Readonly<Record<string, JobEvent>>;
  /** Designs of jobs, by job. */
  subjects: Readonly<Record<string, SubjectEvent>>;
  trials: Readonly<Record<string, TrialsEvent>>;
  generations: Readonly<Record<string, readonly GenerationEvent[]>>;
  overlays: Readonly<Record<string, OverlayEvent>>;
  paths: Readonly<Record<string, PathEvent>>;
  calibrated: Readonly<Record<string, CalibratedEvent>>;
  recipes: Readonly<Record<string, RecipeEvent>>;
  runs: RunsEvent | null;
  compared: ComparedEvent | null;
  measured: Readonly<Record<string, MeasuredEvent>>;
  /** A file that is there already, which saving would replace. */
  fileExists: string | null;
  /** Versions of the document, once they were asked for. */
  versions: VersionsEvent | null;
  /** Difference of the version asked for last from the document. */
  versionDifference: VersionDifferenceEvent | null;
  /** Grows with each design that was saved. */
  saved: number;
  log: readonly LogLine[];
  toasts: readonly Toast[];
  /** Grows with each row of `history`, which itself stays the same object. */
  plotted: number;
  history: PlotHistory;
}

/** State of the page while no body is shown. */
const NO_BODY = {
  body: null,
  askedPace: undefined,
  overlap: null,
  equilibrium: null,
  fineness: null,
  vibration: null,
  chambers: null,
  moments: new Map<number, Moment>(),
  picked: null,
};

const LONGEST_LOG = 500;
const MOST_TOASTS = 4;

/** Frames of a moving body whose contacts are kept: half a minute of them. */
const MOST_MOMENTS = 2000;

export const useStudio = create<Studio>(() => ({
  link: { state: "connecting", attempt: 0, retryAt: null, reason: "" },
  hello: null,
  start: null,
  document: null,
  designs: null,
  materials: null,
  ghosts: null,
  body: null,
  stat: null,
  askedPace: undefined,
  overlap: null,
  equilibrium: null,
  fineness: null,
  vibration: null,
  chambers: null,
  moments: new Map(),
  picked: null,
  jobs: {},
  subjects: {},
  trials: {},
  generations: {},
  overlays: {},
  paths: {},
  calibrated: {},
  recipes: {},
  runs: null,
  compared: null,
  measured: {},
  fileExists: null,
  versions: null,
  versionDifference: null,
  saved: 0,
  log: [],
  toasts: [],
  plotted: 0,
  history: new PlotHistory(),
}));

let nextId = 1;

/** Duration of a message, ms: long enough to read it, longer where there is something to do. */
const STAYS = { plain: 5_000, action: 10_000, error: 20_000 };

/** Show a message that goes away by itself; an error stays in the log. */
export function toast(message: Omit<Toast, "id">): number {
  const id = nextId++;
  useStudio.setState((state) => {
    const { what, about } = message;
    const others = state.toasts.filter(
      (one) => one.what !== what && (about === undefined || one.about !== about),
    );
    return { toasts: [...others, { ...message, id }].slice(-MOST_TOASTS) };
  });
  const { level, what, hint, action } = message;
  if (level === "error") note("error", [what, hint].filter(Boolean).join(" · "));
  const stays = level === "error" ? "error" : action ? "action" : "plain";
  setTimeout(() => dismiss(id), STAYS[stays]);
  return id;
}

export function dismiss(id: number): void {
  useStudio.setState((state) => ({ toasts: state.toasts.filter((one) => one.id !== id) }));
}

export function note(level: LogEvent["level"], text: string): void {
  const line: LogLine = { id: nextId++, at: Date.now(), level, text };
  useStudio.setState((state) => ({ log: [...state.log, line].slice(-LONGEST_LOG) }));
}

/** Fold one event of the engine into the state; those that come in crowds: `applyAll`. */
export function apply(event: Exclude<AnyEvent, Gathered>): void {
  const set = useStudio.setState;
  switch (event.t) {
    case "hello":
      // All jobs that this server knows are told anew; others are asked for (watchJob).
      // A pace that was asked for may have been lost with the connection.
      set({ hello: event, jobs: {}, askedPace: undefined });
      break;
    case "start":
      set({ start: event });
      break;
    case "document":
      set({ document: event });
      break;
    case "design_files":
      set({ designs: event });
      break;
    case "materials":
      set({ materials: event });
      break;
    case "ghosts":
      set({ ghosts: event });
      break;
    case "body":
      set(({ body, moments, askedPace, picked }) => ({
        body: event,
        // The report of the checks comes behind a body, of which a place may be picked already.
        picked: body?.topology === event.topology ? picked : null,
        // Another body starts with the pace that was chosen, and counts anew.
        askedPace: body?.topology === event.topology ? askedPace : undefined,
        moments: body?.topology === event.topology ? moments : new Map(),
      }));
      break;
    case "bare":
      set((state) => {
        state.history.clear();
        return { ...NO_BODY, plotted: state.plotted + 1 };
      });
      break;
    case "stat":
      set(({ askedPace }) => ({
        stat: withPace(event, askedPace),
        askedPace: isOpen(askedPace, event) ? askedPace : undefined,
      }));
      break;
    case "equilibrium":
      set({ equilibrium: event });
      break;
    case "fineness":
      set({ fineness: event });
      break;
    case "vibration":
      set({ vibration: event });
      break;
    case "chambers":
      set({ chambers: event });
      break;
    case "overlap":
      set({ overlap: event });
      break;
    case "moments":
      if (useStudio.getState().body?.topology === event.topology)
        set({ moments: new Map(event.moments.map((moment) => [moment.frame, moment])) });
      break;
    case "moment":
      set(({ body, moments, stat }) => {
        if (body?.topology !== event.topology) return {};
        const known = new Map(moments).set(event.moment.frame, event.moment);
        // Frames that are stored no more are shown no more.
        for (const frame of known.keys()) {
          if (known.size <= MOST_MOMENTS && frame >= (stat?.first_frame ?? 0)) break;
          known.delete(frame);
        }
        return { moments: known };
      });
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
    case "subject":
      set((state) => ({ subjects: { ...state.subjects, [event.job]: event } }));
      break;
    case "trials":
      set((state) => ({ trials: { ...state.trials, [event.job]: event } }));
      break;
    case "path":
      set((state) => ({ paths: { ...state.paths, [event.job]: event } }));
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
    case "file_exists":
      set({ fileExists: event.path });
      break;
    case "taken":
      toast(takenToast(event.trial, event.changed, useStudio.getState().document));
      break;
    case "versions":
      set({ versions: event, versionDifference: null });
      break;
    case "version_difference":
      set({ versionDifference: event });
      break;
    case "saved":
      if (event.what === "document") set((state) => ({ saved: state.saved + 1 }));
      toast(savedToast(event));
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
      break;
    case "log":
      note(event.level, event.text);
      if (event.level === "warning") toast({ level: "warning", what: event.text, hint: "" });
  }
}

/** Statistics with the pace that was asked for: those on their way then hold the one before. */
function withPace(stat: StatEvent, asked: AskedPace | undefined): StatEvent {
  if (!isOpen(asked, stat) || asked.factor === stat.pace_chosen) return stat;
  return { ...stat, pace: asked.factor ?? 1, pace_chosen: asked.factor };
}

/** Check if the engine had not yet come to the requested pace. */
function isOpen(asked: AskedPace | undefined, stat: StatEvent): asked is AskedPace {
  return asked !== undefined && stat.pace_choices < asked.choice;
}

/** Show a pace as chosen at once, until the engine confirms it. */
export function showAskedPace(factor: number | null): void {
  useStudio.setState(({ stat, askedPace }) => {
    const asked = { factor, choice: (askedPace?.choice ?? stat?.pace_choices ?? 0) + 1 };
    return { stat: stat && withPace(stat, asked), askedPace: asked };
  });
}

function takenToast(
  trial: string,
  changed: boolean,
  document: DocumentEvent | null,
): Omit<Toast, "id"> {
  const [design, name] = [`design ${trial.split("/").at(-1)}`, document?.name ?? "the design"];
  if (!changed) return { level: "info", what: `${name} is ${design} already`, hint: "" };
  const hint = "Undo brings its own parameters back.";
  return { level: "good", what: `${name} has the parameters of ${design}`, hint };
}

function savedToast({ what, path }: SavedEvent): Omit<Toast, "id"> {
  if (what !== "run") return { level: "good", what: `Saved ${path}`, hint: "" };
  const name = path.split(/[\\/]/).at(-1);
  return { level: "good", what: `Kept as ${name}`, hint: "It is the newest of the runs." };
}

/** Fold many trials and generations in at once: their panes are drawn once. */
export function applyAll(events: readonly Gathered[]): void {
  useStudio.setState((state) => {
    const [trials, generations] = [{ ...state.trials }, { ...state.generations }];
    for (const job of new Set(events.map((event) => event.job))) {
      const own = events.filter((event) => event.job === job);
      const tried = own.filter((event) => event.t === "trial");
      if (tried.length > 0) trials[job] = withTrials(state, job, tried);
      const bred = own.filter((event) => event.t === "generation");
      if (bred.length > 0) generations[job] = withGenerations(generations[job] ?? [], bred);
    }
    return { trials, generations };
  });
}

function withTrials(state: Studio, job: string, fresh: readonly TrialEvent[]): TrialsEvent {
  const about = state.jobs[job];
  const known = state.trials[job];
  const last = fresh.at(-1) as TrialEvent;
  const byIndex = new Map(known?.trials.map((trial) => [trial.index, trial]));
  for (const trial of fresh) {
    byIndex.delete(trial.index); // one that is told again stands last
    byIndex.set(trial.index, trial);
  }
  return {
    t: "trials",
    job,
    parameters: known?.parameters ?? about?.parameters ?? Object.keys(last.parameters),
    objectives: known?.objectives ?? about?.objectives ?? Object.keys(last.objectives ?? {}),
    directions: known?.directions ?? about?.directions ?? [],
    kinds: known?.kinds ?? {},
    constraints: known?.constraints ?? [],
    space: known?.space ?? {},
    trials: [...byIndex.values()],
  };
}

function withGenerations(
  known: readonly GenerationEvent[],
  fresh: readonly GenerationEvent[],
): readonly GenerationEvent[] {
  const all = [...known];
  for (const event of fresh) {
    // A job that is sent again from its start replaces the earlier events from there on.
    while (all.length > 0 && (all.at(-1) as GenerationEvent).index >= event.index) all.pop();
    all.push(event);
  }
  return all;
}
