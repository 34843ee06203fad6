import { describe, expect, it } from "vitest";
import { removalOf } from "../../../src/panes/design/removing/removal";

const SOURCE = {
  parameters: {
    wall: { value: "2 mm", min: "1 mm" },
    gap: "= wall + 1 mm",
    double: "= 2*wall - wall_top",
    wall_top: "1 mm",
  },
  shapes: {
    outer: { kind: "box", size: ["40 mm", "= wall", "= 2*wall"] },
    hole: { kind: "sphere", radius: "5 mm" },
    hollow: { kind: "difference", of: ["outer", "hole"] },
    moved: { kind: "translate", of: "hole", by: [0, 0, "1 mm"] },
  },
  parts: [
    { shape: "hollow", material: "soft" },
    { shape: "hole", material: "stiff", name: "core" },
  ],
  materials: { soft: { model: "neo-hookean" }, stiff: { model: "rigid" } },
  activations: [{ kind: "swelling", part: "core", value: 0.1, history: "slow" }],
  clamps: [{ region: { z: [0, 0] } }, { region: { shape: "moved" }, name: "hole" }],
  histories: { slow: { time: ["1 s"], factor: [1] } },
  probes: { hole: { point: [0, 0, 0] }, tip: { point: [0, 0, 1] } },
  objectives: { bend: { maximize: "displacement", probe: "hole" } },
  contact: { pairs: [{ of: ["hole", "cube"], friction: 0.5 }] },
};

describe("an entry that goes", () => {
  it("takes along all that is made of it, and leaves others of its name", () => {
    const { along, kept, changes } = removalOf(SOURCE, ["shapes", "hole"]);
    expect(along).toEqual(["shape moved", "part 2 (core)", "clamp 2 (hole)", "activation 1"]);
    expect(kept).toEqual(["shape hollow"]);
    expect(changes[0]).toEqual({ path: ["shapes", "hollow", "of"], value: ["outer"] });
    expect(changes.slice(1).map(({ path }) => path.join("."))).toEqual([
      "shapes.hole",
      "shapes.moved",
      "parts.1",
      "clamps.1",
      "activations.0",
    ]);
  });

  it("takes along a difference of which it is the first operand", () => {
    const { along, kept } = removalOf(SOURCE, ["shapes", "outer"]);
    expect(along).toEqual(["shape hollow", "part 1 (hollow)"]);
    expect(kept).toEqual([]);
  });

  it("takes nothing along that can be without it", () => {
    const { along, kept, changes } = removalOf(SOURCE, ["histories", "slow"]);
    expect(along).toEqual([]);
    expect(kept).toEqual(["activation 1"]);
    expect(changes).toEqual([
      { path: ["activations", 0, "history"], value: null },
      { path: ["histories", "slow"], value: null },
    ]);
  });

  it("leaves its value in formulas, where it is a parameter", () => {
    const { along, changes } = removalOf(SOURCE, ["parameters", "wall"]);
    expect(along).toEqual([]);
    expect(changes.slice(0, -1).map(({ value }) => value)).toEqual([
      "= 2 mm + 1 mm",
      "= 2*2 mm - wall_top",
      "2 mm",
      "= 2*2 mm",
    ]);
    const gap = removalOf({ ...SOURCE, loads: [{ value: "= 2*gap" }] }, ["parameters", "gap"]);
    expect(gap.changes[0]?.value).toBe("= 2*(wall + 1 mm)");
  });

  it("takes the goals of a probe along", () => {
    expect(removalOf(SOURCE, ["probes", "hole"]).along).toEqual(["objective bend"]);
    expect(removalOf(SOURCE, ["probes", "tip"]).changes).toHaveLength(1);
  });

  it("removes later entries of a list first", () => {
    const source = {
      parts: [1, 2, 3].map((i) => ({ name: `p${i}`, shape: "a" })),
      shapes: { a: {} },
    };
    const { changes } = removalOf(source, ["shapes", "a"]);
    expect(changes.map(({ path }) => path.join("."))).toEqual([
      "shapes.a",
      "parts.2",
      "parts.1",
      "parts.0",
    ]);
  });
});
