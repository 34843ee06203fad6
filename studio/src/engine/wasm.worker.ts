// The worker: opens a scene with the core and lets a player play it.
import { Core } from "./core";
import { type Notes, Player } from "./player";
import type { FromWorker, ToWorker } from "./wasm";

const post = (message: FromWorker) =>
  message instanceof ArrayBuffer
    ? (postMessage as (message: unknown, transfer: Transferable[]) => void)(message, [message])
    : postMessage(message);

let player: Player | null = null;
let waiting: ToWorker[] = [];
let ticking = false;

addEventListener("message", async (message: MessageEvent<ToWorker>) => {
  const { data } = message;
  if (data.kind === "open") {
    try {
      const core = await Core.open(data.core, new Uint8Array(data.scene));
      player = new Player(core, JSON.parse(core.notes) as Notes, {
        event: (event) => post({ kind: "event", event }),
        binary: (bytes) => post(bytes),
      });
      player.greet();
      for (const early of waiting) handle(early);
      waiting = [];
    } catch (error) {
      post({ kind: "failed", reason: String(error instanceof Error ? error.message : error) });
    }
  } else if (player) handle(data);
  else waiting.push(data);
});

function handle(message: ToWorker): void {
  if (message.kind !== "command" || !player) return;
  if (player.take(message.command) && !ticking) {
    ticking = true;
    tick();
  }
}

// A pause between turns lets commands in.
const PAUSE = 4;

function tick(): void {
  if (!player?.busy) {
    ticking = false;
    return;
  }
  player.turn(performance.now());
  setTimeout(tick, PAUSE);
}
