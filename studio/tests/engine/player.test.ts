import { readFileSync } from "node:fs";
import { beforeEach, describe, expect, it } from "vitest";
import { Core } from "../../src/engine/core";
import type { Draft } from "../../src/engine/engine";
import { decode, type Frame, positionIn } from "../../src/engine/frames";
import { type Notes, Player } from "../../src/engine/player";
import type {
  AnyEvent,
  BodyEvent,
  Moment,
  OverlapEvent,
  StatEvent,
  Triple,
} from "../../src/protocol";

const file = (name: string) => new Uint8Array(readFileSync(new URL(name, import.meta.url)));

// Event that a server would send of the beam of 6 x 2 x 2 voxels in beam.scene.
const BODY: BodyEvent = {
  ...{ t: "body", topology: 4, rev: 1, voxels: 24, vertices: 63, tets: 120 },
  ...{ surface_vertices: 58, triangles: 112, voxel_size: 0.005, cavities: [], leaks: [] },
  ...{
    mass: 0.003,
    volume: 3e-6,
    findings: [],
    clamps: [],
    layers: [],
    attachments: [],
    objects: [],
    bodies: [],
    planes: [],
    floor: null,
    bonds: [],
    not_live: "",
    refused: {},
    touches: false,
    parts: [],
    seconds: 0,
    memory: 0,
  },
  ...{
    smooth: false,
    cut: false,
    probes: [{ name: "tip", center: [0.03, 0.005, 0.005], vertices: [57] }],
  },
  bounds: [
    [0, 0, 0],
    [0.03, 0.01, 0.01],
  ],
  loads: [
    {
      ...{ index: 0, kind: "gravity", label: "gravity", value: 9.81, unit: "m/s²", factor: 1 },
      quantity: "acceleration",
      ...{ min: 0, max: 20, at: [0.015, 0.005, 0.005], direction: [0, 0, -1] },
    },
  ],
};

const NOTES: Notes = {
  version: "0",
  name: "beam",
  text: "",
  sentence: "made for a test",
  fields: [
    {
      id: 0,
      name: "displacement",
      title: "Displacement",
      unit: "m",
      signed: false,
      contact: false,
    },
  ],
  body: BODY,
};

let events: AnyEvent[];
let frames: Frame[];
let player: Player;
let seq: number;
let clock: number;

const take = (draft: Draft) => player.take({ ...draft, seq: ++seq });
const stat = () => events.findLast((one) => one.t === "stat") as StatEvent;
const lastFrame = () => frames.at(-1) as Frame;

/** Let `seconds` of wall-clock time pass, at 60 turns a second, with every frame shown. */
function pass(seconds: number): void {
  for (let i = 0; i < seconds * 60 && player.busy; i++) {
    clock += 1000 / 60;
    player.turn(clock);
    while (shown < frames.length) {
      take({ t: "ack", frame: frames[shown++]?.number ?? 0 });
    }
  }
}
let shown: number;
let run: Core;

beforeEach(async () => {
  [events, frames, seq, shown] = [[], [], 0, 0];
  // The time that passes is that of the test: no turn is cut short.
  clock = 0;
  run = await Core.open(file("../../public/voxsoft.wasm"), file("beam.scene"), () => clock);
  player = new Player(run, NOTES, {
    event: (event) => events.push(event),
    binary(message) {
      const decoded = decode(message);
      if (decoded.kind === "frame") frames.push(decoded);
    },
  });
  player.greet();
});

