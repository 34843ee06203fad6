import { describe, expect, it } from "vitest";
import { frictionEdit } from "../../../src/panes/design/bodies/gripped";
import {
  isNumber,
  parameterName,
  promoted,
  promotedTo,
} from "../../../src/panes/design/parameters/promote";

const SOURCE = {
  parameters: { pressure: "1 kPa" },
  shapes: { "box-whole": { kind: "box", size: ["30 mm", "40 mm", "100 mm"] } },
  loads: [{ kind: "pressure", value: "10 kPa" }],
  objects: [{ name: "ball", shape: { kind: "sphere", radius: "18 mm" }, mass: "20 g" }],
  clamps: [{ motion: { displacement: [0, 0, "40 mm"] } }],
  contact: { friction: 0.8 },
};

describe("a number that becomes a parameter", () => {
  it("is named after its place", () => {
    const name = (...path: (string | number)[]) => parameterName(path, SOURCE);
    expect(name("loads", 0, "value")).toBe("pressure");
    expect(name("objects", 0, "shape", "radius")).toBe("ball_radius");
    expect(name("shapes", "box-whole", "size", 2)).toBe("box_whole_size_z");
    expect(name("clamps", 0, "motion", "displacement", 2)).toBe("clamp_displacement_z");
    expect(name("contact", "friction")).toBe("friction");
    expect(name("voxel_size")).toBe("voxel_size");
  });

  it("has bounds around it, and a formula in its place", () => {
    expect(promoted(["loads", 0, "value"], "10 kPa", SOURCE)).toEqual([
      {
        path: ["parameters", "pressure_2"],
        value: { value: "10 kPa", min: "5 kPa", max: "15 kPa" },
      },
      { path: ["loads", 0, "value"], value: "= pressure_2" },
    ]);
    expect(promoted(["contact", "friction"], 0.8, SOURCE)[0]?.value).toEqual({
      ...{ value: 0.8, min: 0.4, max: 1.2 },
    });
    expect(promoted(["loads", 0, "value"], "-2 N", {})[0]?.value).toEqual({
      ...{ value: "-2 N", min: "-3 N", max: "-1 N" },
    });
    expect(promoted(["loads", 0, "value"], 0, {})[0]?.value).toEqual({ value: 0 });
  });

  it("has the name that is asked for, and goes where a formula is put", () => {
    const put = (formula: string) => frictionEdit(undefined, "my ball", 2, formula, ["body"]);
    expect(promotedTo("friction_my ball", 0.8, {}, put)).toEqual([
      { path: ["parameters", "friction_my_ball"], value: { value: 0.8, min: 0.4, max: 1.2 } },
      {
        path: ["contact"],
        value: { pairs: [{ of: ["body", "my ball"], friction: "= friction_my_ball" }] },
      },
    ]);
  });

  it("is called by the goal for the bound of a goal", () => {
    const source = { constraints: { reach: { metric: "displacement", min: "5 mm" } } };
    expect(promoted(["constraints", "reach", "min"], "5 mm", source)).toEqual([
      {
        path: ["parameters", "reach_min"],
        value: { value: "5 mm", min: "2.5 mm", max: "7.5 mm" },
      },
      { path: ["constraints", "reach", "min"], value: "= reach_min" },
    ]);
  });

  it("is a number, not a formula or a word", () => {
    expect(isNumber("12 kPa")).toBe(true);
    expect(isNumber("= wall")).toBe(false);
    expect(isNumber("inf")).toBe(false);
    expect(promoted(["a"], "auto", {})).toEqual([]);
  });
});
