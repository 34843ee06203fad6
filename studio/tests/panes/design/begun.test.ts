import { expect, it } from "vitest";
import { firstConstraint, fitted, obstacleTo } from "../../../src/panes/design/fields/begun";
import type { Cavity } from "../../../src/protocol";

const chambers = (...names: string[]) => ({
  cavities: names.map((name): Cavity => ({ name, volume: 1e-6, area: 1e-4, center: [0, 0, 0] })),
});

it("adds no line between chambers that are not there", () => {
  expect(obstacleTo("connections", null)).toContain("none");
  expect(obstacleTo("connections", chambers("left"))).toContain("one");
  expect(obstacleTo("connections", chambers("left", ""))).toBeNull();
  expect(obstacleTo("supplies", chambers())).not.toBeNull();
  expect(obstacleTo("tendons", null)).toBeNull();
});

it("joins the chambers of the body, by their names where they have some", () => {
  const line = { chambers: [0, 1], tube: {} };
  expect(fitted("connections", line, chambers("left", "", "top"))).toEqual({
    chambers: ["left", 1],
    tube: {},
  });
  expect(fitted("tendons", line, null)).toBe(line);
});

it("bounds the mass so that the body keeps it", () => {
  expect(firstConstraint({ mass: 0.0206 })).toEqual({ metric: "mass", max: "30 g" });
  expect(firstConstraint(null)).toEqual({ metric: "mass", max: "200 g" });
});
