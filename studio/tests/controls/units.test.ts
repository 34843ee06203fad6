import { describe, expect, it } from "vitest";
import {
  cleaned,
  formatEnergy,
  formatNumber,
  formatQuantity,
  formatSpan,
  parseQuantity,
  shownUnit,
} from "../../src/controls/units";

const value = (text: string, unit: string) => {
  const read = parseQuantity(text, unit);
  if ("problem" in read) throw new Error(read.problem);
  return read.value;
};

describe("parseQuantity", () => {
  it.each([
    ["5 mm", "mm", 0.005],
    ["0.5 cm", "mm", 0.005],
    ["5", "mm", 0.005],
    ["5mm", "cm", 0.005],
    ["0,5 cm", "mm", 0.005],
    ["4 kPa", "kPa", 4000],
    ["1 psi", "kPa", 6894.757293168361],
    ["-9.81", "m/s^2", -9.81],
    ["90°", "deg", Math.PI / 2],
    ["1e3", "1", 1000],
    ["20 %", "1", 0.2],
    ["1.07 g/cm³", "kg/m^3", 1070],
    [".5 µm", "mm", 5e-7],
    ["2*5 mm", "mm", 0.01],
    ["5 mm + 0.5 cm", "mm", 0.01],
    ["2*5", "mm", 0.01],
    ["(1e1 - 5)/2", "cm", 0.025],
    ["10 mm / 2 mm", "1", 5],
    ["min(3, 4) * 2", "kPa", 6000],
    ["max(0,5 mm)", "mm", 0.005],
    ["5 mm - 5 mm", "mm", 0],
  ])("reads %s in a field of %s", (text, unit, expected) => {
    expect(value(text, unit)).toBeCloseTo(expected, 12);
  });

  it.each([
    ["", "mm", "no number"],
    ["wide", "mm", "no number"],
    ["5 kPa", "mm", "expected a length"],
    ["5 furlongs", "mm", "no unit"],
    ["1,000 mm", "mm", "two things"],
    ["1e999", "mm", "out of range"],
    ["2*5 kPa", "mm", "a pressure; expected a length"],
    ["5 mm * 2 mm", "mm", "an area; expected a length"],
    ["4 mm / 2 mm", "mm", "a plain number; expected a length"],
    ["5 + 5 mm", "mm", "cannot be added: give the number a unit"],
    ["2*", "mm", "is not complete"],
    ["2*wall", "mm", '"wall" is not a parameter'],
  ])("says what is wrong with %s", (text, unit, problem) => {
    const read = parseQuantity(text, unit);
    expect("problem" in read && read.problem).toContain(problem);
  });
});

describe("format", () => {
  it("tells small energies without powers of ten, and dust as nothing", () => {
    expect(formatEnergy(3.19e-3)).toBe("3.19 mJ");
    expect(formatEnergy(6.2e-8)).toBe("0.062 µJ");
    expect(formatEnergy(-5.7e-34)).toBe("0 mJ");
  });
  it("writes the units that people read", () => {
    expect(formatQuantity(0.02, "m")).toBe("20 mm");
    expect(formatQuantity(4000, "Pa")).toBe("4 kPa");
    expect(formatQuantity(1e-6, "m^3")).toBe("1 mL");
    expect(formatNumber(-0.00001234)).toBe("−1.23e−5");
    expect(formatNumber(Number.NaN)).toBe("–");
    expect(shownUnit("1")).toBe("1");
    expect(formatSpan(124)).toBe("2:04");
    expect(formatSpan(3730)).toBe("1:02:10");
  });

  it("reads back its own text", () => {
    for (const x of [0.005, 0.0123, 0.5, 1.25]) {
      const text = formatQuantity(x, "m").replace("−", "-");
      expect(value(text, "mm")).toBeCloseTo(x, 10);
    }
  });
});

it("says zero where only rounding is left", () => {
  expect(cleaned(1.16e-32, "J/m^3")).toBe(0);
  expect(cleaned(-1.46e-13, "Pa")).toBe(0);
  expect(cleaned(4.76e-14, "N")).toBe(0);
  expect(cleaned(1e-5, "m")).toBe(1e-5);
  expect(cleaned(1e-30, "1/s")).toBe(1e-30);
});
