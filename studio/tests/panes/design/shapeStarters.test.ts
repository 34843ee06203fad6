import { expect, it } from "vitest";
import { type Spot, shapeStarter, spotOn } from "../../../src/panes/design/shapes/shapeStarters";
import STARTERS from "../../../src/panes/design/shapes/shapeStarters.json";
import { SHAPE_KINDS } from "../../../src/protocol";

const ON_TOP: Spot = { side: 0.02, middle: [0.03, 0.02, 0.02], operands: ["hole", "block"] };

it("knows every kind", () => {
  expect(Object.keys(STARTERS).sort()).toEqual([...SHAPE_KINDS].sort());
});

it("puts a shape on the body, as large as half of it", () => {
  const spot = spotOn({ low: [0, 0, 0], high: [0.06, 0.04, 0.02] }, 0.005, []);
  expect(spot).toEqual({ side: 0.018, middle: [0.03, 0.02, 0.02], operands: [] });
  // One of less than two voxels would be a lump.
  expect(spotOn({ low: [0, 0, 0], high: [0.01, 0.01, 0.01] }, 0.005, []).side).toBe(0.01);
  expect(shapeStarter("tube", ON_TOP)).toEqual({
    ...{ kind: "tube", radius: "10 mm", wall: "3 mm", height: "20 mm" },
    base: ["30 mm", "20 mm", "10 mm"],
  });
  expect(shapeStarter("capsule", ON_TOP)).toMatchObject({
    start: ["20 mm", "20 mm", "20 mm"],
    end: ["40 mm", "20 mm", "20 mm"],
  });
});

it("leaves the place of a first shape to its kind", () => {
  const first: Spot = { side: 0.04, middle: null, operands: [] };
  expect(shapeStarter("box", first)).toEqual({ kind: "box", size: ["40 mm", "40 mm", "40 mm"] });
  expect(shapeStarter("shell", first)).toMatchObject({ of: { kind: "sphere" } });
});

it("makes combining shapes of the shape that is chosen, and of the next", () => {
  expect(shapeStarter("difference", ON_TOP)).toEqual({ kind: "difference", of: ["hole", "block"] });
  expect(shapeStarter("translate", ON_TOP)).toEqual({
    ...{ kind: "translate", of: "hole", by: ["10 mm", 0, 0] },
  });
});
