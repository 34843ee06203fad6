import { Vector3 } from "three";
import { expect, test } from "vitest";
import type { OverlapEvent } from "../../src/protocol";
import { drawnAt, overlapLabels, overlapOf } from "../../src/view/marks/overlap";

const place = { depth: 0.0018, rest: [0.01, 0, 0], now: [0.012, 0, 0.004] } as const;
const found = {
  t: "overlap",
  topology: 3,
  depth: 0.0018,
  sentence: "chambers: walls overlap by 1.8 mm: contact is not simulated",
  places: [place],
} as unknown as OverlapEvent;

test("an overlap is that of the body that is shown", () => {
  expect(overlapOf(found, 3)).toBe(found);
  expect(overlapOf(found, 4)).toBeNull();
  expect(overlapOf({ ...found, places: [] }, 3)).toBeNull();
  expect(overlapOf(null, 3)).toBeNull();
});

test("a mark follows the body, its displacement drawn as large as the body's", () => {
  const [label] = overlapLabels(found, 2, () => undefined);
  expect(label?.text).toBe("1.8 mm");
  const at = label?.at(new Vector3()).toArray() ?? [];
  expect(at[0]).toBeCloseTo(0.014, 12);
  expect(at[2]).toBeCloseTo(0.008, 12);
  expect(drawnAt(found.places[0]!, 1, new Vector3()).x).toBeCloseTo(0.012, 12);
});

test("a click on a mark goes there", () => {
  const gone: unknown[] = [];
  overlapLabels(found, 1, (to) => gone.push(to))[0]?.onClick?.();
  expect(gone).toEqual([place]);
});
