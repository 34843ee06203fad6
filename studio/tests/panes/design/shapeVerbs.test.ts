import { describe, expect, it } from "vitest";
import type { Room } from "../../../src/panes/design/bodies/placing";
import {
  FIRST_MATERIAL,
  isMadeOf,
  isUsed,
  joined,
  shapeVerbs,
  withShape,
} from "../../../src/panes/design/shapes/shapeVerbs";

const ROOM: Room = { low: [0, 0, 0], high: [0.04, 0.04, 0.04] };
const BOX = { kind: "box", size: ["40 mm", "40 mm", "40 mm"] };
const SOURCE = { shapes: { box: BOX }, parts: [{ shape: "box", material: "ecoflex-00-50" }] };

const verb = (label: string, source: Record<string, unknown> = SOURCE, name = "box") =>
  shapeVerbs(name, source, ROOM, 0.005).find((one) => one.label === label)?.changes;

describe("a new shape", () => {
  it("is a part and seen, where it is the first", () => {
    const { changes } = withShape(BOX, {});
    expect(changes).toEqual([
      { path: ["shapes", "box"], value: BOX },
      { path: ["parts", 0], value: { shape: "box", material: FIRST_MATERIAL } },
    ]);
  });

  it("is a shape alone beside others, under a free name", () => {
    expect(withShape(BOX, SOURCE)).toEqual({
      name: "box-2",
      changes: [{ path: ["shapes", "box-2"], value: BOX }],
    });
  });
});

describe("actions with a shape", () => {
  it("leaves its name to the new shape, so that parts go on with it", () => {
    expect(verb("Hollow it out")).toEqual([
      { path: ["shapes", "box-whole"], value: BOX },
      {
        path: ["shapes", "box"],
        value: {
          kind: "difference",
          of: ["box-whole", { kind: "offset", of: "box-whole", distance: "-10 mm" }],
        },
      },
    ]);
  });

  it("cuts right through, in the middle, and joins on the top", () => {
    const cut = verb("Cut with a cylinder");
    expect(cut?.[0]?.value).toMatchObject({ base: ["20 mm", "20 mm", "-5 mm"], height: "50 mm" });
    expect(cut?.[2]?.value).toEqual({ kind: "difference", of: ["box-whole", "cylinder"] });
    const join = verb("Join with a sphere");
    expect(join?.[0]?.value).toMatchObject({ center: ["20 mm", "20 mm", "40 mm"] });
  });

  it("gives an unused shape to a part, of the material of the first", () => {
    const source = { ...SOURCE, shapes: { box: BOX, ball: { kind: "sphere", radius: "5 mm" } } };
    expect(isUsed("ball", source)).toBe(false);
    expect(isUsed("box", source)).toBe(true);
    expect(verb("Make it a part", source, "ball")?.[0]?.value).toMatchObject({
      material: "ecoflex-00-50",
    });
    expect(verb("Cut it out of box", source, "ball")?.[1]).toEqual({
      path: ["shapes", "box"],
      value: { kind: "difference", of: ["box-whole", "ball"] },
    });
    expect(verb("Make it a part")).toBeUndefined();
  });

  it("joins two shapes; one that is such a joint already takes the other in", () => {
    const shapes = { box: BOX, ball: { kind: "sphere" }, cut: { kind: "difference", of: ["box"] } };
    const [join, cut, common] = joined("ball", "cut", shapes);
    expect(join?.changes[1]?.value).toEqual({ kind: "union", of: ["cut-whole", "ball"] });
    expect(cut?.changes).toEqual([{ path: ["shapes", "cut", "of"], value: ["box", "ball"] }]);
    expect(common?.changes[1]?.value).toEqual({ kind: "intersection", of: ["cut-whole", "ball"] });
    // A blended edge is between those that there are.
    const smooth = { ...shapes, cut: { kind: "difference", of: ["box"], smooth: "2 mm" } };
    expect(joined("ball", "cut", smooth)[1]?.changes).toHaveLength(2);
  });

  it("knows the operands of shapes, so that nothing becomes a part of itself", () => {
    const shapes = {
      box: BOX,
      cut: { kind: "shell", of: "box" },
      all: { kind: "union", of: ["cut"] },
    };
    expect(isMadeOf("all", "box", shapes)).toBe(true);
    expect(isMadeOf("box", "box", shapes)).toBe(true);
    expect(isMadeOf("box", "all", shapes)).toBe(false);
  });

  it("does not take a material or a parameter of its name for a use", () => {
    const source = {
      shapes: { box: BOX },
      materials: { a: { of: "box" } },
      parameters: { box: 1 },
    };
    expect(isUsed("box", source)).toBe(false);
  });
});
