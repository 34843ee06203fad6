// A scene that plays without a server: what the native session does, over the core in the page.
// Nothing here knows whether it runs in a worker; time is handed in. Long because it is one state with a
// method for each command of the page.
import type { AnyEvent, BodyEvent, Field, GrabState, OverlapEvent, StatEvent } from "../protocol";
import { CREDITS, FrameFlag, PROTOCOL } from "../protocol";
import { bytesOf } from "./base64";
import type { CoreLook, CoreRun } from "./core";
import type { Draft } from "./engine";
import { Pace, RealTimeFactor } from "./pace";

/** What of the core a player needs. */
export type Run = Pick<
  CoreRun,
  | "notes"
  | "shown"
  | "implicit"
  | "preferStep"
  | "advance"
  | "setLoad"
  | "grab"
  | "release"
  | "pull"
  | "reset"
  | "seek"
  | "positions"
  | "topology"
  | "frame"
>;

/** What the writer of a scene says about it. */
export interface Notes {
  readonly version: string;
  readonly name: string;
  readonly text: string;
  readonly sentence: string;
  readonly fields: Field[];
  readonly body: BodyEvent;
  /** Where the vertices are shown first: m, float64 in base64; null or absent: unloaded. */
  readonly positions?: string | null;
  /** Where the body is in itself there. */
  readonly overlap?: OverlapEvent | null;
}

export interface Audience {
  event(event: AnyEvent): void;
  binary(message: ArrayBuffer): void;
}

/** Wall-clock time that one turn may take, ms: the rest belongs to drawing and input. */
const TURN = 12;
const TELL_EVERY = 100;
/** How far a motion is looked ahead: seconds of it, and vertices times substeps, explicit and implicit ones. */
const LONGEST_LOOK = 1;
const MOST_WORK = { explicit: 1_000_000, implicit: 4_000 };
/** The longest step of an implicit run: the time between two frames, s. */
const FRAME = 1 / 60;
const MOST_STORED = 64 * 1024 * 1024;

export class Player {
  private playing = false;
  private past: number | null = null;
  private look: CoreLook;
  private frame = 0;
  private stored: {
    frame: number;
    time: number;
    field: number;
    message: ArrayBuffer;
    positions: Float64Array;
  }[] = [];
  private storedBytes = 0;
  private credits = CREDITS;
  private fresh = true;
  private field = 0;
  private seq = 0;
  private loads: number[] = [];
  private grabs = new Map<
    number,
    { vertex: number; target: [number, number, number]; stiffness: number }
  >();
  private probed: number[] = [];
  private rows: (number | null)[][] = [];
  private lastTold = -Infinity;
  private overlapForgotten = false;
  private lastTurn: number | null = null;
  private readonly pace = new Pace();
  private readonly realTime = new RealTimeFactor();
  /** Substeps that are due, with parts of one. */
  private due = 0;
  private stepMs = 0;
  private readonly rest: Float64Array;

