import { describe, expect, it } from "vitest";
import { changesOf, placeText, problemsAt } from "../../../src/panes/design/edits";
import { shapeTree } from "../../../src/panes/design/shapes/shapeTree";
import { tableAt, valueOffers } from "../../../src/panes/design/text/complete";
import { difference } from "../../../src/panes/design/text/editor";
import { placeAt } from "../../../src/panes/design/text/place";
import type { HelloEvent } from "../../../src/protocol";
import { root } from "./smallSchema";

/** The place of the bar in a text. */
function at(text: string) {
  return placeAt(text.replace("|", ""), text.indexOf("|"));
}

describe("placeAt", () => {
  it("tells keys from values, in sections and in tables on one line", () => {
    expect(at('[shapes]\nbody = { ki|nd = "box" }')).toMatchObject({
      at: "key",
      path: ["shapes", "body"],
      word: "ki",
    });
    expect(at('[shapes]\nbody = { kind = "bo|x" }')).toMatchObject({
      at: "value",
      path: ["shapes", "body", "kind"],
      word: "bo",
      quoted: true,
    });
  });
  it("counts the sections of a list and the entries of an array", () => {
    expect(at("[[loads]]\nkind = 1\n[[loads]]\nval|")).toMatchObject({ path: ["loads", 1] });
    expect(at('size = [1, "2 m|m"]')).toMatchObject({ at: "value", path: ["size", 1] });
    expect(at('size = [\n  1,\n  "2|"]')).toMatchObject({ path: ["size", 1] });
  });
  it("is not misled by comments, texts and brackets in them", () => {
    expect(at('a = "# [x" # b = {\nc|')).toMatchObject({ at: "key", path: [], word: "c" });
    expect(at("a = 1 # wh|y")).toMatchObject({ at: "comment" });
  });
  it("knows headers, and the text before", () => {
    expect(at("[sha|")).toMatchObject({ at: "header", word: "sha" });
    expect(at('[shapes]\nbody = { kind = "box", |').read).toEqual({
      shapes: { body: { kind: "box" } },
    });
  });
});

it("offers the keys of the kind that stands there", () => {
  const read = { shapes: { body: { kind: "box" } } };
  expect(Object.keys(tableAt(root, ["shapes", "body"], read)?.properties ?? {})).toContain("size");
  expect(Object.keys(tableAt(root, ["shapes", "new"], read)?.properties ?? {})).toEqual(["kind"]);
});

it("offers parameters in formulas, shapes where one is named", () => {
  const hello = { design_schema: root, metrics: [], materials: [] } as unknown as HelloEvent;
  const whole = { parameters: { wall: 1 }, shapes: { body: {} } };
  const formula = { path: ["voxel_size"], word: "= wa", quoted: true };
  expect(valueOffers(hello, formula, whole)).toEqual([{ label: "wall" }]);
  const named = { path: ["parts", 0, "shape"], word: "", quoted: true };
  expect(valueOffers(hello, named, whole)).toEqual([{ label: "body" }]);
});

it("orders shapes below their users, each once", () => {
  const shapes = {
    a: { kind: "box" },
    b: { kind: "union", of: ["a", "c"] },
    c: { kind: "shell", of: "a" },
  };
  expect(shapeTree(shapes)).toMatchObject([
    { name: "b", depth: 0, again: false },
    { name: "a", depth: 1, again: false },
    { name: "c", depth: 1, again: false },
    { name: "a", depth: 2, again: true },
  ]);
  // A circle is shown too, so that it can be fixed.
  const circle = { a: { of: "b" }, b: { of: "a" } };
  expect(shapeTree(circle).filter((node) => !node.again)).toHaveLength(2);
});

it("finds problems at a place and below it, not at one that begins alike", () => {
  const at = (where: string) => ({ where, what: "", hint: "", line: 1 }) as never;
  const found = [at("parts[1].material"), at("parts[10].material"), at("partsy")];
  expect(placeText(["parts", 1, "material"])).toBe("parts[1].material");
  expect(problemsAt(found, ["parts", 1])).toHaveLength(1);
  expect(problemsAt(found, ["parts"])).toHaveLength(2);
});

it("changes only the differences between two texts", () => {
  expect(difference("a = 1\nb = 2", "a = 13\nb = 2")).toEqual({ from: 5, to: 5, insert: "3" });
  expect(difference("aa", "aaa")).toEqual({ from: 2, to: 2, insert: "a" });
});

it("tells rows of the tree apart where a shape is used several times", () => {
  // Rows that React cannot tell apart stay on the page when their shapes are gone.
  const shapes = {
    block: { kind: "box" },
    one: { kind: "union", of: ["block", "block", "block"] },
    two: { kind: "union", of: ["block"] },
    all: { kind: "union", of: ["one", "two"] },
  };
  const rows = shapeTree(shapes).filter((node) => node.again);
  expect(rows).toHaveLength(3);
  expect(new Set(rows.map((row) => row.within)).size).toBe(3);
});

describe("changes of a table", () => {
  const path = ["objectives", "goal"];
  it("are those of keys, and leave equal values alone", () => {
    const before = { maximize: "mass", probe: "tip", axis: "z" };
    const after = { minimize: "mass", probe: "tip", axis: "x" };
    expect(changesOf(path, before, after)).toEqual([
      { path: [...path, "maximize"], value: null },
      { path: [...path, "minimize"], value: "mass" },
      { path: [...path, "axis"], value: "x" },
    ]);
  });
  it("are none between equal tables", () => {
    expect(changesOf(path, { list: [1, 2] }, { list: [1, 2] })).toEqual([]);
  });
});
