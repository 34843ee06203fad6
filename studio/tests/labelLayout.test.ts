import { expect, it } from "vitest";
import { type Rect, standWords, type Word } from "../src/view/labelLayout";

const word = (x: number, y: number, minor = false): Word => ({ x, y, width: 60, minor });
const LEGEND: Rect = { left: 700, top: 10, right: 820, bottom: 240 };

it("leaves words that have room at their points", () => {
  expect(standWords([word(100, 100), word(300, 100)], [LEGEND])).toEqual([
    { lines: 0, left: 0, crowded: false },
    { lines: 0, left: 0, crowded: false },
  ]);
});

it("keeps words out of the legend", () => {
  const [one, other] = standWords([word(680, 50), word(760, 50)], [LEGEND]);
  for (const [x, standing] of [
    [680, one!],
    [760, other!],
  ] as const) {
    expect(x + 9 - standing.left + 60).toBeLessThan(LEGEND.left);
  }
  // Both moved to its left, where they stand one below the other.
  expect([one!.lines, other!.lines]).toEqual([0, 1]);
});

it("keeps words apart that share a point, and shows dots of those beyond", () => {
  const found = standWords(
    Array.from({ length: 6 }, () => word(100, 100, true)),
    [],
  );
  expect(found.map((one) => one.lines)).toEqual([0, 1, 2, 3, 0, 0]);
  expect(found.map((one) => one.crowded)).toEqual([false, false, false, false, true, true]);
});
