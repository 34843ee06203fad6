// Plays a scene in the WebAssembly core: node wasm_run.mjs CORE SCENE POSITIONS SECONDS
// Does the commands that the notes hold, then lets time go on at once. Prints the last statistic as JSON and
// milliseconds for all steps and for a frame; writes all positions as float64.
import { readFileSync, writeFileSync } from "node:fs";

const [core, scene, positions, seconds] = process.argv.slice(2);
const page = { now: () => performance.now() / 1000 };
const { instance } = await WebAssembly.instantiate(readFileSync(core), { page });
const vx = instance.exports;
const answer = (length) => {
  const at = vx.vx_answer();
  return vx.memory.buffer.slice(at, at + length);
};
const text = (length) => new TextDecoder().decode(answer(length));
const hand = (bytes) => {
  const at = vx.vx_input(bytes.length); // may move the memory
  new Uint8Array(vx.memory.buffer).set(bytes, at);
};
hand(readFileSync(scene));
const refusal = text(vx.vx_open());
if (refusal) {
  console.error(refusal);
  process.exit(3);
}
const commands = JSON.parse(text(vx.vx_notes()) || "[]");
for (const command of commands) {
  hand(new TextEncoder().encode(JSON.stringify(command)));
  const [told] = JSON.parse(text(vx.vx_command()));
  if (told.t === "error") throw new Error(told.what);
}
const started = performance.now();
vx.vx_advance(Number(seconds), 3600);
const advanced = performance.now();
const { topology, ...stat } = JSON.parse(text(vx.vx_stat()));
const stated = performance.now();
let length = 0;
for (let frame = 0; frame < 20; frame++) length = vx.vx_frame(0, 0);
const packed = performance.now();
const frame = Buffer.from(answer(length)).toString("base64");
writeFileSync(positions, new Uint8Array(answer(vx.vx_positions())));
console.log(
  JSON.stringify({ stat, advance_ms: advanced - started, frame_ms: (packed - stated) / 20, frame }),
);
