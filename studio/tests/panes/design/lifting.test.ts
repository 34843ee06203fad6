import { describe, expect, it } from "vitest";
import { lifting, liftOf } from "../../../src/panes/design/bodies/lifting";
import type { Room } from "../../../src/panes/design/bodies/placing";

const BODY: Room = { low: [-0.07, 0, 0], high: [0.03, 0.04, 0.1] };
const BALL: Room = { low: [-0.038, 0.002, -0.003], high: [-0.002, 0.038, 0.033] };
const GRIPPER = {
  clamps: [{ region: { z: ["100 mm", "100 mm"] } }],
  loads: [{ kind: "pressure", value: "10 kPa" }],
};
const values = (source: Record<string, unknown>, ball = BALL) =>
  new Map(lifting(source, ball, BODY, 0.005).map(({ path, value }) => [path.join("."), value]));

describe("gripping and lifting", () => {
  it("closes, then lifts by the height of the object, over time", () => {
    const found = values(GRIPPER);
    expect(liftOf(BALL)).toBe(0.04);
    expect(found.get("loads.0.history")).toBe("close");
    expect(found.get("clamps.0.motion")).toEqual({
      displacement: [0, 0, "40 mm"],
      history: "lift",
    });
    expect(found.get("histories.close")).toEqual({ time: ["0.1 s", "0.4 s"], factor: [0, 1] });
    expect(found.get("loads.1")).toEqual({ kind: "gravity", history: "weight" });
    expect(found.get("solver")).toMatchObject({ method: "dynamics", end_time: "1 s" });
  });

  it("puts a floor under the lowest object, and else lets weight come when it is held", () => {
    const found = values(GRIPPER);
    expect(found.get("floor")).toEqual({ z: "-3.05 mm" });
    expect(found.get("histories.weight")).toMatchObject({ time: ["0 s", "0.1 s"] });
    const high: Room = { low: [-0.038, 0.002, 0.04], high: [-0.002, 0.038, 0.076] };
    const held = values(GRIPPER, high);
    expect(held.has("floor")).toBe(false);
    expect(held.get("histories.weight")).toMatchObject({ time: ["0.4 s", "0.5 s"] });
  });

  it("leaves things with a history or a motion, and names used by others", () => {
    const source = {
      histories: { lift: { time: ["1 s"], factor: [1] } },
      clamps: [{ region: {}, motion: {} }, { region: {}, axes: "x" }, { region: {} }],
      loads: [{ kind: "pressure", history: "slow" }, { kind: "gravity" }],
      solver: { method: "statics", steps: 3, error: "off" },
    };
    const found = values(source);
    expect([...found.keys()].filter((key) => key.startsWith("clamps"))).toEqual([
      "clamps.2.motion",
    ]);
    expect(found.has("histories.lift")).toBe(false);
    expect(found.has("loads.0.history")).toBe(false);
    expect(found.get("loads.1.history")).toBe("weight");
    expect(found.get("solver")).toMatchObject({ error: "off", method: "dynamics" });
    expect(found.get("solver")).not.toHaveProperty("steps");
  });

  it("is not offered where nothing could go up", () => {
    expect(values({ loads: [] }).size).toBe(0);
    expect(values({ ...GRIPPER, bodies: [{}] }).size).toBe(0);
  });
});
