import { describe, expect, it } from "vitest";
import { cavityName, cavityOptions } from "../../src/controls/cavities";
import { controlOf, type Schema } from "../../src/panes/design/fields/schema";

describe("cavities", () => {
  it("are called by their name, or by the number that designs count", () => {
    expect(cavityName({ name: "left" }, 1)).toBe("left");
    expect(cavityName({ name: "" }, 0)).toBe("cavity 0");
  });

  it("are chosen by name; those without one by number, and the written one is kept", () => {
    const cavities = [{ name: "left" }, { name: "" }];
    const values = (current: string) =>
      cavityOptions(["left", "lost"], cavities, current).map((one) => one.value);
    expect(values("all")).toEqual(["all", "left", "lost", "1"]);
    expect(values("7")).toEqual(["all", "left", "lost", "1", "7"]);
  });

  it("have a control of their own wherever the schema says so", () => {
    const choice: Schema = {
      "x-names": "chambers",
      anyOf: [{ const: "all" }, { type: "integer" }],
    };
    expect(controlOf({}, choice)).toEqual({ is: "cavity" });
    expect(controlOf({}, { anyOf: [choice, { type: "null" }] })).toEqual({ is: "cavity" });
  });
});
