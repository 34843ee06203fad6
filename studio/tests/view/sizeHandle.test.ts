// @vitest-environment happy-dom
import { Vector3 } from "three";
import { expect, it } from "vitest";
import { resized } from "../../src/panes/design/bodies/gripped";
import { CameraRig } from "../../src/view/drawing/camera";
import { factorFor, SizeHandle } from "../../src/view/hands/sizeHandle";

it("sizes by keys, about the middle, and is where something can be sized only", () => {
  const rig = new CameraRig();
  rig.resize(800, 600);
  const done: number[] = [];
  const sizing = new SizeHandle(
    rig,
    () => {},
    (factor) => done.push(factor),
  );
  sizing.place(null, 0, 800, 600);
  expect(sizing.element.hidden).toBe(true);
  expect(sizing.grips).toHaveLength(0);
  sizing.place(new Vector3(), 0.01, 800, 600);
  expect(sizing.grips).toHaveLength(1);
  const press = (key: string, shiftKey = false) =>
    sizing.element
      .querySelector("[data-testid=size-object]")
      ?.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey }));
  press("ArrowUp");
  press("ArrowLeft", true);
  press("a");
  expect(done).toEqual([expect.closeTo(1.05, 12), expect.closeTo(0.99, 12)]);
});

it("ends at a tenth of a millimeter, and never turns inside out", () => {
  expect(factorFor(0.01, 0.00234)).toBeCloseTo(1.23, 12);
  expect(factorFor(0.01, -0.5)).toBeCloseTo(0.01, 12);
});

it("writes lengths, and leaves the middle where it is", () => {
  const place = ["= -apart/2", 0, "10 mm"];
  expect(resized({ kind: "sphere", radius: "18 mm", center: place }, 0.5)).toEqual({
    ...{ kind: "sphere", radius: "9 mm", center: place },
  });
  expect(resized({ kind: "box", size: ["10 mm", "2 cm", "5 mm"], center: place }, 1.1)).toEqual({
    ...{ kind: "box", size: ["11 mm", "22 mm", "5.5 mm"], center: place },
  });
  const can = { kind: "cylinder", radius: "5 mm", height: "20 mm", base: place };
  expect(resized(can, 2)).toEqual({
    ...{ kind: "cylinder", radius: "10 mm", height: "40 mm", base: ["= -apart/2", 0, 0] },
  });
});

it("leaves objects sized by a formula, or without a middle of their own", () => {
  expect(resized("ball", 2)).toBeNull();
  expect(resized({ kind: "sphere", radius: "= r" }, 2)).toBeNull();
  expect(resized({ kind: "box", size: ["1 mm", "1 mm", "1 mm"] }, 2)).toBeNull();
  expect(resized({ kind: "torus" }, 2)).toBeNull();
});
