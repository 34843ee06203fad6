// Runs a scene in the WebAssembly core: node wasm_run.mjs CORE SCENE POSITIONS SUBSTEPS
// Prints the last look's numbers as JSON and milliseconds for the substeps and for a frame; writes all
// positions as float64.
import { readFileSync, writeFileSync } from "node:fs";

const [core, scene, positions, substeps] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(core));
const vx = instance.exports;
const answer = (length) => {
  const at = vx.vx_answer_at();
  return vx.memory.buffer.slice(at, at + length);
};
const bytes = readFileSync(scene);
const at = vx.vx_alloc(bytes.length);
new Uint8Array(vx.memory.buffer).set(bytes, at);
const run = vx.vx_open(at, bytes.length);
vx.vx_free(at, bytes.length);
if (run === 0) {
  console.error(new TextDecoder().decode(answer(vx.vx_error())));
  process.exit(3);
}
const { loads = [], grabs = [] } = JSON.parse(new TextDecoder().decode(answer(vx.vx_notes(run))) || "{}");
for (const [load, factor] of loads) vx.vx_set_load(run, load, factor);
for (const [number, vertex, x, y, z, k] of grabs) vx.vx_grab(run, number, vertex, x, y, z, k);
const started = performance.now();
const look = [...new Float64Array(answer(vx.vx_advance(run, Number(substeps))))];
const advanced = performance.now();
let length = 0;
for (let frame = 0; frame < 20; frame++) length = vx.vx_frame(run, 1, frame, 0, 0, 0);
const packed = performance.now();
const frame = Buffer.from(answer(length)).toString("base64");
writeFileSync(positions, new Uint8Array(answer(vx.vx_positions(run))));
console.log(
  JSON.stringify({ look, advance_ms: advanced - started, frame_ms: (packed - advanced) / 20, frame }),
);
