import { describe, expect, it } from "vitest";
import {
  coordinate,
  pointInside,
  regionAround,
  regionOfFace,
  verbsAt,
  verbsIn,
} from "../../src/panes/design/here/here";
import {
  canHaveTendons,
  placeIn,
  tendonBetween,
  tendonOn,
} from "../../src/panes/design/here/tendonHere";
import type { Parameter } from "../../src/protocol";
import { type Face, faceAt, triangleAt } from "../../src/view/hands/face";
import { boxes } from "../boxes";

const length = (name: string, value: number) => ({ name, value, kind: "length" }) as Parameter;

describe("the face that is pressed", () => {
  const one = boxes({ low: [0, 0, 0], high: [0.04, 0.01, 0.01] });

  it("knows the distance to the opposite face", () => {
    const two = boxes(
      { low: [0, 0, 0], high: [0.04, 0.01, 0.01] },
      { low: [0.07, 0, 0], high: [0.08, 0.01, 0.01] },
    );
    expect(faceAt(two, 2).opposite).toBeCloseTo(0.03, 7);
    expect(faceAt(one, 2).opposite).toBeNull();
  });

  it("is all of its plane, and nothing around the corner", () => {
    const face = faceAt(one, 2); // the first of the two at the largest x
    expect(face.axis).toBe(0);
    expect(face.normal[0]).toBeCloseTo(1);
    expect(new Set(face.triangles).size).toBe(4);
    expect(face.triangles).toHaveLength(6);
    expect(face.low[0]).toBeCloseTo(0.04);
    expect(face.shared).toBe(false);
    expect(face.cavity).toBeNull();
  });

  it("says where others lie in its plane", () => {
    const two = boxes(
      { low: [0, 0, 0], high: [0.01, 0.01, 0.01] },
      { low: [0.03, 0, 0], high: [0.04, 0.01, 0.01] },
    );
    const top = faceAt(two, 10);
    expect(top.normal[2]).toBeCloseTo(1);
    expect(top.shared).toBe(true);
    expect(regionOfFace(top, [])).toEqual({
      x: [0, "10 mm"],
      y: [0, "10 mm"],
      z: ["10 mm", "10 mm"],
    });
  });

  it("is found by its corners, or else by the triangles that face the eye", () => {
    const corners = [...one.triangles.slice(6, 9)] as [number, number, number];
    expect(triangleAt(one, corners, [0, 0, 1])).toBe(2);
    expect(faceAt(one, triangleAt(one, [7, 7, 7], [0, 0, 1]) as number).axis).toBe(2);
    expect(faceAt(one, triangleAt(one, [7, 7, 7], [0, 1, 0]) as number).axis).toBe(1);
  });
});

