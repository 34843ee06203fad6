import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { Core, CoreError } from "../../src/engine/core";
import { decode } from "../../src/engine/frames";
import type { Run } from "../../src/engine/player";
import type { StatEvent } from "../../src/protocol";

const file = (name: string) => new Uint8Array(readFileSync(new URL(name, import.meta.url)));
const wasm = file("../../public/voxsoft.wasm");
// A beam of 6 x 2 x 2 voxels of 5 mm, held at x = 0, under its weight.
const open = () => Core.open(wasm, file("beam.scene"));

/** Let time run until it stands still. */
function settle(core: Core): StatEvent {
  for (let frame = 0; frame < 3000 && core.stat.state === "playing"; frame++)
    core.advance(1 / 60, 1);
  return core.stat;
}

describe("the core in the page", () => {
  it("has the interface that the player needs", async () => {
    const run: Run = await open();
    expect(JSON.parse(run.notes)).toEqual({ name: "beam" });
    expect(run.stat).toMatchObject({ topology: 4, state: "paused", loads: [9.81] });
  });

  it("sags to rest and shows it", async () => {
    const core = await open();
    const rest = core.positions();
    core.command({ t: "play" });
    const stat = settle(core);
    expect(stat.state).toBe("at-rest");
    expect(stat.elastic).toBeGreaterThan(0);
    const topology = decode(core.topology());
    const frame = decode(core.frame(3, 11));
    if (topology.kind !== "topology" || frame.kind !== "frame") throw new Error("wrong kinds");
    expect(frame).toMatchObject({ topology: 4, number: stat.frame, field: 3, seq: 11 });
    expect([frame.atRest, frame.time]).toEqual([true, stat.time]);
    expect(frame.packed.length).toBe((4 * topology.rest.length) / 3);
    expect(frame.min).toBeLessThan(0);
    core.command({ t: "reset" });
    expect(core.positions()).toEqual(rest);
  });

  it("reports errors", async () => {
    await expect(Core.open(wasm, new Uint8Array([1, 2, 3]))).rejects.toThrow("this is no scene");
    const cut = file("beam.scene").subarray(0, 900);
    await expect(Core.open(wasm, cut)).rejects.toThrow("cut off");
    const core = await open();
    const refusal = (command: object) => core.command(command)[0];
    const error = { t: "error", where: "load" };
    expect(refusal({ t: "load", index: 7, factor: 1 })).toMatchObject(error);
    expect(refusal({ t: "grab", id: 0, vertex: 99, target: [0, 0, 0] })).toMatchObject({
      where: "vertex",
    });
    expect(refusal({ t: "dance" })).toMatchObject({ where: "command" });
    expect(() => core.frame(99, 0)).toThrow(CoreError);
  });
});
