import { expect, it } from "vitest";
import { firstFound, foundGroups, SHAPE_GROUPS } from "../../../src/panes/design/shapes/shapeKinds";
import { FEATURES, SHAPE_KINDS } from "../../../src/protocol";

const all = SHAPE_GROUPS.flatMap((group) => group.kinds);
const about = (kind: string) => (kind === "tube" ? "A cylinder with a hole along its axis." : "");

it("has every kind of the schema, and every feature, in one group", () => {
  expect([...all].sort()).toEqual([...SHAPE_KINDS, ...Object.keys(FEATURES)].sort());
});

it("finds kinds by name, by group and by description", () => {
  const found = (search: string) =>
    foundGroups(search, SHAPE_GROUPS, about).flatMap((group) => group.kinds);
  expect(found("")).toEqual(all);
  expect(found("SPHERE")).toEqual(["sphere"]);
  expect(found("combine")).toEqual(["union", "difference", "intersection", "blend"]);
  expect(found("hole")).toEqual(["tube"]);
  expect(found("rounded lattices")).toEqual([]);
});

it("chooses the name that begins as the search does", () => {
  expect(firstFound("", ["box", "tube"])).toBe(0);
  expect(firstFound("s", ["box", "half-space", "sphere"])).toBe(2);
  expect(firstFound("space", ["box", "half-space"])).toBe(1);
  expect(firstFound("hole", ["tube"])).toBe(0);
});
