import { describe, expect, it } from "vitest";
import { motionOf, SCHEMES, type Scheme, schemeWords } from "../../src/view/hands/schemes";

const press = (button: number, held = "") => ({
  button,
  shiftKey: held === "shift",
  ctrlKey: held === "ctrl",
  metaKey: false,
});

describe("actions of the mouse in the view", () => {
  it.each<[Scheme, number, string, string | null]>([
    ["voxsoft", 2, "", "turn"],
    ["voxsoft", 1, "", "move"],
    ["onshape", 2, "", "turn"],
    ["onshape", 2, "ctrl", "move"],
    ["onshape", 1, "", "move"],
    ["solidworks", 1, "", "turn"],
    ["solidworks", 1, "ctrl", "move"],
    ["solidworks", 1, "shift", "zoom"],
    ["solidworks", 2, "", null],
    ["blender", 1, "", "turn"],
    ["blender", 1, "shift", "move"],
    ["blender", 1, "ctrl", "zoom"],
  ])("in %s, button %i with %s", (scheme, button, held, motion) => {
    expect(motionOf(scheme, press(button, held))).toBe(motion);
  });

  it("can always be done beside the body with one button", () => {
    for (const { value } of SCHEMES) {
      expect(motionOf(value, press(0))).toBe("turn");
      expect(motionOf(value, press(0, "shift"))).toBe("move");
    }
  });

  it("is told in words", () => {
    expect(schemeWords("blender")).toContainEqual([
      "Move the view",
      "Shift + middle button, or Shift + left button beside the body",
    ]);
    expect(schemeWords("onshape").map(([what]) => what)).toEqual([
      "Turn the view",
      "Move the view",
    ]);
  });
});
