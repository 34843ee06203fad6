// The one engine of the page, and the way of commands to it and of events from it.
import type { Draft, Engine } from "../engine/engine";
import type { Frame, Smooth, Topology } from "../engine/frames";
import type { EdgeEvent } from "../protocol";
import { calmed } from "./calm";
import { gathering } from "./gather";
import { apply, applyAll, type Toast, toast, useStudio } from "./studio";
import { flushText } from "./typing";

/** Drawer of bodies; the viewport registers itself here. */
export interface Stage {
  topology(topology: Topology): void;
  frame(frame: Frame): void;
  smoothSurface(smooth: Smooth): void;
  /** Draw no body any more. */
  clear(): void;
}

let engine: Engine | null = null;
let stage: Stage | null = null;
let lastTopology: Topology | null = null;
let lastFrame: Frame | null = null;
let lastSmooth: Smooth | null = null;
/** True once the server has said that there is no body. */
let bare = false;
const sentAt = new Map<number, number>();
const ready = new Set<() => void>();
/** Resolvers of commands that wait until all before them are done, by their numbers. */
const syncing = new Map<number, () => void>();

export function currentEngine(): Engine | null {
  return engine;
}

/** Called whenever the engine has (again) answered, to send it the view of this tab. */
export function onReady(callback: () => void): () => void {
  ready.add(callback);
  return () => {
    ready.delete(callback);
  };
}

export function connect(chosen: Engine): void {
  engine?.stop();
  engine = chosen;
  const applyStat = calmed(apply);
  const take = gathering(apply, applyAll);
  chosen.start({
    event(event) {
      if (event.t === "stat") applyStat(event);
      else if (event.t === "synced") settle(event.seq);
      else if (event.t === "edge") toast(edgeToast(event));
      else take(event);
      if (event.t === "bare") {
        lastTopology = lastFrame = lastSmooth = null;
        bare = true;
        stage?.clear();
      }
      if (event.t === "hello") for (const callback of ready) callback();
    },
    topology(topology) {
      lastTopology = topology;
      bare = false;
      stage?.topology(topology);
    },
    frame(frame) {
      lastFrame = frame;
      if (stage) stage.frame(frame);
      else chosen.acknowledge(frame.number);
    },
    smooth(smooth) {
      lastSmooth = smooth;
      stage?.smoothSurface(smooth);
    },
    link(link) {
      useStudio.setState({ link });
      // Commands that were not answered never will be.
      if (link.state !== "open") for (const seq of [...syncing.keys()]) settle(seq);
    },
  });
}

/** Let `next` draw from now on; it gets the newest messages at once. */
export function present(next: Stage): void {
  stage = next;
  if (bare) next.clear();
  if (lastTopology) next.topology(lastTopology);
  if (lastSmooth) next.smoothSurface(lastSmooth);
  if (lastFrame) next.frame(lastFrame);
}

/** Commands about the document, which must hold the typed text by then. */
const ON_DOCUMENT: ReadonlySet<Draft["t"]> = new Set([
  "edit",
  "edits",
  "swap",
  "copy",
  "move",
  "remove",
  "rename",
  "add_body",
  "take",
  "version_show",
  "version_restore",
  "undo",
  "redo",
  "open",
  "save",
  "job_start",
]);

/** Commands that are sent again by themselves once there is a connection. */
const LATER: ReadonlySet<Draft["t"]> = new Set(["text", "edit", "view", "ghosts"]);

/** Send a command; gives its number, or 0 with a message where there is no connection. */
export function send(draft: Draft): number {
  if (ON_DOCUMENT.has(draft.t)) flushText();
  const seq = engine?.send(draft) ?? 0;
  if (seq > 0) {
    sentAt.set(seq, performance.now());
    if (sentAt.size > 400) sentAt.delete(sentAt.keys().next().value as number);
  } else if (!LATER.has(draft.t)) {
    toast({
      level: "warning",
      what: "Not connected to VoxSoft",
      hint: "The page tries again by itself; edits are kept.",
    });
  }
  return seq;
}

/** Milliseconds since command `seq` was sent, or null where that is not known (any more). */
export function sinceSent(seq: number): number | null {
  const at = sentAt.get(seq);
  return at === undefined ? null : performance.now() - at;
}

/** Undo and redo end with the document; only a press of its own leads to the next one. */
export function edgeToast({ way, name, beyond }: EdgeEvent): Omit<Toast, "id"> {
  const back = way === "undo";
  const label = back ? `Back to ${beyond}` : `On to ${beyond}`;
  return {
    level: "info",
    what: `Nothing more to ${way} in ${name}`,
    hint: beyond && `One more would lead ${back ? "back" : "on"} to ${beyond}.`,
    about: "edge",
    ...(beyond && { action: { label, run: () => void send({ t: way, beyond: true }) } }),
  };
}

function settle(seq: number): void {
  syncing.get(seq)?.();
  syncing.delete(seq);
}

/** Resolved once the server has done all that was sent, or the connection is gone. */
function settled(): Promise<void> {
  return new Promise((resolve) => {
    const seq = engine?.send({ t: "sync" }) ?? 0;
    if (seq > 0) syncing.set(seq, resolve);
    else resolve();
  });
}

/** Ask the server for something made of the document as it stands after all that was typed. */
export async function ask(path: string, request: Record<string, unknown>): Promise<Response> {
  flushText();
  await settled();
  return fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(request),
  });
}
