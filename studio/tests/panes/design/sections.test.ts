import { expect, it } from "vitest";
import type { Schema } from "../../../src/panes/design/fields/schema";
import { wellFormed } from "../../../src/panes/design/sections";

const ROOT: Schema = {
  $defs: { Part: { properties: { shape: {} } } },
  properties: {
    parts: { type: "array", items: { $ref: "#/$defs/Part" } },
    shapes: { additionalProperties: { properties: {} } },
    solver: { properties: { method: {} } },
    name: { type: "string" },
  },
};

it("leaves out what is no list or table", () => {
  const source = { parts: 3, shapes: ["box"], solver: "statics", name: "arm" };
  expect(wellFormed(source, ROOT)).toEqual({ name: "arm" });
});

it("keeps the places of entries beside one that is no table", () => {
  const source = { parts: [1, { shape: "a" }] };
  expect(wellFormed(source, ROOT)).toEqual({ parts: [{}, { shape: "a" }] });
});

it("keeps what is right, and what the schema does not know", () => {
  const source = { parts: [{ shape: "a" }], shapes: {}, solver: {}, name: "arm", other: 1 };
  expect(wellFormed(source, ROOT)).toEqual(source);
});
