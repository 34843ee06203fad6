import { describe, expect, it } from "vitest";
import { listed, modelsOf, shoreOrder, testedAndBeyond } from "../../src/panes/materials/list";
import { copied, given, isUsed, mixes, partsOf, refusal } from "../../src/panes/materials/use";
import type { MaterialFacts } from "../../src/protocol";

const plain: MaterialFacts = {
  name: "soft",
  title: "",
  origin: "card",
  same_as: "",
  choice: "",
  model: "yeoh",
  live: "implicit",
  shore: "",
  young: 60e3,
  density: 1070,
  tested_from: null,
  tested_to: null,
  elongation_at_break: null,
  stress_at_double: 40e3,
  source: "",
  caution: "",
  license: "",
  stretches: [1, 2, 3, 4],
  stresses: [0, 1, 2, 3],
  table: { model: "yeoh", c: ["10 kPa"] },
};
const eco: MaterialFacts = { ...plain, name: "ecoflex", shore: "00-30", same_as: "ecoflex-epfl" };
const dragon: MaterialFacts = {
  ...plain,
  name: "dragon",
  shore: "10A",
  young: 260e3,
  tested_to: 3,
};
const springs: MaterialFacts = { ...plain, name: "springs", model: "lattice", live: "explicit" };
const mine: MaterialFacts = { ...plain, name: "zeta", origin: "design" };
const all = [dragon, eco, springs, mine];

const names = (found: readonly MaterialFacts[]) => found.map(({ name }) => name);
const two = {
  parts: [
    { shape: "wall", material: "ecoflex-epfl" },
    { shape: { kind: "box" }, material: "springs", name: "tip" },
  ],
};
const [wall, tip] = partsOf(two) as [ReturnType<typeof partsOf>[0], ReturnType<typeof partsOf>[0]];

describe("the list of materials", () => {
  it("shows the design's own first, and takes every word of a search", () => {
    expect(names(listed(all, "", "", "name"))).toEqual(["zeta", "dragon", "ecoflex", "springs"]);
    expect(names(listed(all, "yeoh 00-30", "", "name"))).toEqual(["ecoflex"]);
    expect(names(listed(all, "", "lattice", "name"))).toEqual(["springs"]);
    expect(modelsOf(all)).toEqual(["lattice", "yeoh"]);
  });

  it("puts unstated values last", () => {
    expect(names(listed(all, "", "", "shore")).slice(0, 2)).toEqual(["ecoflex", "dragon"]);
    expect(names(listed(all, "", "", "tested"))[0]).toBe("dragon");
    expect(names(listed(all, "", "", "young")).at(-1)).toBe("dragon");
  });

  it("orders Shore hardness over its scales", () => {
    const shores = ["40D", "00-50", "2A", "00-10", "10A"];
    const sorted = shores.toSorted((a, b) => (shoreOrder(a) ?? 0) - (shoreOrder(b) ?? 0));
    expect(sorted).toEqual(["00-10", "00-50", "2A", "10A", "40D"]);
    expect(shoreOrder("")).toBeNull();
  });

  it("parts a curve where the test ended", () => {
    expect(testedAndBeyond(dragon)[2]).toBe(3);
    expect(testedAndBeyond(eco)[2]).toBe(0);
  });
});

describe("material of a part", () => {
  it("knows a part by its name, its shape or its place", () => {
    expect([wall.name, tip.name]).toEqual(["wall", "tip"]);
    expect(partsOf({ parts: [{ shape: { kind: "box" } }] })[0]?.name).toBe("part 1");
  });

  it("knows a material by the card that it stands for, and a file by its path", () => {
    expect(isUsed(eco, wall)).toBe(true);
    expect(isUsed(dragon, wall)).toBe(false);
    const file: MaterialFacts = { ...plain, origin: "file", name: "/robots/mine.toml" };
    expect(isUsed(file, { ...wall, material: "./mine.toml" })).toBe(true);
    expect(given(file, wall, "/robots").value).toBe("mine.toml");
    expect(given(dragon, tip, "/robots")).toEqual({
      path: ["parts", 1, "material"],
      value: "dragon",
    });
  });

  it("warns before a lattice stands beside rubber", () => {
    const parts = partsOf(two);
    expect(mixes(dragon, wall, parts, all)).toMatch(/rubber with a spring lattice of tip/);
    expect(mixes(springs, wall, parts, all)).toBe("");
    expect(mixes(springs, tip, parts, all)).toMatch(/spring lattice with rubber of wall/);
    expect(mixes({ ...plain, live: "none" }, wall, parts, all)).toBe("");
  });

  it("refuses the combinations of the core, before they are tried", () => {
    const wound = { ...wall, fibers: true };
    expect(refusal(springs, wound)).toMatch(/fibers of wall need a hyperelastic/);
    expect(refusal(eco, wound)).toBeNull();
    expect(refusal(springs, wall)).toBeNull();
  });

  it("copies a card under a name that is free", () => {
    const source = { materials: { "ecoflex-own": {} } };
    const { name, change } = copied(eco, source, []);
    expect(name).toBe("ecoflex-own-2");
    expect(change).toEqual({ path: ["materials", "ecoflex-own-2"], value: eco.table });
  });
});
