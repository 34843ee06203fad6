import { describe, expect, it } from "vitest";
import { chosenUse } from "../../src/shell/dropTable";

describe("a table that was dropped", () => {
  it("goes to the pane that its columns are for", () => {
    expect(chosenUse(["coupon"], ["path", "view"])).toBe("coupon");
    expect(chosenUse(["stations"], ["design"], "coupon")).toBe("stations");
  });
  it("goes to the pane in front where the columns leave it open", () => {
    expect(chosenUse(["curve", "stations"], ["calibrate", "view"])).toBe("stations");
    expect(chosenUse(["coupon", "curve"], ["path"])).toBe("curve");
    expect(chosenUse(["coupon", "curve"], ["text"])).toBe("coupon");
    expect(chosenUse(["coupon", "curve"], ["text"], "curve")).toBe("curve");
  });
});
