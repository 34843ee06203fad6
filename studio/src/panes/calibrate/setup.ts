// Conversion of the pane's choices to the calibration command.
import { siUnit } from "../../controls/kinds";
import type { CalibrateSpec, FitRange, MaterialCard, MeasuredEvent } from "../../protocol";
import { controlOf, helpOfKeys, resolve, type Schema } from "../design/fields/schema";
import type { CalibrateDraft } from "./draft";

/** The model of the material that the first part is made of. */
export function modelOf(
  source: Readonly<Record<string, unknown>>,
  cards: readonly MaterialCard[],
): { model: string; name: string } | null {
  const parts = source.parts as { material?: unknown }[] | undefined;
  const material = parts?.[0]?.material;
  if (typeof material === "object" && material !== null) {
    return { model: String((material as { model?: unknown }).model ?? ""), name: "its own" };
  }
  if (typeof material !== "string") return null;
  const own = (source.materials as Record<string, { model?: unknown }> | undefined)?.[material];
  if (own) return { model: String(own.model ?? ""), name: material };
  const card = cards.find((one) => one.name === material);
  return card ? { model: card.model, name: card.name } : null;
}

/** Why a calibration cannot start, in words with a remedy; null where it can. */
export function obstacle(
  draft: CalibrateDraft,
  measured: Readonly<Record<string, MeasuredEvent>>,
  constants: readonly FitRange[],
): string | null {
  if (draft.files.length === 0) return "Drop a table of measured points first.";
  for (const file of draft.files) {
    const event = measured[file.name];
    if (!event) return `${file.name} is being read.`;
    const problem = event.problems[0];
    if (problem) return `${file.name}: ${problem.what}.`;
  }
  const fitted = constants.filter((one) => draft.bounds[one.name]?.on ?? true);
  if (constants.length === 0) {
    return "Only a lattice or a hyperelastic material can be fitted; give one to the first part.";
  }
  if (fitted.length === 0) return "Choose at least one constant to fit.";
  for (const constant of fitted) {
    const { low, high } = boundsOf(draft, constant);
    if (!(low > 0 && low < high))
      return `${constant.name}: the range must be positive and not empty.`;
  }
  return null;
}

export function boundsOf(draft: CalibrateDraft, usual: FitRange): { low: number; high: number } {
  const bound = draft.bounds[usual.name];
  return { low: bound?.low ?? usual.low, high: bound?.high ?? usual.high };
}

/** The calibration to ask for. */
export function calibrateSpec(
  draft: CalibrateDraft,
  constants: readonly FitRange[],
): CalibrateSpec {
  const changed = constants.some(({ name }) => draft.bounds[name] !== undefined);
  const bounds: Record<string, [number, number]> = {};
  for (const constant of constants) {
    if (!(draft.bounds[constant.name]?.on ?? true)) continue;
    const { low, high } = boundsOf(draft, constant);
    bounds[constant.name] = [low, high];
  }
  return {
    kind: "calibrate",
    data: draft.files.map((file) => ({
      name: file.name,
      columns: file.columns === null ? null : [...file.columns],
      select: file.select,
    })),
    method: draft.method,
    generations: Math.round(draft.generations),
    population: Math.round(draft.population),
    seed: Math.round(draft.seed),
    free_scale: draft.freeScale,
    refine: draft.refine,
    identify: draft.identify,
    // Without bounds VoxSoft takes its own.
    ...(changed ? { bounds } : {}),
    ...(draft.name.trim() ? { name: draft.name.trim() } : {}),
  };
}

/** Descriptions in a design of each constant of a model, for tips. */
export function helpOfModel(root: Schema, model: string): Readonly<Record<string, string>> {
  const map = resolve(root, root.properties?.materials ?? {}).additionalProperties;
  const control = typeof map === "object" ? controlOf(root, map) : null;
  return control?.is === "variant" ? helpOfKeys(control.variants[model] ?? {}) : {};
}

/** A material in SI numbers, as a design file writes it: each number with its unit. */
export function withUnits(
  root: Schema,
  material: Readonly<Record<string, unknown>>,
): Record<string, unknown> {
  const map = resolve(root, root.properties?.materials ?? {}).additionalProperties;
  const control = typeof map === "object" ? controlOf(root, map) : null;
  if (control?.is !== "variant") return { ...material };
  const variant = control.variants[String(material[control.tag])];
  const write = (value: unknown, schema: Schema | undefined): unknown => {
    if (!schema || value === null) return value;
    const inner = resolve(root, schema);
    const found = controlOf(root, inner);
    if (typeof value === "number" && found.is === "quantity") {
      const unit = siUnit(found.kind);
      const number = Number(value.toPrecision(6));
      return unit === "1" || number === 0 ? number : `${number} ${unit}`;
    }
    if (Array.isArray(value) && found.is === "list") {
      return value.map((one) => write(one, found.item));
    }
    return value;
  };
  return Object.fromEntries(
    Object.entries(material)
      .filter(([, value]) => value !== null && !(Array.isArray(value) && value.length === 0))
      .map(([key, value]) => [key, write(value, variant?.properties?.[key])]),
  );
}
