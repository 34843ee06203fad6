import { expect, it } from "vitest";
import {
  besideOf,
  beyondOf,
  bodyNames,
  entryOf,
  isOf,
  roomOf,
} from "../../../src/panes/design/bodies/several";
import type { BodyEvent } from "../../../src/protocol";
import { partColors, verticesOf } from "../../../src/view/marks/several";

const part = (body: string) => ({ name: body, material: "soft", color: "#808080", body });

/** Two fingers, of which one is a pair, and nothing else. */
const HAND = {
  bounds: [
    [-0.03, 0, 0],
    [0.05123, 0.01, 0.01],
  ],
  voxel_size: 0.002,
  objects: [],
  parts: [part("left"), part("pair.a"), part("pair.b")],
  bodies: [
    {
      name: "left",
      bounds: [
        [-0.03, 0, 0],
        [-0.01, 0.01, 0.01],
      ],
      vertices: [0, 9],
    },
    {
      name: "pair.a",
      bounds: [
        [0, 0, 0],
        [0.02, 0.01, 0.01],
      ],
      vertices: [10, 19],
    },
    {
      name: "pair.b",
      bounds: [
        [0.03, 0, 0],
        [0.05123, 0.01, 0.005],
      ],
      vertices: [20, 29],
    },
  ],
} as unknown as BodyEvent;

it("knows the vertices of an entry of the form", () => {
  expect(isOf("pair.a", "pair")).toBe(true);
  expect(isOf("pairs.a", "pair")).toBe(false);
  expect(isOf("left", null)).toBe(false);
  expect(entryOf("pair.b", ["left", "pair"])).toBe("pair");
  expect(bodyNames({ bodies: [{ name: "left" }, { name: "pair" }] })).toEqual(["left", "pair"]);
  expect(bodyNames({ parts: [{}] })).toEqual(["body"]);
});

it("finds the room and the vertices of a body and of those of its design", () => {
  expect(roomOf("pair", HAND)).toEqual({ low: [0, 0, 0], high: [0.05123, 0.01, 0.01] });
  expect(roomOf("thumb", HAND)).toBeNull();
  expect(verticesOf(HAND, "pair")).toEqual([10, 29]);
  expect(verticesOf(HAND, "thumb")).toBeNull();
});

it("puts a copy beyond all that there is, at a length that can be read", () => {
  expect(beyondOf(HAND)).toBe(0.0533);
  expect(besideOf("left", HAND)).toEqual([0.0833, 0, 0]);
  expect(besideOf("pair", HAND)).toEqual([0.0533, 0, 0]);
  const one = { ...HAND, bodies: [] };
  expect(besideOf("body", one)).toEqual([0.0833, 0, 0]);
});

it("marks the parts of a chosen body alone", () => {
  expect(partColors(HAND, null)).toEqual(["#808080", "#808080", "#808080"]);
  const [left, a, b] = partColors(HAND, "pair");
  expect(left).toBe("#808080");
  expect(a).not.toBe("#808080");
  expect(b).toBe(a);
});
