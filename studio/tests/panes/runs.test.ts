import { describe, expect, it } from "vitest";
import { FORMATS, obstacle, request } from "../../src/panes/export/formats";
import {
  changeTitle,
  comparedRows,
  percentChange,
  sideTitle,
  unitIn,
} from "../../src/panes/runs/compared";
import { ago, inTrash, matchesSearch } from "../../src/panes/runs/rows";
import type { RunRow, Side } from "../../src/protocol";

const row = (id: string): RunRow => ({
  id,
  kind: "study",
  name: id,
  status: "done",
  best: "rise 4 mm",
  when: "",
  seconds: 1,
  folder: "",
  thumbnail: null,
  message: "",
  trials: 3,
  again: false,
});

it("finds rows that hold all words of a search", () => {
  expect(matchesSearch(row("arm"), "Study RISE")).toBe(true);
  expect(matchesSearch(row("arm"), "study leg")).toBe(false);
  expect(matchesSearch(row("arm"), "")).toBe(true);
});

it("says how long ago something was", () => {
  const now = Date.parse("2026-03-10T12:00:00Z");
  expect(ago("2026-03-10T11:59:55Z", now)).toBe("just now");
  expect(ago("2026-03-10T11:59:00Z", now)).toBe("1 minute ago");
  expect(ago("2026-03-08T11:00:00Z", now)).toBe("2 days ago");
  expect(ago("2025-12-24T11:00:00Z", now)).toBe("2025-12-24");
  expect(ago("never", now)).toBe("–");
});

it("finds a deleted run again, also where one of that name was deleted before", () => {
  expect(inTrash([row("arm"), row("arm-2"), row("arm-long")], "arm")).toBe("arm-2");
  expect(inTrash([row("arm")], "arm")).toBe("arm");
  expect(inTrash([], "arm")).toBe("arm");
});

it("sets two designs side by side, with units and changes", () => {
  const kind = (name: string) => (name === "wall" ? "length" : "number");
  const rows = comparedRows({ wall: 0.01, n: 2 }, { wall: 0.012, n: 2, more: "x" }, kind);
  expect(rows).toEqual([
    { name: "wall", a: "10 mm", b: "12 mm", change: "+20 %", differs: true },
    { name: "n", a: "2", b: "2", change: "", differs: false },
    { name: "more", a: "–", b: "x", change: "", differs: true },
  ]);
});

it("shows parameters in the unit in which their design writes them", () => {
  const text = '[parameters]\nwall = { value = "5 mm", min = "2 mm" }\nn = 3\nw2 = "= 2*wall"';
  expect(unitIn(text, "wall")).toBe("mm");
  expect(unitIn(text, "n")).toBeNull();
  expect(unitIn(text, "w2")).toBeNull();
  const rows = comparedRows({ wall: 0.01 }, { wall: 0.005 }, () => "number", { a: text, b: text });
  expect(rows[0]).toMatchObject({ a: "10 mm", b: "5 mm", change: "−50 %" });
});

describe("export", () => {
  const options = { unit: null, shape: "rest", scale: 2 } as const;
  const stl = FORMATS.find((one) => one.id === "stl");
  it("asks for the unit of a surface before it writes one", () => {
    if (!stl) throw new Error("no surface");
    expect(obstacle(stl, options, true)).toMatch(/unit/);
    expect(obstacle(stl, { ...options, unit: "mm" }, true)).toBeNull();
    expect(request(stl, { ...options, unit: "mm", shape: "now" })).toEqual({
      format: "stl",
      options: { unit: "mm", deformed: true },
    });
  });
  it("refuses a live page of a design that pages do not know, with the reason", () => {
    const live = FORMATS.find((one) => one.live);
    if (!live) throw new Error("no live page");
    expect(obstacle(live, options, true)).toBeNull();
    const why = "supplies[0] are not known to exported pages yet: leave the supplies out.";
    expect(obstacle(live, options, true, { page: why })).toBe(why);
  });
  it("describes the purpose of each file in a sentence", () => {
    for (const format of FORMATS) expect(format.purpose).toMatch(/^[A-Z].*\.$/);
  });
});

it("calls runs by their names, and designs of studies by their numbers", () => {
  const side = (id: string) => ({ id, name: id }) as Side;
  expect(sideTitle(side("arm"))).toBe("arm");
  expect(sideTitle(side("arm-study/12"))).toBe("Design 12");
  expect(changeTitle(side("arm"), side("leg"))).toBe("leg minus arm, in % of arm");
});

it("gives changes in percent of the earlier size", () => {
  expect(percentChange(2, 3)).toBe(50);
  expect(percentChange(-2, -3)).toBe(-50);
});
