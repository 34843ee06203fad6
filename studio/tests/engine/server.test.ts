import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Draft, EngineListener } from "../../src/engine/engine";
import { ServerEngine } from "../../src/engine/server";

/** A websocket that a test opens, answers and closes by hand. */
class Socket {
  static readonly OPEN = 1;
  static all: Socket[] = [];
  readyState = 0;
  sent: { t: string; rev?: number }[] = [];
  onopen = () => {};
  onmessage = (_: { data: string }) => {};
  onclose = (_: { code: number; reason: string }) => {};

  constructor() {
    Socket.all.push(this);
  }

  send(text: string) {
    this.sent.push(JSON.parse(text));
  }

  close() {
    this.readyState = 3;
  }

  open() {
    this.readyState = Socket.OPEN;
    this.onopen();
    this.tell({ t: "hello" });
  }

  tell(event: object) {
    this.onmessage({ data: JSON.stringify(event) });
  }

  drop() {
    this.readyState = 3;
    this.onclose({ code: 1006, reason: "" });
  }
}

const newest = () => Socket.all.at(-1) as Socket;
const logs: string[] = [];
const listener = {
  event: (event: { t: string; text?: string }) => event.t === "log" && logs.push(event.text ?? ""),
  link: () => {},
} as unknown as EngineListener;
const edits = (socket: Socket) => socket.sent.filter(({ t }) => t === "edit");

function started(): ServerEngine {
  const engine = new ServerEngine("ws://127.0.0.1:1/ws");
  engine.start(listener);
  newest().open();
  newest().tell({ t: "document", id: "finger", name: "finger.toml", rev: 1 });
  return engine;
}

beforeEach(() => {
  Socket.all = [];
  logs.length = 0;
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Socket);
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("edits made without a connection", () => {
  const edit: Draft = { t: "edit", rev: 1, path: ["name"], value: "arm", stroke: 0 };

  it("are sent when their document is there again", () => {
    const engine = started();
    newest().drop();
    engine.send(edit);
    vi.runOnlyPendingTimers();
    newest().open();
    newest().tell({ t: "document", id: "finger", name: "finger.toml", rev: 7 });
    expect(edits(newest()).map(({ rev }) => rev)).toEqual([7]);
    engine.stop();
  });

  it("change no other document that the server opened meanwhile, and wait for their own", () => {
    const engine = started();
    newest().drop();
    engine.send(edit);
    vi.runOnlyPendingTimers();
    newest().open();
    for (const rev of [1, 2]) newest().tell({ t: "document", id: "arm", name: "arm.toml", rev });
    expect(edits(newest())).toEqual([]);
    expect(logs).toHaveLength(1);
    expect(logs[0]).toContain("finger.toml");
    newest().tell({ t: "document", id: "finger", name: "finger.toml", rev: 3 });
    expect(edits(newest()).map(({ rev }) => rev)).toEqual([3]);
    engine.stop();
  });
});

describe("a page that was refused", () => {
  it("tries again once another page of its address is admitted", async () => {
    vi.stubGlobal("fetch", async () => ({ status: 403, json: async () => ({ what: "no token" }) }));
    const engine = started();
    newest().drop();
    vi.runOnlyPendingTimers();
    const refused = newest();
    refused.drop();
    await vi.advanceTimersByTimeAsync(60_000);
    const tried = Socket.all.length;
    await vi.advanceTimersByTimeAsync(60_000);
    expect(Socket.all).toHaveLength(tried);
    vi.useRealTimers();
    const other = new BroadcastChannel("voxsoft.admitted");
    other.postMessage(null);
    await vi.waitUntil(() => Socket.all.length > tried);
    other.close();
    engine.stop();
  });
});