describe("a scene that plays in the page", () => {
  it("greets as a server does", () => {
    expect(events.map((event) => event.t)).toEqual(["hello", "document", "body", "log", "stat"]);
    expect(stat().state).toBe("paused");
  });

  it("tells the smooth shape that is written beside it", () => {
    // A header alone, with no vertices.
    const message = new DataView(new ArrayBuffer(64));
    message.setUint32(0, 0x31465856, true);
    message.setUint8(4, 3);
    message.setUint32(8, 4, true);
    const text = btoa(String.fromCharCode(...new Uint8Array(message.buffer)));
    const kinds: string[] = [];
    const bodies: BodyEvent[] = [];
    new Player(
      run,
      { ...NOTES, smooth: text },
      {
        event: (event) => event.t === "body" && bodies.push(event),
        binary: (sent) => kinds.push(decode(sent).kind),
      },
    ).greet();
    expect(bodies.map((body) => body.smooth)).toEqual([true]);
    expect(kinds).toEqual(["topology", "smooth"]);
    expect(events.some((event) => event.t === "body" && event.smooth)).toBe(false);
  });

  it("sags to rest, tells so, and keeps its frames", () => {
    take({ t: "play" });
    expect(stat().state).toBe("playing");
    pass(20);
    expect(stat().state).toBe("at-rest");
    expect(lastFrame().atRest).toBe(true);
    expect(positionIn(lastFrame(), 57)[2]).toBeLessThan(0.0099);
    expect(stat().frames_stored).toBeGreaterThan(3);
    const rows = events.flatMap((event) => (event.t === "plot" ? event.rows : []));
    expect(rows.at(-1)?.[4]).toBeGreaterThan(1e-4);
  });

  it("sends no more than two frames to a page that shows none", () => {
    take({ t: "play" });
    for (let i = 0; i < 30; i++) {
      clock += 1000 / 60;
      player.turn(clock);
    }
    expect(frames.length).toBe(2);
    take({ t: "ack", frame: 0 });
    expect(frames.length).toBe(3);
  });

  it("goes back to a stored frame and to the present again", () => {
    take({ t: "play" });
    pass(20);
    const present = positionIn(lastFrame(), 57);
    take({ t: "ack", frame: 0 });
    take({ t: "seek", frame: stat().first_frame });
    expect(stat().state).toBe("past");
    expect(lastFrame().time).toBeLessThan(0.05);
    take({ t: "ack", frame: 0 });
    take({ t: "live" });
    const again = positionIn(lastFrame(), 57);
    for (const axis of [0, 1, 2]) expect(again[axis]).toBeCloseTo(present[axis] as number, 7);
  });

  it("follows a load that is taken away, and wakes for it", () => {
    take({ t: "play" });
    pass(20);
    const sag = positionIn(lastFrame(), 57)[2];
    take({ t: "load", index: 0, value: 0 });
    expect(player.busy).toBe(true);
    pass(20);
    // Back at its height within 2 % of the sag: rest is told within a share of the load.
    expect(Math.abs(positionIn(lastFrame(), 57)[2] - 0.01)).toBeLessThan(0.02 * (0.01 - sag));
    expect(stat().loads).toEqual([0]);
  });

  it("gives the force of a hand, and lets go of it with a reset", () => {
    take({ t: "play" });
    pass(1);
    take({ t: "grab", id: 3, vertex: 57, target: [0.03, 0.01, 0.02], stiffness: 50 });
    pass(20);
    const [grab] = stat().grabs;
    expect(grab?.vertex).toBe(57);
    expect(Math.hypot(...(grab?.force ?? [0]))).toBeCloseTo(50 * (grab?.stretch ?? 0), 9);
    take({ t: "reset" });
    expect(stat().grabs).toEqual([]);
    expect(stat().time).toBe(0);
  });

  it("reports impossible requests", () => {
    take({ t: "undo" });
    const error = events.findLast((one) => one.t === "error");
    expect(error).toMatchObject({ seq: 1, what: expect.stringContaining("by itself") });
  });
});

describe("slow motion", () => {
  const rows = () => events.flatMap((event) => (event.t === "plot" ? event.rows : []));

  it("is chosen where a motion is over too soon to be seen, says so, and stores its steps", () => {
    take({ t: "play" });
    // The beam of the test comes to rest within a fraction of a second.
    expect(stat().pace).toBeLessThan(1);
    expect(stat().pace_chosen).toBeNull();
    expect(stat().sentence).toMatch(
      /times slower than real time, as it comes to rest within [\d.]+ ms\./,
    );
    const begun = clock;
    pass(60);
    expect(stat().state).toBe("at-rest");
    expect(clock - begun).toBeGreaterThan(900);
    expect(stat().frames_stored).toBeGreaterThan(40);
  });

  it("gives way to the user's choice, which holds", () => {
    take({ t: "pace", factor: 0.1 });
    take({ t: "play" });
    expect(stat()).toMatchObject({ pace: 0.1, pace_chosen: 0.1 });
    const begun = clock;
    pass(0.2);
    expect(lastFrame().time).toBeCloseTo((0.1 * (clock - begun)) / 1000, 3);
    take({ t: "pace", factor: null });
    expect(stat().pace_chosen).toBeNull();
  });

  it("takes no more substeps than are due, and a single one by hand", () => {
    take({ t: "pace", factor: 1 / 1000 });
    take({ t: "step", n: 1 });
    pass(1);
    const { frame, substeps } = stat();
    expect([frame, substeps]).toEqual([1, 1]);
    take({ t: "play" });
    pass(1);
    // A second at 1/1000 is a millisecond of time, some 13 substeps.
    expect(stat().time).toBeLessThan(0.0012);
    expect(stat().time).toBeGreaterThan(0.0008);
    take({ t: "pause" }); // tells the rows that wait
    expect(rows().length).toBe(stat().frames_stored);
  });

  it("ends where a hand touches the body, so that pulls are felt at once", () => {
    take({ t: "play" });
    pass(0.1);
    take({ t: "grab", id: 1, vertex: 57, target: [0.03, 0.01, 0.02], stiffness: 50 });
    expect(stat().pace).toBe(1);
  });

  it("leaves the motion as it is: looking ahead is not seen", () => {
    take({ t: "pace", factor: 1 });
    take({ t: "play" });
    expect(stat()).toMatchObject({ time: 0, substeps: 0, state: "playing" });
  });

  it("finds stored frames by their time, also where the pace has changed", () => {
    take({ t: "pace", factor: 1 / 50 });
    take({ t: "play" });
    pass(0.5);
    take({ t: "pace", factor: 1 });
    pass(20);
    take({ t: "ack", frame: 0 });
    take({ t: "seek", time: 0.005 });
    expect(stat().state).toBe("past");
    expect(stat().time).toBeCloseTo(0.005, 3);
  });
});

