// A scene that plays without a server: the core's player, told of commands and of time, as one tab sees it.
// Nothing here knows whether it runs in a worker; time is handed in.
import type {
  AnyEvent,
  BodyEvent,
  EquilibriumEvent,
  Field,
  Moment,
  OverlapEvent,
  StatEvent,
} from "../protocol";
import { CREDITS, PROTOCOL } from "../protocol";
import { bytesOf } from "./base64";
import type { Core, Told } from "./core";
import type { Draft } from "./engine";

/** Methods of the core that a player needs. */
export type Run = Pick<Core, "notes" | "stat" | "command" | "advance" | "topology" | "frame">;

/** Notes of the writer of a scene. */
export interface Notes {
  readonly version: string;
  readonly name: string;
  readonly text: string;
  readonly sentence: string;
  readonly fields: Field[];
  readonly body: BodyEvent;
  /** Smooth surface of the shapes as a binary message, base64; empty where none was traced. */
  readonly smooth?: string;
  /** Overlap of the body with itself as it is shown first. */
  readonly overlap?: OverlapEvent | null;
  /** Poses of objects then, and contacts. */
  readonly moment?: Moment | null;
  /** True if the state shown first is an equilibrium. */
  readonly at_rest?: boolean;
  /** Its numbers. */
  readonly equilibrium?: EquilibriumEvent | null;
}

export interface Audience {
  event(event: AnyEvent): void;
  binary(message: ArrayBuffer): void;
}

/** Clock time that one turn may take, s: the rest belongs to drawing and input. */
const TURN = 0.012;
/** The longest time that one turn makes up for, s. */
const LONGEST = 0.1;

/** Commands that the core carries out. */
const PLAYED: ReadonlySet<string> = new Set([
  ...["play", "pause", "step", "reset", "pace", "load", "grab", "release"],
  ...["seek", "live", "pick", "probe"],
]);

/** Commands after which the first frame is that of the unloaded shape. */
const LEAVE: ReadonlySet<string> = new Set(["play", "step", "reset", "grab"]);
/** Commands after which the body is not at rest, though it is where it was. */
const WAKE: ReadonlySet<string> = new Set([...LEAVE, "load"]);

export class Player {
  private credits = CREDITS;
  private fresh = true;
  private field = 0;
  private seq = 0;
  private lastTurn: number | null = null;
  private overlapForgotten = false;
  private momentForgotten = false;
  private playing = false;
  private woken = false;

  constructor(
    private readonly run: Run,
    private readonly notes: Notes,
    private readonly audience: Audience,
  ) {}

  /** Tell everything from the start, as to a new tab. */
  greet(): void {
    const { notes } = this;
    this.audience.event({
      t: "hello",
      version: notes.version,
      protocol: PROTOCOL,
      design_schema: {},
      templates: [],
      materials: [],
      samplers: [],
      calibration_methods: [],
      fit_ranges: {},
      methods: ["xpbd"],
      metrics: [],
      fields: notes.fields,
      runs_folder: "",
      cores: 1,
    });
    this.audience.event({
      t: "document",
      rev: 1,
      id: "",
      hash: "",
      text: notes.text,
      name: notes.name,
      path: null,
      folder: "",
      dirty: false,
      valid: true,
      empty: false,
      parameters: [],
      design: null,
      source: null,
      diagnostics: [],
      can_undo: false,
      can_redo: false,
      before: "",
      after: "",
      histories: [],
    });
    const { smooth = "" } = notes;
    this.audience.event({ ...notes.body, smooth: smooth !== "" });
    this.audience.binary(this.run.topology());
    if (smooth) this.audience.binary(bytesOf(smooth));
    if (notes.overlap) this.audience.event(notes.overlap);
    if (notes.moment) this.tellMoment(notes.moment);
    this.audience.event({ t: "log", level: "info", text: notes.sentence });
    this.tell([this.run.stat]);
    if (notes.equilibrium) this.audience.event(notes.equilibrium);
  }

  /** Carry out a command; gives whether time has work to do. */
  take(command: Draft & { seq: number }): boolean {
    if (command.t === "ack") {
      this.credits += 1;
      this.send();
      return this.busy;
    }
    this.seq = command.seq;
    if (command.t === "view") this.field = command.field ?? this.field;
    else if (PLAYED.has(command.t)) this.play(command);
    else {
      const what = "This page runs by itself and cannot do that";
      const hint = "Open its design in the studio: voxsoft studio FILE";
      this.tell([{ t: "error", where: "", what, hint }]);
    }
    this.fresh = true;
    this.send();
    return this.busy;
  }

  get busy(): boolean {
    return this.playing;
  }

  /** Let time go on as far as the clock (ms) has, within a turn's budget. */
  turn(now: number): void {
    if (!this.playing) return;
    const passed = this.lastTurn === null ? 1 / 60 : (now - this.lastTurn) / 1000;
    this.lastTurn = now;
    this.tell(this.run.advance(Math.min(LONGEST, passed), TURN));
    this.fresh = true;
    this.send();
  }

  private play(command: Draft): void {
    const before = this.playing;
    if (LEAVE.has(command.t)) this.forgetMoment();
    if (WAKE.has(command.t)) this.woken = true;
    this.tell(this.run.command(command));
    if (!before) this.lastTurn = null;
  }

  private send(): void {
    if (!this.fresh || this.credits <= 0) return;
    this.fresh = false;
    this.credits -= 1;
    this.audience.binary(this.run.frame(this.field, this.seq));
  }

  private tell(told: readonly Told[]): void {
    for (const event of told) {
      if (event.t === "error") this.audience.event({ ...event, seq: this.seq });
      else if (event.t === "stat") this.tellStat(event);
      else this.audience.event(event);
    }
  }

  private tellStat(stat: StatEvent): void {
    this.playing = stat.state === "playing";
    this.forgetOverlap(stat);
    const sentence = stat.sentence || hint(stat.state);
    // The core knows the first frame as one that has not begun; whoever wrote the page knows more.
    const resting = this.notes.at_rest && !this.woken && stat.state === "paused";
    const state = resting ? "at-rest" : stat.state;
    this.audience.event({ ...stat, state, sentence, solver: "xpbd", progress: null });
  }

  private tellMoment(moment: Moment): void {
    this.audience.event({ t: "moment", topology: this.notes.body.topology, moment });
  }

  // Data of objects are of the shape that is shown first as well.
  private forgetMoment(): void {
    if (!this.notes.moment || this.momentForgotten) return;
    this.momentForgotten = true;
    this.tellMoment(NOWHERE);
  }

  // Data of overlaps are of the shape that is shown first alone.
  private forgetOverlap(stat: StatEvent): void {
    const { overlap } = this.notes;
    if (!overlap || this.overlapForgotten || stat.frame === 0) return;
    this.overlapForgotten = true;
    this.audience.event({ ...overlap, depth: 0, sentence: "", places: [] });
  }
}

/** Nothing is known any more of where objects were. */
const NOWHERE: Moment = {
  ...{ frame: 0, time: 0, poses: [], contacts: [], fields: false, depth: null },
};

/** Text of a page without panes where the core has nothing to report. */
function hint(state: StatEvent["state"]): string {
  if (state === "paused") return "Press Space, or drag the body.";
  return state === "playing" ? "Time runs. Drag the body to pull on it." : "";
}
