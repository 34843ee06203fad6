import { describe, expect, it } from "vitest";
import { changeable, overText, stiffnessNote } from "../../src/panes/path/lines";
import type { Parameter } from "../../src/protocol";

const DESIGN = {
  loads: [
    { kind: "pressure", value: 4000, cavity: "left" },
    { kind: "force", value: [0, 0, -2], region: {} },
    { kind: "magnetic_field", value: [0, 0, 0] },
  ],
  tendons: [{ name: "flexor", tension: 0.5 }],
  activations: [{ kind: "thermal", part: "gel", value: 350, reference: 293 }],
  clamps: [{ motion: null }, { motion: { displacement: [0.01, 0, 0] } }],
};

function parameter(name: string, kind: string, value: number, formula = false): Parameter {
  const rest = { min: null, max: null, step: null, display_unit: "", factor: 1, former: null };
  return { name, kind, value, text: "", formula, description: "", ...rest };
}

describe("changeable", () => {
  it("finds loads by component, tendons, activations, motions and parameters", () => {
    const found = changeable(DESIGN, [
      parameter("reach", "length", 0.02),
      parameter("twice", "length", 0.04, true),
    ]);
    expect(found.map((one) => [one.key, one.label, one.kind])).toEqual([
      ["loads[0].value", "pressure in left", "pressure"],
      ["loads[1].value[2]", "force along z", "force"],
      ["loads[2].value[0]", "magnetic field along x", "magnetic field"],
      ["loads[2].value[1]", "magnetic field along y", "magnetic field"],
      ["loads[2].value[2]", "magnetic field along z", "magnetic field"],
      ["tendons[0].tension", "tension of flexor", "force"],
      ["activations[0].value", "thermal of gel", "temperature"],
      ["clamps[1].motion.displacement[0]", "motion of clamp 2 along x", "length"],
      ["reach", "parameter reach", "length"],
    ]);
    // Heat begins where the part has its size: at zero kelvin there is nothing to solve.
    expect(found.find((one) => one.kind === "temperature")?.start).toBe(293);
  });
});

describe("time", () => {
  const rubber = { materials: { soft: { model: "yeoh", prony: [{ g: 0.2, tau: 3 }] } } };

  it("is offered where rubber relaxes, for five of its times, or where a history is followed", () => {
    const times = (design: object) =>
      changeable({ ...design }, []).flatMap((one) => (one.key === "time" ? [one.value] : []));
    expect(times(DESIGN)).toEqual([]);
    expect(times(rubber)).toEqual([15]);
    expect(times({ ...rubber, loads: [{ history: { time: [0, 40], factor: [0, 1] } }] })).toEqual([
      40,
    ]);
    const [time] = changeable(rubber, []);
    expect(time && overText(time, 0, 15, 4)).toBe("time=0..15 s/4");
  });

  it("says which stiffness rubber that relaxes has", () => {
    expect(stiffnessNote(DESIGN, "time")).toBeNull();
    expect(stiffnessNote(rubber, "time")).toContain("instantaneous");
    expect(stiffnessNote(rubber, "loads[0].value")).toContain("long-term");
  });
});

describe("overText", () => {
  it("writes a range with the unit of its kind", () => {
    const [pressure, , , , field] = changeable(DESIGN, []);
    expect(pressure && overText(pressure, 0, 30e3, 16)).toBe("loads[0].value=0..30 kPa/16");
    expect(field && overText(field, -0.0125, 0.0125, 5)).toBe("loads[2].value[2]=-12.5..12.5 mT/5");
    const count = { key: "n", label: "", kind: "number", value: 1, start: 0 };
    expect(overText(count, 0, 0.3, 4)).toBe("n=0..0.3/4");
  });
});
