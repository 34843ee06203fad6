import { describe, expect, it } from "vitest";
import { meetingOf, pairChanges } from "../../../src/panes/design/bodies/pairs";
import {
  type Around,
  apart,
  bondOffers,
  type Offer,
  plateOn,
  touchOffers,
} from "../../../src/panes/design/here/touchHere";
import type { BodyEvent, Parameter } from "../../../src/protocol";
import { type Face, faceAt } from "../../../src/view/hands/face";
import { floorCorners, meetsOf } from "../../../src/view/marks/contactMarks";
import { boxes } from "../../boxes";

const packed = (points: readonly number[]) =>
  btoa(String.fromCharCode(...new Uint8Array(new Float32Array(points).buffer)));
const length = (name: string, value: number) => ({ name, value, kind: "length" }) as Parameter;

const PARAMETERS = [length("length", 0.04), length("height", 0.01)];
const SOURCE = {
  shapes: { bar: { kind: "box", size: ["= length", "20 mm", "= height"] } },
  parts: [{ shape: "bar" }],
};
const BAR = boxes({ low: [0, 0, 0], high: [0.04, 0.02, 0.01] });
/** Its faces, by the first of the two triangles of each. */
const [RIGHT, BELOW, ABOVE] = [2, 8, 10];

function body(more: Partial<BodyEvent> = {}): BodyEvent {
  return {
    ...{ bounds: [BAR.rest.slice(0, 3), [0.04, 0.02, 0.01]], voxel_size: 0.005 },
    ...{ bodies: [], objects: [], clamps: [], ...more },
  } as unknown as BodyEvent;
}
const BALL = {
  ...{ name: "ball", motion: "fixed", triangles: "" },
  vertices: packed([0.01, 0.01, 0.012, 0.03, 0.02, 0.03]),
} as unknown as BodyEvent["objects"][number];

function around(triangle: number, more: Partial<Around> = {}): Around {
  return {
    ...{ face: faceAt(BAR, triangle), body: body(), source: SOURCE, design: {} },
    ...{ parameters: PARAMETERS, ...more },
  };
}
const byId = (offers: readonly Offer[]) =>
  Object.fromEntries(offers.map((offer) => [offer.id, offer])) as Record<string, Offer>;

describe("a plate on a face", () => {
  it("follows the parameters that the face follows, and is wider than it", () => {
    expect(plateOn(faceAt(BAR, ABOVE), around(ABOVE))).toEqual({
      kind: "box",
      size: ["= 1.25*length", "25 mm", "10 mm"],
      center: ["= length/2", "10 mm", "= height + 5 mm"],
    });
    expect(plateOn(faceAt(BAR, BELOW), around(BELOW))?.center).toEqual([
      "= length/2",
      "10 mm",
      "-5 mm",
    ]);
  });

  it("lies on the smooth surface, and never within it", () => {
    // Shapes end 1.3 mm above the voxels.
    const smooth = new Float32Array([0.02, 0.01, 0.0113, 0.01, 0.01, 0.0112]);
    const face = faceAt(BAR, ABOVE, smooth);
    expect(face.seat?.level).toBeCloseTo(0.0113, 7);
    expect(plateOn(face, around(ABOVE))?.center).toMatchObject({ 2: "16.3 mm" });
    const other = around(ABOVE, { parameters: [length("height", 0.0113)] });
    expect(plateOn(face, other)?.center).toMatchObject({ 2: "= height + 5 mm" });
    // A number between two that can be written goes outward.
    const rough = faceAt(BAR, ABOVE, new Float32Array([0.02, 0.01, 0.0112004]));
    expect(plateOn(rough, around(ABOVE))?.center).toMatchObject({ 2: "16.201 mm" });
  });

  it("is as wide as the face where the body stands up beside it", () => {
    const step = boxes(
      { low: [0, 0, 0], high: [0.04, 0.02, 0.01] },
      { low: [0.04, 0, 0], high: [0.06, 0.02, 0.02] },
    );
    const face = faceAt(step, ABOVE);
    expect(face.seat?.free).toBe(false);
    expect(plateOn(face, around(ABOVE))?.size).toEqual(["= length", "20 mm", "10 mm"]);
  });

  it("fits in front of the opposite face, and is none on an oblique face", () => {
    const two = boxes(
      { low: [0, 0, 0], high: [0.04, 0.02, 0.01] },
      { low: [0, 0, 0.014], high: [0.04, 0.02, 0.02] },
    );
    expect(plateOn(faceAt(two, ABOVE), around(ABOVE))?.size).toMatchObject({ 2: "3.6 mm" });
    const oblique: Face = { ...faceAt(BAR, ABOVE), axis: null, seat: null };
    expect(plateOn(oblique, around(ABOVE))).toBeNull();
  });
});

