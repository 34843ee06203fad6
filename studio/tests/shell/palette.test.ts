import { describe, expect, it } from "vitest";
import { reachActions } from "../../src/shell/reach";
import { scoreOf } from "../../src/shell/Sheets";

const ALL = reachActions(() => {});

function first(query: string): string | undefined {
  return ALL.map((action) => ({ title: action.title, score: scoreOf(query, action) }))
    .filter((one) => one.score > 0)
    .sort((a, b) => b.score - a.score)[0]?.title;
}

describe("the palette", () => {
  it.each([
    ["stl", "Export surface (.stl)"],
    ["mirror", "Add a shape: mirror"],
    ["clamp", "Add a clamp"],
    ["add box", "Add a shape: box"],
    ["thickness", "Check the body: thinnest walls, cavities, volumes"],
    ["tensile", "Fit a material to tensile tests"],
    ["calibrate", "Calibrate a material on a measured specimen"],
    ["fixture", "Add a clamp"],
  ])("finds by %s an action, not a pane", (query, title) => {
    expect(first(query)).toBe(title);
  });

  it("takes words in any order, and letters of a title in theirs", () => {
    expect(first("shape box")).toBe("Add a shape: box");
    expect(first("addclamp")).toBe("Add a clamp");
  });
});