describe("text of a face", () => {
  const end = faceAt(boxes({ low: [0, 0, 0], high: [0.04, 0.01, 0.01] }), 2);

  it("follows the parameter that it comes from", () => {
    expect(regionOfFace(end, [length("length", 0.04)])).toEqual({ x: ["= length", "= length"] });
    expect(coordinate(-0.02, [length("width", 0.04)], 0.005)).toBe("= -width/2");
    expect(coordinate(0, [length("nothing", 0)], 0.005)).toBe(0);
  });

  it("does not take a parameter of another axis, which has the same value by chance", () => {
    const source = { shapes: { it: { kind: "box", size: ["40 mm", "10 mm", "= height"] } } };
    expect(regionOfFace(end, [length("height", 0.04)], source)).toEqual({ x: ["40 mm", "40 mm"] });
    const other = { shapes: { it: { kind: "box", size: ["= 2*height", "10 mm", "1 mm"] } } };
    expect(regionOfFace(end, [length("height", 0.04)], other)).toEqual({
      x: ["= height", "= height"],
    });
    expect(regionOfFace(end, [length("h", 0.04)], other)).toEqual({ x: ["40 mm", "40 mm"] });
  });

  it("does not guess between two", () => {
    const two = [length("length", 0.04), length("height", 0.04)];
    expect(regionOfFace(end, two)).toEqual({ x: ["40 mm", "40 mm"] });
  });

  it("is a ball where the surface is oblique", () => {
    const oblique: Face = { ...end, axis: null };
    expect(regionOfFace(oblique, [])).toBeNull();
    expect(regionAround(oblique)).toMatchObject({ radius: "7.5 mm" });
  });

  it("goes behind existing entries, under a free name", () => {
    const source = { clamps: [{}], probes: { probe: {} }, layers: [{ name: "fabric" }] };
    const verbs = Object.fromEntries(
      verbsAt({ x: [0, 0] }, end.normal, source).map((verb) => [verb.id, verb.changes[0]]),
    );
    expect(verbs.clamp).toEqual({ path: ["clamps", 1], value: { region: { x: [0, 0] } } });
    expect(verbs.probe?.path).toEqual(["probes", "probe-2"]);
    expect(verbs.layer?.value).toMatchObject({ name: "fabric-2" });
    // It pushes into the body.
    expect(verbs.push?.value).toMatchObject({ kind: "force", value: ["-100 mN", 0, 0] });
  });

  it("names a chamber by a point within it", () => {
    const wall = boxes({ low: [0, 0, 0], high: [0.04, 0.01, 0.01], owner: 128 + 1 });
    const face = faceAt(wall, 2);
    expect(face.cavity).toBe(1);
    expect(pointInside(face)[0]).toBeCloseTo(0.0425);
    const [fill, name] = verbsIn(face, "", {});
    expect(fill?.changes.map(({ path }) => path)).toEqual([
      ["chambers", "chamber"],
      ["loads", 0],
    ]);
    expect(name?.id).toBe("name");
    const known = verbsIn(face, "left", { chambers: { left: {} } });
    expect(known).toHaveLength(1);
    expect(known[0]?.changes[0]?.value).toMatchObject({ cavity: "left" });
  });
});

describe("a tendon through places that were pressed", () => {
  const bar = boxes({ low: [0, 0, 0], high: [0.04, 0.01, 0.01] });
  const left = faceAt(bar, 0);

  it("begins half a voxel inside of the material", () => {
    const inside = left.point.map((x, i) => x - 0.0025 * left.normal[i]!);
    const place = placeIn(left).map((one) =>
      one === 0 ? 0 : Number.parseFloat(String(one)) / 1e3,
    );
    for (const axis of [0, 1, 2]) expect(place[axis]).toBeCloseTo(inside[axis]!, 6);
  });

  it("is pulled at the first and anchored around the last", () => {
    const source = { tendons: [{ name: "tendon" }] };
    const { path, value } = tendonBetween([0, 0, "2 mm"], ["40 mm", 0, "2 mm"], 0.005, source);
    expect(path).toEqual(["tendons", 1]);
    expect(value).toMatchObject({
      guide: "eyelets",
      through: [[0, 0, "2 mm"], { point: ["40 mm", 0, "2 mm"], radius: "7.5 mm" }],
    });
    expect((value as { name: string }).name).not.toBe("tendon");
  });

  it("goes on from its anchor, which becomes a place on the way", () => {
    const { value } = tendonBetween([0, 0, 0], ["20 mm", 0, 0], 0.005, {});
    const on = tendonOn(["40 mm", 0, 0], 0.005, { tendons: [value] });
    expect(on).toEqual([
      { path: ["tendons", 0, "through", 1], value: ["20 mm", 0, 0] },
      { path: ["tendons", 0, "through", 2], value: { point: ["40 mm", 0, 0], radius: "7.5 mm" } },
    ]);
  });

  it("does not go on from places that were not pressed, and has no place among several bodies", () => {
    expect(tendonOn([0, 0, 0], 0.005, {})).toBeNull();
    expect(
      tendonOn([0, 0, 0], 0.005, {
        tendons: [
          {
            through: [
              [0, 0, 0],
              [1, 0, 0],
            ],
          },
        ],
      }),
    ).toBeNull();
    expect(tendonOn([0, 0, 0], 0.005, { tendons: [{ through: "x" }] })).toBeNull();
    expect(canHaveTendons({ bodies: [{ name: "left" }] })).toBe(false);
    expect(canHaveTendons({})).toBe(true);
  });
});
