// The typed side of the core in WebAssembly: crates/wasm/src/lib.rs lists the exports. Numbers go in as
// arguments, bytes through the core's memory; results are always copies.
import type { AnyEvent, StatEvent } from "../protocol";

interface Exports {
  readonly memory: WebAssembly.Memory;
  vx_input(length: number): number;
  vx_answer(): number;
  vx_open(): number;
  vx_notes(): number;
  vx_command(): number;
  vx_advance(seconds: number, budget: number): number;
  vx_stat(): number;
  vx_topology(): number;
  vx_frame(field: number, seq: number): number;
  vx_positions(): number;
}

/** Events of the core, which knows of no command's number. */
export type Told = AnyEvent | { t: "error"; where: string; what: string; hint: string };

/** The core said no, or its scene is damaged. */
export class CoreError extends Error {}

/** The core with one scene, which it plays. */
export class Core {
  private constructor(private readonly exports: Exports) {}

  /** Compile the core, lend it a clock in ms, and open the bytes that `voxsoft export --html` packed. */
  static async open(
    wasm: BufferSource,
    scene: Uint8Array,
    clock: () => number = () => performance.now(),
  ): Promise<Core> {
    const { instance } = await WebAssembly.instantiate(wasm, {
      page: { now: () => clock() / 1000 },
    });
    const core = new Core(instance.exports as unknown as Exports);
    core.hand(scene);
    const refusal = core.text(core.exports.vx_open());
    if (refusal) throw new CoreError(refusal);
    return core;
  }

  /** Notes of the writer beside the scene, mostly JSON. */
  get notes(): string {
    return this.text(this.exports.vx_notes());
  }

  /** All numbers of the moment. */
  get stat(): StatEvent {
    return JSON.parse(this.text(this.exports.vx_stat())) as StatEvent;
  }

  /** Execute a command. */
  command(command: object): Told[] {
    this.hand(new TextEncoder().encode(JSON.stringify(command)));
    return this.told(this.exports.vx_command());
  }

  /** Let time go on by some seconds, within a budget of the clock in s. */
  advance(seconds: number, budget: number): Told[] {
    return this.told(this.exports.vx_advance(seconds, budget));
  }

  /** The topology message, as the server sends it. */
  topology(): ArrayBuffer {
    return this.answer(this.exports.vx_topology());
  }

  /** The frame that is looked at, as the server sends it. */
  frame(field: number, seq: number): ArrayBuffer {
    const length = this.exports.vx_frame(field, seq);
    if (length === 0) throw new CoreError(`no field ${field}`);
    return this.answer(length);
  }

  /** x, y, z of every vertex of the body, m. */
  positions(): Float64Array {
    return new Float64Array(this.answer(this.exports.vx_positions()));
  }

  private told(length: number): Told[] {
    return JSON.parse(this.text(length)) as Told[];
  }

  private text(length: number): string {
    return new TextDecoder().decode(this.answer(length));
  }

  private hand(bytes: Uint8Array): void {
    const at = this.exports.vx_input(bytes.length);
    new Uint8Array(this.exports.memory.buffer).set(bytes, at);
  }

  // A copy, because the core's memory may move with the next call.
  private answer(length: number): ArrayBuffer {
    const at = this.exports.vx_answer();
    return this.exports.memory.buffer.slice(at, at + length) as ArrayBuffer;
  }
}
