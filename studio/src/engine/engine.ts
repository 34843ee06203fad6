// Interface of the page to the engine that runs the simulation: the native core behind a websocket
// (server.ts) or the same core compiled to WebAssembly in a worker (wasm.ts).
import type { AnyCommand, AnyEvent } from "../protocol";
import type { Frame, Smooth, Topology } from "./frames";

type Unnumbered<T> = T extends AnyCommand ? Omit<T, "seq"> : never;

/** A command before the engine numbers it. */
export type Draft = Unnumbered<AnyCommand>;

export type LinkState = "connecting" | "open" | "lost" | "refused";

/** State of the link: connected or not; `retryAt` is the time of the next attempt in ms since 1970. */
export interface Link {
  readonly state: LinkState;
  readonly attempt: number;
  readonly retryAt: number | null;
  readonly reason: string;
  /** True if a new load of the page helps where it was refused; else its address is not good. */
  readonly reload?: boolean;
}

export interface EngineListener {
  event(event: AnyEvent): void;
  topology(topology: Topology): void;
  frame(frame: Frame): void;
  smooth(smooth: Smooth): void;
  link(link: Link): void;
}

export interface Engine {
  readonly kind: "server" | "wasm";
  /** Send a command; gives its number, which frames echo, or 0 where it could not be sent. */
  send(draft: Draft): number;
  /** Say that a frame was shown or overtaken, so that another may come. */
  acknowledge(frame: number): void;
  start(listener: EngineListener): void;
  stop(): void;
}