describe("things the body can touch", () => {
  it("is a plate, also one that is pressed into it, with the friction that all have", () => {
    const { plate, press } = byId(touchOffers(around(ABOVE)));
    const [object, contact] = plate!.changes;
    expect(object).toMatchObject({ path: ["objects", 0], value: { name: "plate" } });
    expect(contact).toEqual({ path: ["contact"], value: { friction: 0.8 } });
    expect(press!.changes[0]?.value).toMatchObject({ motion: { displacement: [0, 0, "-1 mm"] } });
    const named = around(ABOVE, {
      source: { ...SOURCE, objects: [{ name: "plate" }], contact: { friction: 0.3 } },
    });
    const next = byId(touchOffers(named)).plate!;
    expect(next.changes).toHaveLength(1);
    expect(next.adds).toBe("plate-2");
  });

  it("is a floor under its lowest face, where there is none", () => {
    const parameters = [length("below", 0)];
    expect(byId(touchOffers(around(BELOW, { parameters }))).floor?.changes[0]).toEqual({
      path: ["floor"],
      value: { z: 0 },
    });
    expect(byId(touchOffers(around(ABOVE))).floor).toBeUndefined();
    const source = { ...SOURCE, floor: { z: 0 } };
    const there = byId(touchOffers(around(BELOW, { source, design: { floor: { z: 0 } } })));
    expect(there.floor).toBeUndefined();
    expect(there["thing-floor"]?.label).toContain("no friction now");
  });

  it("is no plate that presses on a face that a clamp holds, which could not give way", () => {
    const clamps = [{ points: [[0.02, 0.01, 0]] }] as unknown as BodyEvent["clamps"];
    const held = around(BELOW, { body: body({ clamps }) });
    expect(bondOffers(held)[0]?.disabled).toBeUndefined();
    const { plate, press, floor } = byId(touchOffers(held));
    expect(press?.label).toContain("a clamp holds this face");
    expect([press?.disabled, press?.changes]).toEqual([true, []]);
    // An object at rest may lie on a held one.
    expect([plate?.disabled, floor?.disabled]).toEqual([undefined, undefined]);
    const other = around(ABOVE, { body: body({ clamps }) });
    expect(byId(touchOffers(other)).press?.disabled).toBeUndefined();
  });

  it("stays away by a voxel from an end of the face that a clamp holds", () => {
    const points = [
      [0, 0.005, 0.01],
      [0, 0.02, 0.01],
    ];
    const clamps = [{ points }] as unknown as BodyEvent["clamps"];
    const { plate, press } = byId(touchOffers(around(ABOVE, { body: body({ clamps }) })));
    expect(plate?.changes[0]?.value).toMatchObject({
      shape: { size: ["= 1.25*length", "25 mm", "10 mm"] },
    });
    expect(press?.changes[0]?.value).toMatchObject({
      shape: {
        size: ["= length - 5 mm", "25 mm", "10 mm"],
        center: ["= length/2 + 2.5 mm", "10 mm", "= height + 5 mm"],
      },
    });
  });

  it("is itself, which a design without contact does not", () => {
    const { itself } = byId(touchOffers(around(ABOVE)));
    expect(itself?.changes).toEqual([{ path: ["contact"], value: { friction: 0.8 } }]);
    const rough = around(ABOVE, { source: { ...SOURCE, contact: { friction: 0.5 } } });
    expect(byId(touchOffers(rough)).itself).toMatchObject({
      label: "itself: touches, friction 0.5",
      disabled: true,
    });
    const pairs = [{ of: ["body", "body"], kind: "none" }];
    const through = around(ABOVE, { source: { ...SOURCE, contact: { pairs } } });
    expect(byId(touchOffers(through)).itself?.changes).toEqual([
      { path: ["contact", "pairs", 0], value: { of: ["body", "body"], friction: 0.8 } },
    ]);
  });

  it("is another body, by the names that contact has", () => {
    const bodies = [
      { name: "left.tip", bounds: [BAR.rest.slice(0, 3), [0.04, 0.02, 0.01]], vertices: [0, 7] },
      {
        name: "right",
        bounds: [
          [0.06, 0, 0],
          [0.09, 0.02, 0.01],
        ],
        vertices: [8, 15],
      },
    ] as unknown as BodyEvent["bodies"];
    const two = around(RIGHT, { body: body({ bodies }) });
    expect(byId(touchOffers(two))["thing-right"]?.changes).toEqual([
      { path: ["contact"], value: { pairs: [{ of: ["left.tip", "right"], friction: 0.8 }] } },
    ]);
    expect(byId(bondOffers(two))["thing-right"]).toMatchObject({
      label: "right: 20 mm away, needs 2.5 mm",
      disabled: true,
    });
  });
});

