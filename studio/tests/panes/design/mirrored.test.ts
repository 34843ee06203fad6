import { describe, expect, it } from "vitest";
import { canMirror, mirrored } from "../../../src/panes/design/bodies/mirrored";
import { gripHere } from "../../../src/panes/design/here/gripHere";
import type { Face } from "../../../src/view/hands/face";

const SIZE = [0.03, 0.04, 0.1] as const;
/** The inside of a hanging finger, which looks along -x. */
const INSIDE: Face = {
  ...{ topology: 1, triangles: [], low: [0, 0, 0], high: [0, 0.04, 0.1], normal: [-1, 0, 0] },
  ...{ axis: 0, shared: false, cavity: null, point: [0, 0.013, 0.0151], opposite: null },
  seat: null,
  voxelSize: 0.005,
};
const FINGER = {
  shapes: { box: { kind: "box", size: ["30 mm", "40 mm", "100 mm"] } },
  parts: [{ shape: "box", material: "ecoflex-00-30" }],
  clamps: [{ region: { z: ["100 mm", "100 mm"] } }, { region: { x: ["10 mm", "inf"] } }],
  layers: [{ name: "fabric", region: { x: [0, 0] } }],
  chambers: { air: { point: ["10 mm", "20 mm", "50 mm"] } },
  probes: { tip: { center: ["= wide", 0, 0], radius: "3 mm" } },
  loads: [
    { kind: "pressure", cavity: "air", value: "10 kPa" },
    { kind: "force", region: { x: ["30 mm", "30 mm"] }, value: ["-5 mN", 0, "= f"] },
  ],
};

const values = (cavities: number, source: Record<string, unknown> = FINGER, face = INSIDE) =>
  new Map(
    mirrored(face, SIZE, cavities, source, []).map(({ path, value }) => [path.join("."), value]),
  );

describe("the mirror image of a design", () => {
  it("lies opposite the face, as far as a parameter says", () => {
    const found = values(1);
    expect(found.get("parameters.apart")).toMatchObject({ value: "40 mm", min: "20 mm" });
    expect(found.get("shapes.box-one")).toEqual(FINGER.shapes.box);
    expect(found.get("shapes.box")).toEqual({
      ...{ kind: "mirror", of: "box-one", normal: "x", point: ["= -apart/2", 0, 0], keep: true },
    });
  });

  it("has clamps, layers and probes at its own places, and nothing twice", () => {
    const found = values(1);
    // The plane of the first clamp holds both.
    expect(found.get("clamps.2")).toEqual({ region: { x: ["-inf", "= -10 mm - apart"] } });
    expect(found.has("clamps.3")).toBe(false);
    expect(found.get("layers.1")).toEqual({
      ...{ name: "fabric-2", region: { x: ["= -apart", "= -apart"] } },
    });
    expect(found.get("chambers.air-2")).toEqual({ point: ["= -10 mm - apart", "20 mm", "50 mm"] });
    expect(found.get("probes.tip-2")).toMatchObject({
      center: ["= 2*(0) - (wide) - apart", 0, 0],
    });
  });

  it("is pressed by the one number of the only chamber, and pushed the other way", () => {
    const found = values(1);
    expect(found.get("loads.0.cavity")).toBe("all");
    expect(found.get("loads.2")).toMatchObject({
      ...{ region: { x: ["= -30 mm - apart", "= -30 mm - apart"] }, value: ["5 mN", 0, "= f"] },
    });
    expect(values(2).get("loads.2")).toMatchObject({ kind: "pressure", cavity: "air-2" });
  });

  it("follows a face that is a parameter, on either side", () => {
    const right: Face = {
      ...INSIDE,
      low: [0.03, 0, 0],
      high: [0.03, 0.04, 0.1],
      normal: [1, 0, 0],
    };
    const wide = { name: "wide", value: 0.03, kind: "length" } as never;
    const found = mirrored(right, SIZE, 1, FINGER, [wide]);
    const at = (path: string) => found.find((one) => one.path.join(".") === path)?.value;
    expect(at("shapes.box")).toMatchObject({ point: ["= wide + apart/2", 0, 0] });
    expect(at("layers.1")).toMatchObject({
      region: { x: ["= 2*(wide) - (0) + apart", "= 2*(wide) - (0) + apart"] },
    });
  });

  it("is not offered where lines or fibers would have to be turned over", () => {
    expect(canMirror(FINGER)).toBe(true);
    expect(canMirror({ ...FINGER, tendons: [{}] })).toBe(false);
    expect(canMirror({ parts: [{ shape: "box", fibers: [{}] }] })).toBe(false);
    expect(canMirror({})).toBe(false);
  });
});

describe("an object to grip", () => {
  it("stands between two walls, moves with the plane between them, and is as heavy as water", () => {
    const source = {
      shapes: { box: { kind: "mirror", normal: "x", point: ["= -apart/2", 0, 0] } },
    };
    const design = { shapes: { box: { point: [-0.02, 0, 0] } } };
    const { name, changes } = gripHere(
      "sphere",
      { ...INSIDE, opposite: 0.04 },
      0.01,
      source,
      design,
    );
    expect(name).toBe("ball");
    expect(changes).toEqual([
      {
        path: ["objects", 0],
        value: {
          ...{ name: "ball", motion: "free", mass: "20 g" },
          shape: { kind: "sphere", radius: "18 mm", center: ["= -apart/2", "20 mm", "15 mm"] },
        },
      },
      { path: ["contact"], value: { friction: 0.8 } },
    ]);
  });

  it("stands a voxel in front of a face that is alone, and leaves friction that there is", () => {
    const source = { objects: [{ name: "cylinder" }], contact: {} };
    const { name, changes } = gripHere("cylinder", INSIDE, 0.02, source, null);
    expect(name).toBe("cylinder-2");
    expect(changes).toEqual([
      {
        path: ["objects", 1],
        value: {
          ...{ name: "cylinder-2", motion: "free", mass: "6 g" },
          shape: {
            ...{ kind: "cylinder", radius: "10 mm", height: "20 mm" },
            base: ["-15 mm", "20 mm", "5 mm"],
          },
        },
      },
    ]);
  });
});
