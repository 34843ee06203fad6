import { describe, expect, it } from "vitest";
import { formatKind, readWritten, writeValue } from "../../src/controls/kinds";

describe("readWritten", () => {
  it("completes a bare number with the unit of its kind", () => {
    expect(readWritten("5", "length")).toEqual({ value: "5 mm" });
    expect(readWritten(" 2,5 ", "pressure")).toEqual({ value: "2.5 kPa" });
    expect(readWritten("30", "angle")).toEqual({ value: "30 deg" });
  });
  it("keeps the unit that was typed", () => {
    expect(readWritten("0.5 cm", "length")).toEqual({ value: "0.5 cm" });
    expect(readWritten("1 psi", "pressure")).toEqual({ value: "1 psi" });
  });
  it("passes units that only VoxSoft knows, and formulas", () => {
    expect(readWritten("2 GPa", "modulus")).toEqual({ value: "2 GPa" });
    expect(readWritten("=radius-wall", "length")).toEqual({ value: "= radius-wall" });
  });
  it("refuses a unit of another quantity, and what is no number", () => {
    expect(readWritten("5 kPa", "length")).toHaveProperty("problem");
    expect(readWritten("wide", "length")).toHaveProperty("problem");
    expect(readWritten("=", "length")).toHaveProperty("problem");
    expect(readWritten("many", "number")).toHaveProperty("problem");
  });
  it("writes zero without a unit, numbers as numbers, and words as they are", () => {
    expect(readWritten("0 mm", "length")).toEqual({ value: 0 });
    expect(readWritten("0.49", "number")).toEqual({ value: 0.49 });
    expect(readWritten("critical", "rate", ["auto", "critical"])).toEqual({ value: "critical" });
    expect(readWritten("-inf", "length")).toEqual({ value: "-inf" });
  });
});

it("writes a value of a slider without binary noise", () => {
  expect(writeValue(0.1 * 0.3, 1e-3, "mm")).toBe("30 mm");
  expect(writeValue(3, 1, "")).toBe(3);
  expect(writeValue(0, 1e-3, "mm")).toBe(0);
});

it("shows values of a kind with the unit that people read", () => {
  expect(formatKind(0.0123, "length")).toBe("12.3 mm");
  expect(formatKind(4000, "pressure")).toBe("4 kPa");
  expect(formatKind(null, "length")).toBe("–");
  expect(formatKind(2, "of nothing known")).toBe("2");
});
