import { describe, expect, it } from "vitest";
import {
  controlOf,
  entryLabel,
  helpOfKeys,
  optionFor,
  type Schema,
  schemaAt,
} from "../../../src/panes/design/fields/schema";
import {
  changeVariant,
  freeName,
  materialName,
  starter,
} from "../../../src/panes/design/fields/starters";
import { length, root, shape } from "./smallSchema";

const part = (key: string): Schema => root.$defs?.Part?.properties?.[key] ?? {};
const names = { shapes: ["body"], materials: [] };

describe("controlOf", () => {
  it("reads quantities, with the words that are allowed beside them", () => {
    expect(controlOf(root, length)).toEqual({ is: "quantity", kind: "length", words: [] });
    expect(controlOf(root, part("damping"))).toEqual({
      is: "quantity",
      kind: "rate",
      words: ["auto", "critical"],
    });
  });
  it("takes a count that may be a formula for a number", () => {
    expect(controlOf(root, part("steps"))).toMatchObject({ is: "quantity", kind: "number" });
  });
  it("tells names of shapes from shapes, and leaves out functions of Python", () => {
    expect(controlOf(root, part("shape"))).toMatchObject({ is: "reference", to: "shapes" });
    const variant = controlOf(root, shape);
    expect(variant.is === "variant" && Object.keys(variant.variants)).toEqual(["box", "union"]);
  });
  it("finds which of two forms a value has", () => {
    const either = controlOf(root, part("pressure"));
    if (either.is !== "either") throw new Error(either.is);
    expect(optionFor(root, either.options, "4 kPa")).toBe(0);
    expect(optionFor(root, either.options, ["1 mm"])).toBe(1);
  });
});

it("follows a path through lists, names and kinds", () => {
  const document = { shapes: { body: { kind: "box" } } };
  expect(schemaAt(root, ["shapes", "body", "size", 1], document)).toMatchObject({
    "x-kind": "length",
  });
  expect(schemaAt(root, ["parts", 3, "seal"], document)).toMatchObject({ type: "boolean" });
  expect(schemaAt(root, ["shapes", "body", "radius"], document)).toBeNull();
});

it("says which shape of a difference is taken from which", () => {
  expect([0, 1, 2].map((i) => entryLabel("difference", i))).toEqual(["From", "Minus", "Minus"]);
  expect([0, 1].map((i) => entryLabel("union", i))).toEqual(["1", "2"]);
});

it("reads the help of each key from the description", () => {
  const help = helpOfKeys(root.$defs?.Box ?? {});
  expect(help.size).toBe("Its edges.");
  expect(help.center).toBe("Where it is.");
  expect(help.Examples).toBeUndefined();
  const description = "A.\n\nParameters\n----------\nedge\n    Of ``E``, see :meth:`~a.b.young`.";
  expect(helpOfKeys({ description }).edge).toBe("Of E, see young.");
});

describe("starters", () => {
  it("give all that is required and no more", () => {
    expect(starter(root, root.$defs?.Box ?? {}, names)).toEqual({
      size: ["10 mm", "10 mm", "10 mm"],
    });
    expect(starter(root, { $ref: "#/$defs/Part" }, names)).toEqual({ shape: "body" });
  });
  it("keep all that a change of kind can keep", () => {
    const box = root.$defs?.Box ?? {};
    const before = { kind: "cone", center: [0, 0, 1], radius: 2 };
    expect(changeVariant({ kind: "box", size: 1 }, box, before, "kind")).toEqual({
      kind: "box",
      size: 1,
      center: [0, 0, 1],
    });
  });
  it("name a material after its model", () => {
    expect(materialName({ model: "rigid" })).toBe("rigid");
    expect(materialName({ model: "yeoh", c10: "17 kPa" })).toBe("rubber");
  });
  it("find free names", () => {
    expect(freeName("box", ["ball"])).toBe("box");
    expect(freeName("box", ["box", "box-2"])).toBe("box-3");
  });
});
