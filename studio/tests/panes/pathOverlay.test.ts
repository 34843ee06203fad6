import { describe, expect, it } from "vitest";
import { changeable } from "../../src/panes/path/lines";
import { overlaid, suggested } from "../../src/panes/path/overlay";
import type { PathTable } from "../../src/panes/path/tables";
import { columnWords, overWords } from "../../src/panes/path/words";
import type { PathEvent } from "../../src/protocol";

const PATH: PathEvent = {
  t: "path",
  ...{ job: "a", over: "loads[0].value", kind: "pressure", values: [0, 1e3], asked: 2 },
  columns: [
    { name: "lift", kind: "length", values: [0, 0.01] },
    { name: "bend", kind: "angle", values: [0, 0.1] },
    { name: "tip.x", kind: "length", values: [0, 0] },
  ],
  ...{ status: "ok", message: "" },
};

function table(text: string, column: string | null = null): PathTable {
  return { name: "m.csv", text, of: "a.toml", column };
}

describe("a table over a path", () => {
  it("shows the number of its name, or of its kind", () => {
    const named = overlaid(PATH, [table("pressure_kPa,tip_x_mm\n0,0\n1,2\n")], "");
    expect(named).toMatchObject({ column: { name: "tip.x" }, measured: { y: [0, 0.002] } });
    const alike = overlaid(PATH, [table("p_kPa,angle_deg\n0,0\n1,2\n")], "");
    expect(alike).toMatchObject({ column: { name: "bend" }, problem: null });
  });
  it("says why it lies over none", () => {
    const none = overlaid(PATH, [table("p_kPa,force_N\n0,0\n1,2\n")], "");
    expect(none).toMatchObject({ column: { name: "lift" }, measured: null });
    expect(none?.problem).toContain("force_N");
  });
  it("stays with its first number where it names no units", () => {
    expect(overlaid(PATH, [table("0,0\n1,2\n")], "tip.x")?.measured).not.toBeNull();
    expect(overlaid(PATH, [table("0,0\n1,2\n", "lift")], "tip.x")?.measured).toBeNull();
  });
  it("says which load to follow, and how far", () => {
    const loads = [
      { kind: "gravity", value: 9.81 },
      { kind: "pressure", value: 4000, cavity: 0 },
    ];
    const found = suggested(changeable({ loads }, []), table("pressure_kPa,a_deg\n0,0\n30,9\n"));
    expect(found).toMatchObject({ what: { key: "loads[1].value" }, end: 30e3 });
  });
});

describe("words of a path", () => {
  it("name loads and numbers, and leave what nobody knows", () => {
    const choices = changeable({ loads: [{ kind: "pressure", value: 4000, cavity: 0 }] }, []);
    expect(overWords("loads[0].value", choices)).toBe("pressure in cavity 0");
    expect(overWords("loads[7].value", choices)).toBe("loads[7].value");
    expect(["tip.x", "cavity 0.volume", "cavity_volume_change"].map(columnWords)).toEqual([
      "displacement of tip along x",
      "volume of cavity 0",
      "cavity volume change",
    ]);
  });
  it("tell loads of one kind apart", () => {
    const loads = [
      { kind: "force", value: 1 },
      { kind: "force", value: 2 },
    ];
    expect(changeable({ loads }, []).map(({ label }) => label)).toEqual([
      "force (load 1)",
      "force (load 2)",
    ]);
  });
});
