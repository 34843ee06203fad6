// Requests beside the socket wait for the commands that were sent before them.
import { afterEach, expect, test, vi } from "vitest";
import type { Draft, Engine, EngineListener } from "../../src/engine/engine";
import { ask, connect, send } from "../../src/store/session";

/** Engine at the end of a slow wire: commands arrive, and are answered, when the test says so. */
class SlowEngine implements Engine {
  readonly kind = "server";
  readonly sent: Draft[] = [];
  listener: EngineListener | null = null;

  send(draft: Draft): number {
    return this.sent.push(draft);
  }

  acknowledge(): void {}

  start(listener: EngineListener): void {
    this.listener = listener;
  }

  stop(): void {}
}

const fetched = vi.fn(async () => new Response("{}"));

afterEach(() => {
  fetched.mockClear();
  vi.unstubAllGlobals();
});

function connected(): SlowEngine {
  const engine = new SlowEngine();
  connect(engine);
  vi.stubGlobal("fetch", fetched);
  return engine;
}

test("a request waits until the edit before it is done", async () => {
  const engine = connected();
  send({ t: "edit", rev: 1, path: ["voxel_size"], value: "4 mm" });
  const asked = ask("/export", { format: "stl" });
  await new Promise((resolve) => setTimeout(resolve));
  expect(engine.sent.map((each) => each.t)).toEqual(["edit", "sync"]);
  expect(fetched).not.toHaveBeenCalled();
  engine.listener?.event({ t: "synced", seq: 2 });
  await asked;
  expect(fetched).toHaveBeenCalledOnce();
});

test("a request does not wait for a connection that is gone", async () => {
  const engine = connected();
  const asked = ask("/molds", {});
  engine.listener?.link({ state: "lost", attempt: 1, retryAt: null, reason: "" });
  await asked;
  expect(fetched).toHaveBeenCalledOnce();
});
