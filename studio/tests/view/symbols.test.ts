import { Vector3 } from "three";
import { expect, it } from "vitest";
import { arrowTip, planeCorners } from "../../src/view/marks/symbols";

it("keeps arrows of loads outside of the body, where they are seen whole", () => {
  const middle = new Vector3(0, 0, 5);
  const top = new Vector3(0, 0, 10);
  const [up, down] = [new Vector3(0, 0, 1), new Vector3(0, 0, -1)];
  // A pushing arrow touches the body with its head, a pulling one with its tail.
  expect(arrowTip(top, down, middle, 3).z).toBe(10);
  expect(arrowTip(top, up, middle, 3).z).toBe(13);
});

it("draws a plane of symmetry around the body, across its axis", () => {
  const corners = planeCorners({ axis: 1, at: 0.01 }, [
    [0, 0, 0],
    [0.04, 0.02, 0.03],
  ]);
  expect(corners.every(([, y]) => y === 0.01)).toBe(true);
  expect(Math.min(...corners.map(([x]) => x))).toBeLessThan(0);
  expect(Math.max(...corners.map(([, , z]) => z))).toBeGreaterThan(0.03);
  expect(new Set(corners.map(String)).size).toBe(4);
});
