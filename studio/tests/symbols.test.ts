import { Vector3 } from "three";
import { expect, it } from "vitest";
import { arrowTip } from "../src/view/symbols";

it("keeps arrows of loads outside of the body, where they are seen whole", () => {
  const middle = new Vector3(0, 0, 5);
  const top = new Vector3(0, 0, 10);
  const [up, down] = [new Vector3(0, 0, 1), new Vector3(0, 0, -1)];
  // What pushes touches the body with its head; what pulls, with its tail.
  expect(arrowTip(top, down, middle, 3).z).toBe(10);
  expect(arrowTip(top, up, middle, 3).z).toBe(13);
});
