import { expect, it } from "vitest";
import { numberNames, profileAt } from "../../../src/panes/design/fields/pairs";

const SOURCE = {
  shapes: {
    cup: { kind: "revolve", points: [[0, 0]] },
    bar: { kind: "difference", of: [{ kind: "prism", points: [[0, 0]] }, "cup"] },
  },
};

it("names the coordinates of a profile by its shape, at any depth", () => {
  expect(profileAt(SOURCE, ["shapes", "cup", "points"])).toEqual(["radius", "height"]);
  expect(profileAt(SOURCE, ["shapes", "bar", "of", 0, "points"])).toEqual(["x", "y"]);
  expect(numberNames(SOURCE, ["shapes", "cup", "points", 0], 2)).toEqual(["radius", "height"]);
});

it("names the ends of a stretch, and three coordinates", () => {
  expect(profileAt(SOURCE, ["clamps", 0, "region", "x"])).toBeNull();
  expect(numberNames(SOURCE, ["clamps", 0, "region", "x"], 2)).toEqual(["from", "to"]);
  expect(numberNames(SOURCE, ["shapes", "cup", "center"], 3)).toEqual(["x", "y", "z"]);
});
