import { describe, expect, it } from "vitest";
import type { CalibrateDraft } from "../../src/panes/calibrate/draft";
import { marksOf } from "../../src/panes/calibrate/marksOf";
import { bestPlane, fitPlane } from "../../src/panes/calibrate/plane";
import {
  calibrateSpec,
  helpOfModel,
  modelOf,
  obstacle,
  withUnits,
} from "../../src/panes/calibrate/setup";
import { errorsText, generationsText } from "../../src/panes/calibrate/text";
import type { GenerationEvent, MeasuredEvent } from "../../src/protocol";

const DRAFT: CalibrateDraft = {
  files: [{ name: "beam.csv", text: "", columns: null, select: null }],
  name: "",
  method: "genetic",
  generations: 5,
  population: 4,
  seed: 0,
  freeScale: true,
  refine: true,
  identify: false,
  bounds: {},
};
const read = (problems: MeasuredEvent["problems"]): MeasuredEvent => ({
  t: "measured",
  name: "beam.csv",
  columns: [],
  quantities: [],
  stations: 9,
  materials: [],
  arcs: [],
  points: [],
  problems,
});

it("finds the model of the first part, whether card, own material or inline", () => {
  const cards = [{ name: "soft", title: "", source: "", model: "lattice", young: null }];
  const parts = (material: unknown) => ({ parts: [{ shape: "body", material }] });
  expect(modelOf(parts("soft"), cards)).toEqual({ model: "lattice", name: "soft" });
  expect(modelOf(parts({ model: "yeoh" }), cards)?.model).toBe("yeoh");
  const own = { ...parts("mine"), materials: { mine: { model: "gent" } } };
  expect(modelOf(own, cards)?.model).toBe("gent");
  expect(modelOf({}, cards)).toBeNull();
});

describe("a calibration", () => {
  const lattice = [
    { name: "edge", kind: "modulus", low: 1e3, high: 1e6 },
    { name: "bulk", kind: "modulus", low: 2e3, high: 1e6 },
  ];
  it("leaves the usual ranges to VoxSoft until one is changed", () => {
    expect(calibrateSpec(DRAFT, lattice)).not.toHaveProperty("bounds");
    const draft = {
      ...DRAFT,
      bounds: {
        edge: { on: true, low: 2e4, high: null },
        bulk: { on: false, low: null, high: null },
      },
    };
    expect(calibrateSpec(draft, lattice).bounds).toEqual({ edge: [2e4, 1e6] });
  });
  it("lists missing entries", () => {
    expect(obstacle({ ...DRAFT, files: [] }, {}, lattice)).toMatch(/Drop a table/);
    expect(obstacle(DRAFT, {}, lattice)).toMatch(/being read/);
    const bad = [
      { severity: "error", where: "column s", what: "needs a unit", hint: "", at: null },
    ] as const;
    expect(obstacle(DRAFT, { "beam.csv": read([...bad]) }, lattice)).toMatch(/needs a unit/);
    expect(obstacle(DRAFT, { "beam.csv": read([]) }, lattice)).toBeNull();
    expect(obstacle(DRAFT, { "beam.csv": read([]) }, [])).toMatch(/lattice or a hyperelastic/);
    const off = { on: false, low: null, high: null };
    const none = { ...DRAFT, bounds: { edge: off, bulk: off } };
    expect(obstacle(none, { "beam.csv": read([]) }, lattice)).toMatch(/at least one constant/);
  });
});

it("writes a fitted material with the units that a design file needs", () => {
  const root = {
    properties: {
      materials: {
        type: "object",
        additionalProperties: {
          discriminator: { propertyName: "model", mapping: { ogden: "#/$defs/Ogden" } },
          oneOf: [{ $ref: "#/$defs/Ogden" }],
        },
      },
    },
    $defs: {
      Ogden: {
        type: "object",
        properties: {
          model: { const: "ogden" },
          poisson: { "x-kind": "number" },
          mu: { type: "array", items: { "x-kind": "modulus" } },
          prony: { type: "array", items: {} },
        },
      },
    },
  };
  const material = { model: "ogden", poisson: 0.499, mu: [24400.0000001, 0], prony: [] };
  expect(withUnits(root, material)).toEqual({
    model: "ogden",
    poisson: 0.499,
    mu: ["24400 Pa", 0],
  });
});

it("describes a constant of a model", () => {
  const lattice = {
    description: "Springs.\n\nParameters\n----------\nedge\n    How hard it resists stretch.",
    properties: { edge: { type: "number" } },
  };
  const root = {
    $defs: { Lattice: lattice },
    properties: {
      materials: {
        additionalProperties: {
          discriminator: { propertyName: "model", mapping: { lattice: "#/$defs/Lattice" } },
          oneOf: [{ $ref: "#/$defs/Lattice" }],
        },
      },
    },
  };
  expect(helpOfModel(root, "lattice")).toEqual({ edge: "How hard it resists stretch." });
  expect(helpOfModel(root, "unknown")).toEqual({});
});

it("looks at a shape from where it is widest, at one scale for both axes", () => {
  expect(
    bestPlane([
      [0, 0, 0],
      [0.1, 0.001, -0.05],
    ]),
  ).toEqual([0, 2]);
  const margin = { left: 0, right: 0, top: 0, bottom: 0 };
  const fitted = fitPlane(
    [
      [0, 0],
      [2, 1],
    ],
    100,
    100,
    margin,
  );
  expect(fitted.scale).toBe(50);
  expect([fitted.toX(0), fitted.toX(2)]).toEqual([0, 100]);
  expect(fitted.toY(1)).toBeLessThan(fitted.toY(0));
});

it("says the error at each measured point in mm and in percent", () => {
  const marks = marksOf([
    {
      name: "tip.csv",
      measured: [[0.03, 0, -0.015]],
      simulated: [[0.03, 0, -0.0125]],
      error: [0.0025],
      percent: [3.3333],
    },
  ]);
  expect(marks.map((mark) => mark.text)).toEqual(["2.5 mm, 3.33 %"]);
  expect(marks[0]?.title).toBe("tip.csv, station 1: off by 2.5 mm, 3.33 % of the sag");
});

it("copies errors and generations in SI units, each column with its unit", () => {
  const station = { experiment: "tip", station: "arc 30 mm", measured: [-0.015], error: 0.001 };
  expect(errorsText([{ ...station, simulated: [-0.014], percent: 1.3 }], ["dz"])).toBe(
    "table\tstation\tdz measured (m)\tdz simulated (m)\terror (m)\terror (% of the sag)\n" +
      "tip\tarc 30 mm\t-0.015\t-0.014\t0.001\t1.3\n",
  );
  const generation: GenerationEvent = {
    t: "generation",
    job: "a",
    index: 1,
    best: 0.5,
    mean: 0.2,
    error: null,
    parameters: { edge: 2e4 },
    spread: {},
  };
  expect(generationsText([generation])).toBe(
    "generation\tbest fitness\tmean fitness\terror (m)\t" +
      "edge (Pa)\tedge lowest (Pa)\tedge highest (Pa)\n1\t0.5\t0.2\t\t20000\t\t\n",
  );
});
