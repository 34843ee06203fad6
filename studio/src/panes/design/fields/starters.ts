// Value with which a place of a design begins when it is added.
import type { KINDS } from "../../../protocol";
import { controlOf, resolve, type Schema } from "./schema";

export interface Names {
  readonly shapes: readonly string[];
  readonly materials: readonly string[];
}

/** First value of each kind of quantity; a kind that is missing is an error of types. */
const FIRST: Readonly<Record<keyof typeof KINDS, string | number>> = {
  length: "10 mm",
  pressure: "1 kPa",
  modulus: "100 kPa",
  density: "1070 kg/m^3",
  force: "10 mN",
  acceleration: "9.81 m/s^2",
  time: "1 s",
  rate: "10 1/s",
  angle: "30 deg",
  area: "1 mm^2",
  volume: "1 mL",
  mass: "1 g",
  speed: "1 m/s",
  stiffness: "10 N/m",
  compliance: "0.01 m/N",
  "volume compliance": "1e-12 m^3/Pa",
  energy: "1 mJ",
  power: "10 mW",
  "angular speed": "1 rad/s",
  torque: "1 N*mm",
  "volume flow": "1 mL/s",
  "mass flow": "1 g/s",
  conductance: "0.1 L/s/bar",
  viscosity: "1e-3 Pa*s",
  temperature: "300 K",
  "thermal expansion": "3e-4 1/K",
  "magnetic field": "10 mT",
  voltage: "1 kV",
  "electric field": "10 MV/m",
  curvature: "1 1/m",
  number: 1,
};

/** A sensible value for a place, which the user then changes. */
export function starter(root: Schema, given: Schema, names: Names): unknown {
  const schema = resolve(root, given);
  const control = controlOf(root, schema);
  const usual = schema.default;
  if (schema.examples?.[0] !== undefined) return schema.examples[0];
  switch (control.is) {
    case "quantity":
      if (control.words.length > 0) return control.words[0];
      return typeof usual === "number" && control.kind === "number"
        ? usual
        : (FIRST[control.kind as keyof typeof KINDS] ?? 1);
    case "choice":
      return typeof usual === "string" ? usual : control.values[0];
    case "switch":
      return usual !== true;
    case "cavity":
      return "all";
    case "text":
      return typeof usual === "string" ? usual : "";
    case "tuple":
      if (Array.isArray(usual) && usual.every((one) => one === 0)) return usual;
      return control.items.map((item) => starter(root, item, names));
    case "list":
      return [starter(root, control.item, names)];
    case "map":
      return {};
    case "table":
      return tableStarter(root, control.schema, names);
    case "variant": {
      const [name, variant] = Object.entries(control.variants)[0] ?? ["", {}];
      return variantStarter(root, control.tag, name, variant, names);
    }
    case "reference":
      return names[control.to][0] ?? starter(root, control.inline, names);
    case "either":
      return starter(root, control.options[0] ?? {}, names);
  }
}

/** A table of a chosen variant with all that it requires. */
export function variantStarter(
  root: Schema,
  tag: string,
  name: string,
  variant: Schema,
  names: Names,
): Record<string, unknown> {
  return { [tag]: name, ...tableStarter(root, variant, names) };
}

function tableStarter(root: Schema, schema: Schema, names: Names): Record<string, unknown> {
  const table: Record<string, unknown> = {};
  for (const key of schema.required ?? []) {
    const inner = schema.properties?.[key];
    if (inner) table[key] = starter(root, inner, names);
  }
  // A place without any condition is nowhere: begin at the bottom.
  if (schema.properties?.z && schema.properties.center) table.z = [0, 0];
  return table;
}

/** Keep the keys that the new variant has too, so that a change of kind keeps its sizes. */
export function changeVariant(
  fresh: Readonly<Record<string, unknown>>,
  variant: Schema,
  before: Readonly<Record<string, unknown>>,
  tag: string,
): Record<string, unknown> {
  const kept = Object.entries(before).filter(
    ([key]) => key !== tag && variant.properties?.[key] !== undefined,
  );
  return { ...fresh, ...Object.fromEntries(kept) };
}

/** Name of a new material: by its model, as all models but the rigid one are of rubber. */
export function materialName(material: Readonly<Record<string, unknown>>): string {
  return material.model === "rigid" ? "rigid" : "rubber";
}

/** A name that is still free: "part", "part-2", ... */
export function freeName(requested: string, taken: Iterable<string>): string {
  const names = new Set(taken);
  if (!names.has(requested)) return requested;
  let number = 2;
  while (names.has(`${requested}-${number}`)) number += 1;
  return `${requested}-${number}`;
}