it("tells where the body is in itself as it is shown first, until it moves", async () => {
  const overlap: OverlapEvent = {
    ...{ t: "overlap", topology: 4, depth: 0.001, sentence: "walls overlap" },
    places: [{ depth: 0.001, rest: [0, 0, 0], now: [0, 0, 0] }],
  };
  const run = await Core.open(file("../../public/voxsoft.wasm"), file("beam.scene"));
  const heard: AnyEvent[] = [];
  const notes = { ...NOTES, overlap };
  const shown = new Player(run, notes, { event: (one) => heard.push(one), binary() {} });
  const told = () => heard.filter((one) => one.t === "overlap");
  shown.greet();
  expect(told()).toEqual([overlap]);
  for (const seq of [1, 2]) {
    shown.take({ t: "step", seq });
    shown.turn(1000 * seq);
  }
  expect(told()).toHaveLength(2);
  expect(told()[1]).toMatchObject({ topology: 4, sentence: "", places: [] });
});

it("tells where objects are as the body is shown first, until time runs or goes back", async () => {
  const pose = { position: [0, 0, 0.04] as Triple, rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1] };
  const moment: Moment = {
    ...{ frame: 0, time: 1, poses: [pose], contacts: [], fields: false, depth: null },
  };
  const run = await Core.open(file("../../public/voxsoft.wasm"), file("beam.scene"));
  const heard: AnyEvent[] = [];
  const notes = { ...NOTES, moment };
  const shown = new Player(run, notes, { event: (one) => heard.push(one), binary() {} });
  const told = () => heard.filter((one) => one.t === "moment");
  shown.greet();
  expect(told()).toEqual([{ t: "moment", topology: 4, moment }]);
  shown.take({ t: "pick", vertex: 57, seq: 1 });
  expect(told()).toHaveLength(1);
  shown.take({ t: "reset", seq: 2 });
  shown.take({ t: "reset", seq: 3 });
  expect(told()).toHaveLength(2);
  expect(told()[1]).toMatchObject({ moment: { frame: 0, poses: [] } });
});

it("reports the state shown first at rest in place, until something wakes it", async () => {
  const after = async (notes: Notes, ...commands: readonly Draft[]) => {
    const run = await Core.open(file("../../public/voxsoft.wasm"), file("beam.scene"));
    const heard: AnyEvent[] = [];
    const shown = new Player(run, notes, { event: (one) => heard.push(one), binary() {} });
    shown.greet();
    for (const [i, command] of commands.entries()) shown.take({ ...command, seq: i + 1 });
    return heard.filter((one) => one.t === "stat").at(-1)?.state;
  };
  const resting = { ...NOTES, at_rest: true };
  expect(await after(NOTES)).toBe("paused");
  expect(await after(resting)).toBe("at-rest");
  expect(await after(resting, { t: "pick", vertex: 57 })).toBe("at-rest");
  expect(await after(resting, { t: "play" })).toBe("playing");
  expect(await after(resting, { t: "load", index: 0, value: 5 })).not.toBe("at-rest");
  expect(await after(resting, { t: "reset" })).toBe("paused");
});