  constructor(
    private readonly run: Run,
    private readonly notes: Notes,
    private readonly audience: Audience,
  ) {
    for (const load of notes.body.loads) this.loads[load.index] = load.value;
    this.rest = run.positions();
    if (notes.positions) run.seek(new Float64Array(bytesOf(notes.positions)), 0);
    this.look = run.advance(0);
  }

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
      text: notes.text,
      name: notes.name,
      path: null,
      folder: "",
      dirty: false,
      valid: true,
      parameters: [],
      design: null,
      source: null,
      diagnostics: [],
      can_undo: false,
      can_redo: false,
    });
    this.audience.event({ ...notes.body, smooth: false });
    this.audience.binary(this.run.topology(notes.body.topology));
    if (notes.overlap && this.frame === 0) this.audience.event(notes.overlap);
    this.audience.event({ t: "log", level: "info", text: notes.sentence });
    this.tell();
  }

  /** Carry out a command; gives whether time has work to do. */
  take(command: Draft & { seq: number }): boolean {
    if (command.t !== "ack") this.seq = command.seq;
    switch (command.t) {
      case "play":
        this.goLive();
        this.lookAhead();
        this.playing = true;
        this.lastTurn = null;
        this.realTime.restart();
        break;
      case "pace":
        this.pace.chosen = command.factor ?? null;
        this.realTime.restart();
        break;
      case "pause":
        this.playing = false;
        break;
      case "step":
        this.goLive();
        this.playing = false;
        this.lookAhead();
        for (let i = 0; i < (command.n ?? 1); i++) this.step(1 / 60, Number.POSITIVE_INFINITY, 1);
        break;
      case "reset":
        this.resetAll();
        break;
      case "load":
        this.load(command.index, command.value ?? null, command.factor ?? null);
        break;
      case "grab":
        this.grab(command);
        break;
      case "release":
        this.run.release(command.id);
        this.grabs.delete(command.id);
        this.pace.restIn = null;
        break;
      case "seek":
        this.playing = false;
        this.past = command.time == null ? (command.frame ?? 0) : this.frameAt(command.time);
        break;
      case "live":
        this.goLive();
        break;
      case "view":
        this.field = command.field ?? this.field;
        break;
      case "pick":
        this.pick(command.vertex);
        break;
      case "probe":
        this.probed.push(command.vertex);
        break;
      case "ack":
        this.credits += 1;
        this.send();
        return this.busy;
      default:
        this.audience.event({
          t: "error",
          seq: command.seq,
          where: "",
          what: "This page runs by itself and cannot do that",
          hint: "Open its design in the studio: voxsoft studio FILE",
        });
    }
    this.fresh = true;
    this.tell();
    this.send();
    return this.busy;
  }

  get busy(): boolean {
    return this.playing;
  }

  /** Let time go on as far as the wall clock has, within a turn's budget. */
  turn(now: number): void {
    if (!this.playing) return;
    const passed = this.lastTurn === null ? 1 / 60 : Math.min(0.1, (now - this.lastTurn) / 1000);
    this.lastTurn = now;
    this.step(passed, now + TURN);
    this.send();
    this.realTime.mark(this.look.time, now);
    if (now - this.lastTold >= TELL_EVERY) {
      this.lastTold = now;
      this.tell();
    }
  }

  /** How soon it comes to rest from the unloaded shape, to show it slowly enough to be seen. */
  private lookAhead(): void {
    if (this.look.time > 0 || this.grabs.size > 0) return;
    this.run.reset(); // a result that is shown first stands at time zero too
    const most = this.run.implicit ? MOST_WORK.implicit : MOST_WORK.explicit;
    const work = Math.floor(most / Math.max(1, this.rest.length / 3));
    const look = this.run.advance(Math.min(work, Math.round(LONGEST_LOOK / this.look.substep)));
    this.run.reset();
    this.look = this.run.advance(0);
    this.pace.restIn = look.status === "at-rest" ? look.time : null;
  }

  /** Take the substeps of a time at the pace in force, as far as the clock allows. */
  private step(seconds: number, until: number, least = 0): void {
    if (this.run.implicit) this.run.preferStep(FRAME * this.pace.factor);
    const length = this.run.implicit ? FRAME * this.pace.factor : this.look.substep;
    this.due = Math.max(least, this.due + (seconds * this.pace.factor) / length);
    const wanted = Math.floor(this.due);
    if (wanted === 0) return; // in slow motion the next one is not due yet
    this.due -= wanted;
    const start = performance.now();
    let taken = 0;
    while (taken < wanted && (taken === 0 || performance.now() < until)) {
      const count = this.run.implicit ? 1 : Math.min(8, wanted - taken);
      this.look = this.run.advance(count);
      taken += count;
      if (this.look.status !== "moving") break;
    }
    this.stepMs = (performance.now() - start) / Math.max(1, taken);
    if (this.look.status !== "moving") this.playing = false;
    this.frame += 1;
    this.fresh = true;
    this.store();
    this.rows.push(this.row());
    if (this.look.status !== "moving") this.tell();
  }

  private row(): (number | null)[] {
    const { time, residual, elastic, kinetic } = this.look;
    const positions = this.run.positions();
    const probes = this.notes.body.probes.map((probe) => this.moved(positions, probe.vertices));
    const picked = this.probed.map((vertex) => this.moved(positions, [vertex]));
    return [time, residual, elastic, kinetic, ...probes, ...picked].map((x) =>
      Number.isFinite(x) ? x : null,
    );
  }

  // Length of the mean displacement of some shown vertices.
  private moved(positions: Float64Array, vertices: readonly number[]): number {
    const sum = [0, 0, 0];
    for (const shown of vertices) {
      const vertex = this.run.shown[shown] ?? 0;
      for (let axis = 0; axis < 3; axis++) {
        sum[axis]! += positions[3 * vertex + axis]! - this.rest[3 * vertex + axis]!;
      }
    }
    return Math.hypot(...sum) / Math.max(1, vertices.length);
  }

  private pack(field = this.field): ArrayBuffer {
    const { topology } = this.notes.body;
    const { status } = this.look;
    const flags =
      (this.playing ? 0 : FrameFlag.PAUSED) |
      (status === "diverged" ? FrameFlag.DIVERGED : 0) |
      (status === "at-rest" ? FrameFlag.AT_REST : 0);
    return this.run.frame(topology, this.frame, field, this.seq, flags);
  }

  private store(): void {
    const message = this.pack();
    const positions = this.run.positions();
    const { field, frame } = this;
    this.stored.push({ frame, time: this.look.time, field, message, positions });
    this.storedBytes += message.byteLength + positions.byteLength;
    while (this.storedBytes > MOST_STORED && this.stored.length > 1) {
      const old = this.stored.shift()!;
      this.storedBytes -= old.message.byteLength + old.positions.byteLength;
    }
  }

  private at(frame: number): Player["stored"][number] | null {
    return this.stored.find((one) => one.frame >= frame) ?? this.stored.at(-1) ?? null;
  }

  /** Number of the stored frame nearest to a time. */
  private frameAt(time: number): number {
    let best = this.stored[0];
    for (const one of this.stored) {
      if (best && Math.abs(one.time - time) < Math.abs(best.time - time)) best = one;
    }
    return best?.frame ?? this.frame;
  }

  private send(): void {
    if (!this.fresh || this.credits <= 0) return;
    this.fresh = false;
    this.credits -= 1;
    const old = this.past === null ? null : this.at(this.past);
    this.audience.binary(old ? this.packPast(old) : this.pack());
  }

  // Colors are those of the field that is shown now: a frame stored with another is packed anew.
  private packPast(old: Player["stored"][number]): ArrayBuffer {
    if (old.field === this.field) return old.message.slice(0);
    const now = { positions: this.run.positions(), time: this.look.time };
    this.run.seek(old.positions, old.time);
    const { topology } = this.notes.body;
    const packed = this.run.frame(topology, old.frame, this.field, this.seq, FrameFlag.PAUSED);
    this.run.seek(now.positions, now.time);
    return packed;
  }

  private goLive(): void {
    this.past = null;
  }

  private resetAll(): void {
    this.playing = false;
    this.past = null;
    this.pace.restIn = null;
    this.due = 0;
    for (const id of this.grabs.keys()) this.run.release(id);
    this.grabs.clear();
    this.run.reset();
    this.look = this.run.advance(0);
    this.stored = [];
    this.storedBytes = 0;
    this.frame += 1;
    this.rows = [];
    this.tellPlot(true);
  }

  private load(index: number, value: number | null, factor: number | null): void {
    const load = this.notes.body.loads.find((one) => one.index === index);
    if (!load) return;
    const share = factor ?? (load.value === 0 ? 0 : (value ?? 0) / load.value);
    this.run.setLoad(index, share);
    this.loads[index] = share * load.value;
    this.wake();
  }

  private grab(command: Extract<Draft, { t: "grab" }>): void {
    const vertex = this.run.shown[command.vertex];
    if (vertex === undefined) return;
    const stiffness = command.stiffness ?? 50;
    this.run.grab(command.id, vertex, command.target, stiffness);
    this.grabs.set(command.id, { vertex: command.vertex, target: command.target, stiffness });
    this.wake();
  }

  // What was at rest is so no more, and what a hand does is shown at once.
  private wake(): void {
    this.pace.restIn = null;
    if (this.look.status === "at-rest" && this.past === null) {
      this.playing = true;
      this.lastTurn = null;
    }
  }

  private pick(shown: number): void {
    const vertex = this.run.shown[shown];
    if (vertex === undefined) return;
    const positions = this.run.positions();
    const at = (from: Float64Array): [number, number, number] => [
      from[3 * vertex]!,
      from[3 * vertex + 1]!,
      from[3 * vertex + 2]!,
    ];
    const values = this.notes.fields.map((field) => {
      const view = new DataView(this.pack(field.id));
      const [low, high] = [view.getFloat32(56, true), view.getFloat32(60, true)];
      const share = view.getUint16(64 + 8 * shown + 6, true) / 65535;
      const { id, name, unit } = field;
      return { field: id, name, value: finite(low + (high - low) * share), unit };
    });
    this.audience.event({
      t: "picked",
      vertex: shown,
      rest: at(this.rest),
      position: at(positions),
      values,
    });
  }

  private tellPlot(clear = false): void {
    const { body } = this.notes;
    const names = [
      "time",
      "residual",
      "elastic",
      "kinetic",
      ...body.probes.map((probe) => probe.name),
      ...this.probed.map((vertex) => `vertex ${vertex}`),
    ];
    const units = ["s", "1", "J", "J", ...names.slice(4).map(() => "m")];
    const rows = this.rows.filter((row) => row.length === names.length);
    this.audience.event({ t: "plot", topology: body.topology, names, units, rows, clear });
    this.rows = [];
  }

  // What is known of overlaps is of the shape that is shown first alone.
  private forgetOverlap(): void {
    const { overlap } = this.notes;
    if (!overlap || this.overlapForgotten || this.frame === 0) return;
    this.overlapForgotten = true;
    this.audience.event({ ...overlap, depth: 0, sentence: "", places: [] });
  }

  private tell(): void {
    this.forgetOverlap();
    if (this.rows.length > 0) this.tellPlot();
    this.audience.event(this.stat());
  }

  private stat(): StatEvent {
    const { look, past } = this;
    const old = past === null ? null : this.at(past);
    const state =
      old !== null
        ? "past"
        : look.status === "diverged"
          ? "diverged"
          : this.playing
            ? "playing"
            : look.status === "at-rest" && look.time > 0
              ? "at-rest"
              : "paused";
    const grabs: GrabState[] = [...this.grabs].map(([id, grab]) => {
      const pull = this.run.pull(id);
      return {
        id,
        ...grab,
        force: pull ? [...pull.force] : [0, 0, 0],
        stretch: pull?.stretch ?? 0,
      };
    });
    return {
      t: "stat",
      topology: this.notes.body.topology,
      state,
      sentence: this.sentence(state),
      time: old?.time ?? look.time,
      step_ms: this.stepMs,
      substeps: look.substeps,
      real_time_factor: this.playing ? this.realTime.value : 0,
      pace: this.pace.factor,
      pace_chosen: this.pace.chosen,
      residual: finite(look.residual),
      elastic: finite(look.elastic),
      kinetic: finite(look.kinetic),
      frame: old?.frame ?? this.frame,
      first_frame: this.stored[0]?.frame ?? this.frame,
      last_frame: this.frame,
      frames_stored: this.stored.length,
      bytes_stored: this.storedBytes,
      solver: "xpbd",
      progress: null,
      loads: [...this.loads],
      grabs,
    };
  }

  private sentence(state: StatEvent["state"]): string {
    const time = `${this.look.time.toFixed(3)} s`;
    if (state === "at-rest") return `At rest after ${time}.`;
    if (state === "diverged") return `Diverged at ${time}: reset, and load it less.`;
    if (state === "past") return "A stored frame; LIVE goes back to the present.";
    if (state !== "playing") return "Press Space, or drag the body.";
    return this.pace.words || "Time runs. Drag the body to pull on it.";
  }
}

function finite(x: number): number | null {
  return Number.isFinite(x) ? x : null;
}
