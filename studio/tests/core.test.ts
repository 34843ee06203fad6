import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { Core, CoreError } from "../src/engine/core";
import { decode } from "../src/engine/frames";
import type { Run } from "../src/engine/player";

const file = (name: string) => new Uint8Array(readFileSync(new URL(name, import.meta.url)));
// A beam of 6 x 2 x 2 voxels of 5 mm, held at x = 0, under its weight.
const open = async () => (await Core.load(file("../public/voxsoft.wasm"))).open(file("beam.scene"));

describe("the core in the page", () => {
  it("is what the player needs", async () => {
    const run: Run = await open();
    expect(JSON.parse(run.notes)).toEqual({ name: "beam" });
    expect(run.shown.length).toBe(run.positions().length / 3 - 5);
  });

  it("sags to rest and shows it", async () => {
    const run = await open();
    const rest = run.positions();
    let look = run.advance(100);
    expect(look.status).toBe("moving");
    while (look.status === "moving") look = run.advance(1000);
    expect(look.status).toBe("at-rest");
    expect(look.elastic).toBeGreaterThan(0);
    const topology = decode(run.topology(3));
    const frame = decode(run.frame(3, 7, 3, 11, 4));
    if (topology.kind !== "topology" || frame.kind !== "frame") throw new Error("wrong kinds");
    expect(frame).toMatchObject({ topology: 3, number: 7, field: 3, seq: 11, atRest: true });
    expect(frame.time).toBe(look.time);
    expect(frame.packed.length).toBe((4 * topology.rest.length) / 3);
    expect(frame.min).toBeLessThan(0);
    run.reset();
    expect(run.positions()).toEqual(rest);
    run.close();
  });

  it("feels a hand", async () => {
    const run = await open();
    const vertex = run.vertices - 1;
    const [x, y, z] = run.positions().slice(3 * vertex);
    run.grab(2, vertex, [x!, y! + 2e-3, z!], 50);
    while (run.advance(1000).status === "moving");
    const pull = run.pull(2)!;
    expect(Math.hypot(...pull.force)).toBeCloseTo(50 * pull.stretch, 9);
    expect(pull.force[1]).toBeGreaterThan(0);
    expect(run.pull(9)).toBeNull();
    expect(run.release(2)).toBe(true);
    expect(run.release(2)).toBe(false);
  });

  it("follows its loads and goes on from other positions", async () => {
    const run = await open();
    run.setLoad(0, 0);
    expect(run.advance(64).status).toBe("at-rest");
    const rest = run.positions();
    run.setLoad(0, null);
    expect(run.advance(64).status).toBe("moving");
    run.seek(rest, 0.5);
    expect(run.positions()).toEqual(rest);
    expect(run.advance(0).time).toBe(0.5);
  });

  it("says what is wrong", async () => {
    const core = await Core.load(file("../public/voxsoft.wasm"));
    expect(() => core.open(new Uint8Array([1, 2, 3]))).toThrow("this is no scene");
    expect(() => core.open(file("beam.scene").subarray(0, 900))).toThrow("cut off");
    const run = core.open(file("beam.scene"));
    expect(() => run.setLoad(7, 1)).toThrow("index 7");
    expect(() => run.grab(0, 0, [0, 0, Number.NaN], 1)).toThrow(CoreError);
    expect(() => run.seek(new Float64Array(3), 0)).toThrow("3 coordinates");
    expect(() => run.frame(1, 1, 99, 0, 0)).toThrow("no field 99");
  });
});
