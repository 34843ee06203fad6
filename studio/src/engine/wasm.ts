// The core in a worker of this page: the same commands and events as with a server.
import type { AnyEvent } from "../protocol";
import type { Draft, Engine, EngineListener } from "./engine";
import { decode } from "./frames";

/** Messages of the page to the worker. */
export type ToWorker =
  | { kind: "open"; core: ArrayBuffer; scene: ArrayBuffer }
  | { kind: "command"; command: Draft & { seq: number } };

/** Messages of the worker to the page; binary messages come as they are. */
export type FromWorker =
  | { kind: "event"; event: AnyEvent }
  | { kind: "failed"; reason: string }
  | ArrayBuffer;

export class WasmEngine implements Engine {
  readonly kind = "wasm";
  private seq = 0;

  constructor(
    private readonly worker: Worker,
    private readonly core: ArrayBuffer,
    private readonly scene: ArrayBuffer,
  ) {}

  start(listener: EngineListener): void {
    const report = (state: "connecting" | "open" | "refused", reason = "") =>
      listener.link({ state, attempt: 1, retryAt: null, reason });
    report("connecting");
    this.worker.onmessage = (message: MessageEvent<FromWorker>) => {
      const { data } = message;
      if (data instanceof ArrayBuffer) {
        const decoded = decode(data);
        if (decoded.kind === "frame") listener.frame(decoded);
        else if (decoded.kind === "topology") listener.topology(decoded);
        else listener.smooth(decoded);
      } else if (data.kind === "failed") report("refused", data.reason);
      else {
        if (data.event.t === "hello") report("open");
        listener.event(data.event);
      }
    };
    this.worker.onerror = (error) => report("refused", error.message);
    const open: ToWorker = { kind: "open", core: this.core, scene: this.scene };
    this.worker.postMessage(open);
  }

  stop(): void {
    this.worker.terminate();
  }

  send(draft: Draft): number {
    this.seq += 1;
    const message: ToWorker = { kind: "command", command: { ...draft, seq: this.seq } };
    this.worker.postMessage(message);
    return this.seq;
  }

  acknowledge(frame: number): void {
    this.send({ t: "ack", frame });
  }
}
