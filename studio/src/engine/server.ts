// The native core behind a websocket. Lost connections are opened again with growing pauses;
// edits made meanwhile are kept, and sent once the document of which they are is open again, on the
// revision that it then has. A page that was refused comes back when another one of this address is
// admitted: browsers have one cookie for both.
import type { AnyCommand, AnyEvent, DocumentEvent, EditCommand, TextCommand } from "../protocol";
import { CloseCode, PROTOCOL } from "../protocol";
import type { Draft, Engine, EngineListener, Link } from "./engine";
import { decode } from "./frames";

const FIRST_PAUSE = 250;
const LONGEST_PAUSE = 4000;
// Codes after which to come back would end the same way.
const FINAL: readonly number[] = [CloseCode.OTHER_PROTOCOL, CloseCode.WRONG_MESSAGES];

/** Name of the channel on which pages of one address tell that they were admitted. */
const ADMITTED = "voxsoft.admitted";

type Unsent = Omit<TextCommand, "seq"> | Omit<EditCommand, "seq">;

/** Pause before attempt `n` (from 1), ms; up to a quarter is chance. */
export function pauseBefore(attempt: number, chance = Math.random()): number {
  const pause = Math.min(LONGEST_PAUSE, FIRST_PAUSE * 2 ** (attempt - 1));
  return pause * (1 - 0.25 * chance);
}

/** Keep an edit made without a connection; a whole text replaces all that came before it. */
export function keep(unsent: readonly Unsent[], draft: Unsent): Unsent[] {
  return draft.t === "text" ? [draft] : [...unsent, draft];
}

export class ServerEngine implements Engine {
  readonly kind = "server";
  private socket: WebSocket | null = null;
  private listener: EngineListener | null = null;
  private seq = 0;
  private attempt = 0;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private unsent: Unsent[] = [];
  /** The document that was open last, of which all unsent edits are. */
  private document: DocumentEvent | null = null;
  private readonly others = new BroadcastChannel(ADMITTED);
  /** True once it was told that they wait for another document. */
  private warned = false;
  private refused = false;
  private greeted = false;
  private opened = false;

  constructor(private readonly address: string) {}

  start(listener: EngineListener): void {
    this.listener = listener;
    this.others.onmessage = () => this.comeIn();
    this.open();
  }

  stop(): void {
    this.listener = null;
    this.others.close();
    if (this.timer !== null) clearTimeout(this.timer);
    this.socket?.close();
    this.socket = null;
  }

  send(draft: Draft): number {
    if (this.socket?.readyState === WebSocket.OPEN && (this.greeted || draft.t === "hello")) {
      this.seq += 1;
      const command = { ...draft, seq: this.seq } as AnyCommand;
      this.socket.send(JSON.stringify(command));
      return this.seq;
    }
    if (draft.t === "text" || draft.t === "edit") this.unsent = keep(this.unsent, draft);
    return 0;
  }

  acknowledge(frame: number): void {
    this.send({ t: "ack", frame });
  }

  /** Try again at once instead of at the end of the pause. */
  retry(): void {
    if (this.timer === null) return;
    clearTimeout(this.timer);
    this.open();
  }

  /** Open the connection that was refused: there is another cookie now. */
  private comeIn(): void {
    if (this.refused) this.open();
  }

  private open(): void {
    this.refused = false;
    this.timer = null;
    this.attempt += 1;
    this.report({ state: "connecting", retryAt: null, reason: "" });
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.greeted = this.opened = false;
    socket.onopen = () => {
      this.opened = true;
      this.send({ t: "hello", protocol: PROTOCOL, version: "studio" });
    };
    socket.onmessage = (message: MessageEvent<string | ArrayBuffer>) => {
      if (typeof message.data === "string") this.receive(JSON.parse(message.data) as AnyEvent);
      else this.receiveBinary(message.data);
    };
    socket.onclose = (event) => this.closed(socket, event);
  }

  private receive(event: AnyEvent): void {
    if (event.t === "hello") {
      this.greeted = true;
      this.attempt = 0;
      this.others.postMessage(null);
      this.report({ state: "open", retryAt: null, reason: "" });
    }
    this.listener?.event(event);
    if (event.t === "document") this.takeDocument(event);
  }

  private takeDocument(document: DocumentEvent): void {
    const { unsent, document: before } = this;
    if (unsent.length === 0) {
      this.document = document;
    } else if (before === null || before.id === document.id) {
      this.document = document;
      this.unsent = [];
      this.warned = false;
      for (const draft of unsent) this.send({ ...draft, rev: document.rev });
    } else if (!this.warned) {
      this.warned = true;
      const text =
        `${document.name} is open now; edits that were made without a connection are of ` +
        `${before.name}, and are sent when that is opened again.`;
      this.listener?.event({ t: "log", level: "warning", text });
    }
  }

  private receiveBinary(buffer: ArrayBuffer): void {
    const message = decode(buffer);
    if (message.kind === "frame") this.listener?.frame(message);
    else if (message.kind === "topology") this.listener?.topology(message);
    else this.listener?.smooth(message);
  }

  private closed(socket: WebSocket, event: CloseEvent): void {
    if (socket !== this.socket || this.listener === null) return;
    const opened = this.opened;
    this.socket = null;
    this.greeted = this.opened = false;
    if (FINAL.includes(event.code)) {
      this.report({ state: "refused", retryAt: null, reason: event.reason, reload: true });
      return;
    }
    this.comeBack(event.reason);
    // A browser does not tell why a websocket could not be opened: a request for the page does.
    if (!opened) void this.askWhy();
  }

  private comeBack(reason: string): void {
    const pause = pauseBefore(Math.max(1, this.attempt));
    this.report({ state: "lost", retryAt: Date.now() + pause, reason });
    this.timer = setTimeout(() => this.open(), pause);
  }

  private async askWhy(): Promise<void> {
    const reply = await fetch("/", { cache: "no-store" }).catch(() => null);
    if (reply?.status !== 403 || this.listener === null || this.socket?.readyState === 1) return;
    const said = (await reply.json().catch(() => null)) as { what?: string } | null;
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    this.socket?.close();
    this.socket = null;
    this.refused = true;
    this.report({ state: "refused", retryAt: null, reason: said?.what ?? "", reload: false });
  }

  private report(link: Omit<Link, "attempt">): void {
    this.listener?.link({ ...link, attempt: this.attempt });
  }
}