describe("bonds", () => {
  it("is a plate on the face, with a pair that says so", () => {
    expect(byId(bondOffers(around(ABOVE))).plate?.changes).toMatchObject([
      { path: ["objects", 0], value: { name: "plate", motion: "fixed" } },
      { path: ["contact"], value: { pairs: [{ of: ["body", "plate"], kind: "bonded" }] } },
    ]);
  });

  it("take things within half a voxel of the face", () => {
    const near = around(ABOVE, { body: body({ objects: [BALL] }) });
    expect(byId(bondOffers(near))["thing-ball"]?.changes[0]?.value).toEqual({
      pairs: [{ of: ["body", "ball"], kind: "bonded" }],
    });
    const pairs = [{ of: ["ball", "body"], kind: "bonded" }];
    const bonded = around(ABOVE, { ...near, source: { ...SOURCE, contact: { pairs } } });
    expect(byId(bondOffers(bonded))["thing-ball"]).toMatchObject({ disabled: true });
    expect(byId(bondOffers(around(BELOW, { body: near.body })))["thing-ball"]?.label).toContain(
      "12 mm away",
    );
  });
});

describe("a pair of contact", () => {
  const contact = { friction: 0.2, pairs: [{ of: ["a", "b"] }, { of: ["b", "a"], friction: 0.9 }] };

  it("is the last that is written, whichever comes first in it", () => {
    expect(meetingOf(contact, "a", "b")).toEqual({ kind: "touching", friction: 0.9, own: true });
    expect(meetingOf(contact, "a", "c")).toEqual({ kind: "touching", friction: 0.2, own: false });
    expect(meetingOf(undefined, "a", "b").friction).toBe(0);
  });

  it("is changed where it stands, or goes behind the others", () => {
    expect(pairChanges(contact, ["a", "b"], { kind: "none" })[0]?.path).toEqual([
      ...["contact", "pairs"],
      1,
    ]);
    expect(pairChanges(contact, ["a", "c"], {})[0]?.path).toEqual(["contact", "pairs", 2]);
    expect(pairChanges({ friction: 1 }, ["a", "c"], {})[0]).toEqual({
      path: ["contact", "pairs"],
      value: [{ of: ["a", "c"] }],
    });
  });

  it("has a word between the two, where it is named or chosen", () => {
    const design = { contact: { friction: 0.5, pairs: [{ of: ["body", "body"], kind: "none" }] } };
    const there = body({ objects: [BALL] });
    expect(meetsOf(there, design, null).map(({ text }) => text)).toEqual(["no contact"]);
    const [, chosen] = meetsOf(there, design, "ball");
    expect(chosen?.text).toBe("friction 0.5");
    expect(chosen?.at[2]).toBeCloseTo(0.011, 6);
  });

  it("draw a floor under the body, around it", () => {
    const corners = floorCorners(
      [
        [0, 0, 0],
        [0.04, 0.02, 0.01],
      ],
      -0.001,
    );
    expect(corners.every(([, , z]) => z === -0.001)).toBe(true);
    expect(corners.map(([x]) => Number(x!.toFixed(6)))).toEqual([-0.01, 0.05, 0.05, -0.01]);
  });

  it("is apart by the distance of boxes", () => {
    const a = { low: [0, 0, 0], high: [1, 1, 1] } as const;
    const b = { low: [4, 5, 0], high: [6, 6, 1] } as const;
    expect(apart(a as never, b as never)).toBe(5);
  });
});
