import { expect, it } from "vitest";
import type { Moment, Touch } from "../../src/protocol";
import { scaleText } from "../../src/view/cards/ForceLegend";
import { lowestOf, nearOf } from "../../src/view/hands/touchPlace";
import { HOLD_COLORS, holdColor, largestForce, scaleOf } from "../../src/view/marks/forces";

/** A square of points at a height, `from` to `to` along x and 0 to 4 along y, each a millimeter apart. */
function sheet(z: number, from: number, to: number): Float32Array {
  const points: number[] = [];
  for (let x = from; x <= to; x++) for (let y = 0; y <= 4; y++) points.push(x / 1e3, y / 1e3, z);
  return Float32Array.from(points);
}

function meanOf(points: Float32Array, near: ReturnType<typeof nearOf>): number[] {
  const sum = [0, 0, 0];
  for (const [i, point] of (near?.points ?? []).entries())
    for (const axis of [0, 1, 2])
      sum[axis]! += (near?.shares[i] as number) * points[3 * point + axis]!;
  return sum;
}

it("finds the contact place in the middle of surfaces on each other", () => {
  const table = sheet(0, 0, 100);
  const [x, y, z] = meanOf(table, nearOf(table, sheet(0.0002, 40, 44), 1e-3));
  expect(x).toBeCloseTo(0.042, 6);
  expect(y).toBeCloseTo(0.002, 6);
  expect(z).toBeCloseTo(0, 9);
});

it("reaches farther where nothing is near, and not farther than three voxels", () => {
  const table = sheet(0, 0, 10);
  expect(nearOf(table, sheet(0.0025, 4, 6), 1e-3)).not.toBeNull();
  expect(nearOf(table, sheet(0.0035, 4, 6), 1e-3)).toBeNull();
  expect(nearOf(table, new Float32Array(), 1e-3)).toBeNull();
});

it("takes the lowest points for those that touch a floor", () => {
  const both = Float32Array.from([...sheet(0.01, 0, 10), ...sheet(0.005, 20, 24)]);
  const [x, , z] = meanOf(both, lowestOf(both, 1e-3));
  expect(x).toBeCloseTo(0.022, 6);
  expect(z).toBeCloseTo(0.005, 6);
});

it("draws the largest force no longer than it may be, at a scale that can be said", () => {
  expect(scaleOf(1, 0.03)).toBe(0.02);
  expect(scaleOf(0.012, 0.03)).toBe(2);
  expect(scaleOf(1, 0.05)).toBe(0.05);
  expect(scaleOf(0, 0.03)).toBe(0);
  for (const force of [3.1e-4, 0.07, 1.9, 88]) {
    const length = force * scaleOf(force, 0.03);
    expect(length).toBeLessThanOrEqual(0.03);
    expect(length).toBeGreaterThan(0.03 / 2.6);
  }
  expect(scaleText(0.02)).toBe("10 mm = 0.5 N");
});

const touch = (of: [string, string], force: Touch["force"]): Touch => ({
  ...{ of, force, pressed: 9, area: 0, gap: 0, slipping: 0 },
  ...{ friction: null, bound: null },
});
const moment = (...contacts: Touch[]): Moment => ({
  ...{ frame: 0, time: 0, poses: [], contacts, fields: false, depth: null },
});

it("measures by the largest force of all moments between two things", () => {
  const moments = [
    moment(touch(["a", "b"], [0, 3, 4]), touch(["a", "a"], [9, 0, 0])),
    moment(touch(["a", "b"], [1, 0, 0])),
  ];
  expect(largestForce(moments)).toBe(5);
  expect(largestForce([])).toBe(0);
});

it("colors by the hold of surfaces", () => {
  expect([0, 0.3, 1].map(holdColor)).toEqual([
    ...[HOLD_COLORS.sticks, HOLD_COLORS.partly, HOLD_COLORS.slips],
  ]);
});
