// @vitest-environment happy-dom
import { Vector3 } from "three";
import { expect, it } from "vitest";
import type { Triple } from "../../src/protocol";
import { CameraRig } from "../../src/view/drawing/camera";
import { MoveHandle, snapped } from "../../src/view/hands/moveHandle";

function handle() {
  const rig = new CameraRig();
  rig.resize(800, 600);
  const done: Triple[] = [];
  const moving = new MoveHandle(
    rig,
    () => {},
    (by) => done.push(by),
  );
  return { rig, moving, done };
}

const press = (moving: MoveHandle, axis: string, key: string, shiftKey = false) =>
  moving.element
    .querySelector(`[data-testid=move-${axis}]`)
    ?.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey }));

it("moves along an axis by keys", () => {
  const { moving, done } = handle();
  press(moving, "x", "ArrowRight");
  press(moving, "z", "ArrowDown", true);
  press(moving, "y", "a");
  expect(done).toEqual([
    [0.001, 0, 0],
    [0, 0, -0.0001],
  ]);
});

it("stands at the chosen entry, without the axis that points at the eye", () => {
  const { rig, moving } = handle();
  moving.place(null, 800, 600);
  expect(moving.element.hidden).toBe(true);
  moving.place(new Vector3(), 800, 600);
  expect(moving.element.hidden).toBe(false);
  expect(moving.grips).toHaveLength(3);
  rig.look("top");
  for (let now = 0; rig.advance(now); now += 50);
  moving.place(new Vector3(), 800, 600);
  expect(moving.grips).toHaveLength(2);
});

it("ends at a tenth of a millimeter", () => {
  expect([0.00123, -0.00004, 0.0000501].map(snapped)).toEqual([0.0012, 0, 0.0001]);
});
