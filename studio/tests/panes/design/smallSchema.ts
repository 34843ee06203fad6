// A small schema in the form in which pydantic writes that of a design.
import type { Schema } from "../../../src/panes/design/fields/schema";

export const length: Schema = { type: ["string", "number"], "x-kind": "length" };
export const shape: Schema = {
  discriminator: {
    propertyName: "kind",
    mapping: { box: "#/$defs/Box", union: "#/$defs/Union", function: "#/$defs/Function" },
  },
  oneOf: [{ $ref: "#/$defs/Box" }, { $ref: "#/$defs/Union" }, { $ref: "#/$defs/Function" }],
};
export const root: Schema = {
  $defs: {
    Box: {
      description:
        "A box.\n\nParameters\n----------\nsize\n    Its edges.\ncorner, center\n    Where\n    it is.\n\nExamples\n--------\n>>> 1",
      properties: {
        kind: { const: "box", type: "string" },
        size: { type: "array", prefixItems: [length, length, length] },
        center: {
          anyOf: [{ prefixItems: [length, length, length], type: "array" }, { type: "null" }],
        },
      },
      required: ["size"],
      type: "object",
    },
    Union: {
      properties: {
        kind: { const: "union", type: "string" },
        of: { type: "array", items: { anyOf: [{ type: "string" }, shape] } },
      },
      required: ["of"],
      type: "object",
    },
    Function: { properties: { kind: { const: "function" }, function: {} }, type: "object" },
    Part: {
      properties: {
        shape: { anyOf: [{ type: "string" }, shape] },
        pressure: { anyOf: [{ "x-kind": "pressure" }, { type: "array", prefixItems: [length] }] },
        damping: {
          anyOf: [
            { anyOf: [{ enum: ["auto", "critical"], type: "string" }, { "x-kind": "rate" }] },
            { type: "null" },
          ],
        },
        steps: {
          anyOf: [
            { anyOf: [{ type: "integer" }, { type: "string", pattern: "^=" }] },
            { type: "null" },
          ],
        },
        seal: { type: "boolean", default: false },
      },
      required: ["shape"],
      type: "object",
    },
  },
  properties: {
    voxel_size: length,
    shapes: { type: "object", additionalProperties: shape },
    parts: { type: "array", items: { $ref: "#/$defs/Part" } },
  },
};
