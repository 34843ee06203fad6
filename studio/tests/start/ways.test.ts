import { describe, expect, it } from "vitest";
import type { Way } from "../../src/protocol";
import { answer, found, leads, QUESTIONS } from "../../src/start/ways";
import { whenWords } from "../../src/store/when";

function way(drive: string, form: string, task: string): Way {
  return { name: `${drive}-${form}-${task}`, drive, form, task, robot: "r", sentence: "" };
}

const WAYS = [
  way("pressure", "finger", "bend"),
  way("pressure", "finger", "grip"),
  way("pressure", "bellows", "extend"),
  way("tendon", "trunk", "bend"),
];

describe("the three questions of New", () => {
  it("lead somewhere only with the answers before", () => {
    expect(leads(WAYS, {}, "form", "bellows")).toBe(true);
    expect(leads(WAYS, { drive: "tendon" }, "form", "bellows")).toBe(false);
    // A later answer does not close an earlier question.
    expect(leads(WAYS, { drive: "tendon", form: "trunk" }, "drive", "pressure")).toBe(true);
  });

  it("answer themselves where one answer is left", () => {
    const given = answer(WAYS, {}, "drive", "tendon");
    expect(given).toEqual({ drive: "tendon", form: "trunk", task: "bend" });
    expect(found(WAYS, given)?.name).toBe("tendon-trunk-bend");
  });

  it("keep later answers that still lead somewhere, and drop others", () => {
    const trunk = answer(WAYS, {}, "drive", "tendon");
    expect(answer(WAYS, trunk, "drive", "pressure")).toEqual({ drive: "pressure" });
    const bending = answer(WAYS, { drive: "pressure", form: "finger" }, "task", "bend");
    expect(answer(WAYS, bending, "form", "finger")).toEqual(bending);
    expect(answer(WAYS, bending, "form", "bellows").task).toBe("extend");
  });

  it("have no result before all are answered", () => {
    expect(found(WAYS, { drive: "pressure", form: "finger" })).toBeNull();
    expect(QUESTIONS).toHaveLength(3);
  });
});

describe("when a file was used", () => {
  it("is said in words", () => {
    const now = Date.parse("2026-03-02T12:00:00Z");
    expect(whenWords("2026-03-02T11:59:30Z", now)).toBe("just now");
    expect(whenWords("2026-03-02T11:30:00Z", now)).toBe("30 minutes ago");
    expect(whenWords("2026-03-01T11:00:00Z", now)).toBe("yesterday");
    expect(whenWords("no time", now)).toBe("");
  });
});
