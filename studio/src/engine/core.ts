// The typed side of the core in WebAssembly: crates/wasm/src/lib.rs lists the exports. Numbers go in as
// arguments, bytes through the core's memory; what comes back is always a copy.

interface Exports {
  readonly memory: WebAssembly.Memory;
  vx_alloc(length: number): number;
  vx_free(at: number, length: number): void;
  vx_answer_at(): number;
  vx_error(): number;
  vx_open(at: number, length: number): number;
  vx_close(run: number): void;
  vx_notes(run: number): number;
  vx_vertices(run: number): number;
  vx_loads(run: number): number;
  vx_shown(run: number): number;
  vx_implicit(run: number): number;
  vx_prefer_step(run: number, seconds: number): void;
  vx_advance(run: number, substeps: number): number;
  vx_set_load(run: number, load: number, factor: number): number;
  vx_grab(
    run: number,
    number: number,
    vertex: number,
    x: number,
    y: number,
    z: number,
    stiffness: number,
  ): number;
  vx_release(run: number, number: number): number;
  vx_pull(run: number, number: number): number;
  vx_reset(run: number): void;
  vx_positions(run: number): number;
  vx_seek(run: number, at: number, time: number): number;
  vx_topology(run: number, number: number): number;
  vx_frame(
    run: number,
    topology: number,
    frame: number,
    field: number,
    seq: number,
    flags: number,
  ): number;
}

export type CoreStatus = "moving" | "at-rest" | "diverged";

/** What a look at a run shows; SI units. */
export interface CoreLook {
  readonly status: CoreStatus;
  readonly time: number;
  readonly substep: number;
  /** All so far. */
  readonly substeps: number;
  readonly backOffs: number;
  readonly residual: number;
  readonly elastic: number;
  readonly kinetic: number;
  /** Where it broke down, a vertex of the body. */
  readonly brokenVertex: number | null;
}

/** What the hand feels: force in N on the vertex, stretch of the spring in m. */
export interface Pull {
  readonly force: [number, number, number];
  readonly stretch: number;
}

const STATUS: readonly CoreStatus[] = ["moving", "at-rest", "diverged"];

/** The core said no, or its scene is damaged. */
export class CoreError extends Error {}

/** The core, compiled once; it opens as many scenes as asked. */
export class Core {
  private constructor(private readonly exports: Exports) {}

  static async load(wasm: BufferSource): Promise<Core> {
    const { instance } = await WebAssembly.instantiate(wasm);
    return new Core(instance.exports as unknown as Exports);
  }

  /** Open the bytes that `voxsoft export --html` or the server packed. */
  open(scene: Uint8Array): CoreRun {
    const run = this.hand(scene, (at) => this.exports.vx_open(at, scene.length));
    if (run === 0) throw this.refusal();
    return new CoreRun(this, this.exports, run);
  }

  /** @internal Copies bytes into the core's memory for the time of a call. */
  hand<T>(bytes: Uint8Array, call: (at: number) => T): T {
    const at = this.exports.vx_alloc(bytes.length);
    new Uint8Array(this.exports.memory.buffer).set(bytes, at);
    try {
      return call(at);
    } finally {
      this.exports.vx_free(at, bytes.length);
    }
  }

  /** @internal A copy of the answer, because the core's memory may move with the next call. */
  answer(length: number): ArrayBuffer {
    const at = this.exports.vx_answer_at();
    return this.exports.memory.buffer.slice(at, at + length) as ArrayBuffer;
  }

  /** @internal What the core says about a failure. */
  refusal(): CoreError {
    return new CoreError(new TextDecoder().decode(this.answer(this.exports.vx_error())));
  }
}

/** A scene in motion. */
export class CoreRun {
  /** Of the body, not only of what is shown. */
  readonly vertices: number;
  readonly loads: number;
  /** What the writer noted beside the scene, mostly JSON. */
  readonly notes: string;
  /** The body's vertex of each point of the surface. */
  readonly shown: Uint32Array;
  /** Whether a step solves for its end and may be as long as the time between two frames. */
  readonly implicit: boolean;

  /** @internal */
  constructor(
    private readonly core: Core,
    private readonly exports: Exports,
    private readonly run: number,
  ) {
    this.vertices = exports.vx_vertices(run);
    this.loads = exports.vx_loads(run);
    this.implicit = exports.vx_implicit(run) !== 0;
    this.notes = new TextDecoder().decode(core.answer(exports.vx_notes(run)));
    this.shown = new Uint32Array(core.answer(exports.vx_shown(run)));
  }

  /** Ask for steps of another length, s; explicit ones are as long as they can be. */
  preferStep(seconds: number): void {
    this.exports.vx_prefer_step(this.run, seconds);
  }

  /** Take substeps, fewer if the body comes to rest or diverges. */
  advance(substeps: number): CoreLook {
    const answer = this.core.answer(this.exports.vx_advance(this.run, substeps));
    const numbers = Array.from(new Float64Array(answer));
    const [status, time, substep, count, backOffs, residual, elastic, kinetic, vertex] =
      numbers as [number, number, number, number, number, number, number, number, number];
    return {
      status: STATUS[status] ?? "diverged",
      time,
      substep,
      substeps: count,
      backOffs,
      residual,
      elastic,
      kinetic,
      brokenVertex: vertex < 0 ? null : vertex,
    };
  }

  /** Make a load `factor` times its final value; null gives its history back. */
  setLoad(load: number, factor: number | null): void {
    this.agree(this.exports.vx_set_load(this.run, load, factor ?? Number.NaN));
  }

  /** Pull a vertex toward a point (m) by a spring (N/m). */
  grab(
    number: number,
    vertex: number,
    target: readonly [number, number, number],
    stiffness: number,
  ): void {
    this.agree(this.exports.vx_grab(this.run, number, vertex, ...target, stiffness));
  }

  /** Let go; whether there was such a grab. */
  release(number: number): boolean {
    return this.exports.vx_release(this.run, number) !== 0;
  }

  pull(number: number): Pull | null {
    const length = this.exports.vx_pull(this.run, number);
    if (length === 0) return null;
    const [x, y, z, stretch] = new Float64Array(this.core.answer(length));
    return { force: [x!, y!, z!], stretch: stretch! };
  }

  reset(): void {
    this.exports.vx_reset(this.run);
  }

  /** x, y, z of every vertex, m. */
  positions(): Float64Array {
    return new Float64Array(this.core.answer(this.exports.vx_positions(this.run)));
  }

  seek(positions: Float64Array, time: number): void {
    if (positions.length !== 3 * this.vertices) {
      throw new CoreError(`${positions.length} coordinates, expected ${3 * this.vertices}`);
    }
    const bytes = new Uint8Array(positions.buffer, positions.byteOffset, positions.byteLength);
    this.agree(this.core.hand(bytes, (at) => this.exports.vx_seek(this.run, at, time)));
  }

  /** The topology message, as the server sends it. */
  topology(number: number): ArrayBuffer {
    return this.core.answer(this.exports.vx_topology(this.run, number));
  }

  /** A frame message, as the server sends it; flags 1 paused, 2 diverged, 4 at rest. */
  frame(topology: number, frame: number, field: number, seq: number, flags: number): ArrayBuffer {
    const length = this.exports.vx_frame(this.run, topology, frame, field, seq, flags);
    if (length === 0) throw new CoreError(`no field ${field}`);
    return this.core.answer(length);
  }

  /** Free its memory; it must not be used after. */
  close(): void {
    this.exports.vx_close(this.run);
  }

  private agree(done: number): void {
    if (done === 0) throw this.core.refusal();
  }
}
