import { describe, expect, it } from "vitest";
import type { Amounts } from "../../src/controls/formula";
import { formatKind, readWritten, writeValue } from "../../src/controls/kinds";

const PARAMETERS: Amounts = { wall: { value: 0.005, dimension: [1, 0, 0, 0, 0, 0] } };

describe("readWritten", () => {
  it("completes a bare number with the unit of its kind", () => {
    expect(readWritten("5", "length")).toEqual({ value: "5 mm" });
    expect(readWritten(" 2,5 ", "pressure")).toEqual({ value: "2.5 kPa" });
    expect(readWritten("30", "angle")).toEqual({ value: "30 deg" });
  });
  it("keeps the unit that was typed", () => {
    expect(readWritten("0.5 cm", "length")).toEqual({ value: "0.5 cm" });
    expect(readWritten("20mm", "length")).toEqual({ value: "20 mm" });
    expect(readWritten("2,5kPa", "pressure")).toEqual({ value: "2.5 kPa" });
    expect(readWritten("1 psi", "pressure")).toEqual({ value: "1 psi" });
  });
  it("passes text that only VoxSoft knows", () => {
    expect(readWritten("2 kip/ft^2", "modulus")).toEqual({ value: "2 kip/ft^2" });
    expect(readWritten("2 ft", "length")).toEqual({ value: "2 ft" });
    expect(readWritten("2*3 ft", "length")).toEqual({ value: "= 2*3 ft" });
    const byName = { wall: null };
    expect(readWritten("2*wall", "length", [], byName)).toEqual({ value: "= 2*wall" });
  });
  it("works arithmetic out", () => {
    expect(readWritten("2*5 mm", "length")).toEqual({ value: "10 mm" });
    expect(readWritten("5 mm + 0.5 cm", "length")).toEqual({ value: "10 mm" });
    expect(readWritten("2*5", "length")).toEqual({ value: "10 mm" });
    expect(readWritten("3*7", "number")).toEqual({ value: 21 });
    expect(readWritten("20 %", "number")).toEqual({ value: 0.2 });
    expect(readWritten("5 mm − 5 mm", "length")).toEqual({ value: 0 });
    expect(readWritten("90 deg/2", "angle")).toEqual({ value: "45 deg" });
  });
  it("takes text that names a parameter for a formula, with its = or without", () => {
    for (const typed of ["2*wall + 1 mm", "=2*wall + 1 mm", " = 2*wall + 1 mm"]) {
      expect(readWritten(typed, "length", [], PARAMETERS)).toEqual({ value: "= 2*wall + 1 mm" });
    }
    expect(readWritten("= 5 mm", "length", [], PARAMETERS)).toEqual({ value: "= 5 mm" });
    expect(readWritten("=0", "length", [], PARAMETERS)).toEqual({ value: "= 0" });
  });
  it.each([
    ["2*wal", '"wal" is not a parameter'],
    ["=wall*wall", "the formula gives an area; expected a length"],
    ["wall + 2", "give the number a unit"],
    ["wall/0", "divides by zero"],
    ["2*5 kPa", "a pressure; expected a length"],
  ])("says what is wrong with %s", (typed, words) => {
    const read = readWritten(typed, "length", [], PARAMETERS);
    expect("problem" in read && read.problem).toContain(words);
  });
  it("refuses a unit of another quantity, and text that is no number", () => {
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
