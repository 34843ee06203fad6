import { expect, it } from "vitest";
import { type Rect, standWords, type Word } from "../../src/view/marks/labelLayout";

const word = (x: number, y: number, minor = false): Word => ({ x, y, width: 60, minor });
const LEGEND: Rect = { left: 700, top: 10, right: 820, bottom: 240 };

it("leaves words that have room at their points", () => {
  expect(standWords([word(100, 100), word(300, 100)], [LEGEND])).toEqual([
    { lines: 0, left: 0, crowded: false },
    { lines: 0, left: 0, crowded: false },
  ]);
});

it("keeps words out of the legend", () => {
  const [one, other] = standWords([word(680, 50), word(760, 50)], [LEGEND], 830);
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

const BAR: Rect = { left: 10, top: 10, right: 540, bottom: 46 };
const CARD: Rect = { left: 12, top: 200, right: 272, bottom: 500 };

function rectOf(one: Word, { lines, left }: { lines: number; left: number }): Rect {
  const [x, y] = [one.x + 9 - left, one.y - 9 + 21 * lines];
  return { left: x, right: x + one.width, top: y, bottom: y + 18 };
}

const meet = (a: Rect, b: Rect) =>
  a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

it("stands below a bar whose left end is that of the picture", () => {
  const below = word(200, 30);
  const [found] = standWords([below], [BAR], 800);
  expect(found).toMatchObject({ left: 0, crowded: false });
  expect(found!.lines).toBeGreaterThan(0);
  expect(meet(rectOf(below, found!), BAR)).toBe(false);
});

it("stands at the right of a card that leaves no room at the left", () => {
  const beside = word(240, 300);
  const [found] = standWords([beside], [CARD], 800);
  expect(found!.left).toBeLessThan(0);
  expect(meet(rectOf(beside, found!), CARD)).toBe(false);
});

it("keeps all words out of all panels, wherever their points are", () => {
  const panels = [BAR, CARD, LEGEND, { left: 300, top: 100, right: 640, bottom: 160 }];
  for (let x = 0; x <= 820; x += 20) {
    for (let y = 0; y <= 600; y += 15) {
      const crowd = [word(x, y), word(x + 5, y), word(x, y + 4, true), word(x, y + 2)];
      for (const [i, standing] of standWords(crowd, panels, 820).entries()) {
        if (standing.crowded) continue;
        const rect = rectOf(crowd[i]!, standing);
        expect(panels.filter((one) => meet(rect, one))).toEqual([]);
      }
    }
  }
});

it("shows the dot of a word that has no place clear of panels", () => {
  const all = { left: 0, top: 0, right: 800, bottom: 600 };
  expect(standWords([word(400, 300)], [all], 800)[0]).toMatchObject({ crowded: true });
});
