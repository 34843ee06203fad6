import { Box3, Vector3 } from "three";
import { expect, it, vi } from "vitest";
import { CameraRig } from "../../src/view/drawing/camera";

const box = new Box3(new Vector3(0, 0, 0), new Vector3(0.06, 0.02, 0.02));

it("knows whether a body is in the picture", () => {
  const rig = new CameraRig();
  rig.resize(800, 600);
  rig.fit(box, true);
  expect(rig.holds(box)).toBe(true);
  const bent = box.clone().union(box.clone().translate(new Vector3(0, 0, -0.06)));
  expect(rig.holds(bent)).toBe(false);
  rig.fit(bent, true);
  expect(rig.holds(bent)).toBe(true);
});

it("knows whether a hand has placed it since it was fitted", () => {
  const rig = new CameraRig();
  const steps = [() => rig.turn(1, 1), () => rig.move(1, 1), () => rig.zoom(1.1, 0, 0)];
  for (const step of steps) {
    rig.fit(box, true);
    expect(rig.steered).toBe(false);
    step();
    expect(rig.steered).toBe(true);
  }
});

it("fits at the end of a view that it is still turning to", () => {
  vi.stubGlobal("matchMedia", () => ({ matches: false }));
  const rig = new CameraRig();
  rig.resize(800, 600);
  rig.look("top");
  const begun = performance.now();
  rig.advance(begun + 50); // on the way
  expect(rig.toEye.z).toBeLessThan(0.99);
  rig.fit(box);
  rig.advance(begun + 60_000);
  expect(rig.toEye.z).toBeCloseTo(1, 3);
  expect(rig.holds(box)).toBe(true);
  rig.look("back");
  rig.turnAbout(new Vector3(0.01, 0, 0));
  expect(rig.aimedEye.y).toBeCloseTo(1, 6);
  vi.unstubAllGlobals();
});
