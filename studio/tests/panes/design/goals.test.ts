import { expect, it } from "vitest";
import { fittingKeys, readPercentile } from "../../../src/panes/design/Goals";
import type { Metric } from "../../../src/protocol";

const metric = (takes: Partial<Metric>): Metric => ({
  name: "max_stress",
  kind: "pressure",
  ...{ needs_probe: false, needs_base: false, needs_cavity: false },
  ...{ takes_percentile: false, needs_object: false },
  ...takes,
});

it("keeps a percentile only where the next metric takes one", () => {
  const value = { percentile: 99, max: "20 kPa" };
  expect(fittingKeys(metric({ takes_percentile: true }), value, [])).toEqual(value);
  expect(fittingKeys(metric({}), value, [])).toEqual({ max: "20 kPa" });
  expect(fittingKeys(metric({ needs_probe: true }), value, ["tip"])).toEqual({
    max: "20 kPa",
    probe: "tip",
  });
});

it("gives a line another probe to begin at", () => {
  const line = metric({ needs_probe: true, needs_base: true });
  expect(fittingKeys(line, {}, ["base", "tip"])).toEqual({ probe: "base", base: "tip" });
  expect(fittingKeys(line, { probe: "tip" }, ["base", "tip"])).toEqual({
    probe: "tip",
    base: "base",
  });
  expect(fittingKeys(metric({ needs_probe: true }), { probe: "tip", base: "base" }, [])).toEqual({
    probe: "tip",
  });
});

it("keeps an object only where the next metric asks of one", () => {
  const value = { object: "plate", max: "2 N" };
  expect(fittingKeys(metric({ needs_object: true }), value, [])).toEqual(value);
  expect(fittingKeys(metric({}), value, [])).toEqual({ max: "2 N" });
  // It is the first object where none was named, so that the form shows a choice.
  const needs = metric({ needs_object: true });
  expect(fittingKeys(needs, {}, [], ["ball", "plate"])).toEqual({ object: "ball" });
  expect(fittingKeys(needs, {}, [])).toEqual({});
});

it("reads a percentile, and refuses other text", () => {
  expect(readPercentile("99 %")).toEqual({ value: 99 });
  expect(readPercentile(" ")).toEqual({ value: null });
  for (const text of ["0", "100.5", "-1", "most"]) {
    expect(readPercentile(text)).toHaveProperty("problem");
  }
});
