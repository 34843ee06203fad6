// The page reads formulas as VoxSoft does: both are held to the cases of tests/unit/design/formulas.json.
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import type { Dimension } from "../../src/controls/dimension";
import { type Amounts, evaluate } from "../../src/controls/formula";
import { COMMON_UNITS } from "../../src/controls/unitTable";

interface Cases {
  common_units: string[];
  dimensions: Record<string, Dimension>;
  parameters: Record<string, { value: number; kind: string }>;
  values: { formula: string; value: number; kind: string }[];
  refused: { formula: string; words: string[] }[];
}

const file = new URL("../../../tests/unit/design/formulas.json", import.meta.url);
const cases = JSON.parse(readFileSync(file, "utf8")) as Cases;
const dimensionOf = (kind: string) => cases.dimensions[kind];
const parameters = Object.fromEntries(
  Object.entries(cases.parameters).map(([name, { value, kind }]) => [
    name,
    { value, dimension: dimensionOf(kind) },
  ]),
) as Amounts;

describe("evaluate", () => {
  it.each(cases.values)("reads $formula", ({ formula, value, kind }) => {
    const found = evaluate(formula, parameters);
    if ("problem" in found) throw new Error(found.problem);
    expect(found.value).toBeCloseTo(value, 14 - Math.ceil(Math.log10(Math.abs(value) || 1)));
    expect(found.dimension).toEqual(dimensionOf(kind));
  });

  it.each(cases.refused)("refuses $formula", ({ formula, words }) => {
    const found = evaluate(formula, parameters);
    for (const word of words) expect("problem" in found && found.problem).toContain(word);
  });

  it("refuses formulas deeper or longer than VoxSoft allows", () => {
    expect(evaluate(`=${"(".repeat(60)}1${")".repeat(60)}`)).toHaveProperty("problem");
    expect(evaluate(`=1${"+1".repeat(500)}`)).toHaveProperty("problem");
  });

  it("knows the same units of daily use", () => {
    expect([...COMMON_UNITS].sort()).toEqual([...cases.common_units].sort());
  });
});
