// Completion and help in the text of a design, from its schema.
import type { Completion, CompletionContext, CompletionResult } from "@codemirror/autocomplete";
import type { HelloEvent } from "../../../protocol";
import {
  controlOf,
  helpOfKeys,
  inside,
  labelOf,
  listSections,
  resolve,
  type Schema,
  schemaAt,
  summary,
} from "../fields/schema";
import { type Place, placeAt, type Step } from "./place";

/** The table of keys at a path, with the keys of its kind where that is known. */
export function tableAt(root: Schema, path: readonly Step[], read: unknown): Schema | null {
  const schema = schemaAt(root, path, read);
  if (!schema) return null;
  let control = controlOf(root, schema);
  if (control.is === "reference") control = controlOf(root, control.inline);
  if (control.is === "table") return control.schema;
  if (control.is === "variant") {
    const table = path.reduce<unknown>(inside, read);
    const chosen = String(inside(table, control.tag) ?? "");
    const variant = control.variants[chosen];
    if (variant) return variant;
    return { properties: { [control.tag]: { enum: Object.keys(control.variants) } } };
  }
  return null;
}

interface Offer {
  readonly label: string;
  readonly detail?: string;
  readonly info?: string;
  readonly plain?: boolean;
}

const words = (names: readonly string[]): Offer[] => names.map((label) => ({ label }));

function namesIn(read: Readonly<Record<string, unknown>>, section: string): string[] {
  return Object.keys((read[section] as object | undefined) ?? {});
}

/** Possible values, as far as they are known. */
export function valueOffers(
  hello: HelloEvent,
  place: Pick<Place, "path" | "word" | "quoted">,
  whole: Readonly<Record<string, unknown>>,
): Offer[] {
  const root = hello.design_schema as Schema;
  const key = place.path.at(-1);
  if (place.quoted && place.word.trimStart().startsWith("=")) {
    return words(namesIn(whole, "parameters"));
  }
  if (key === "cavity") return words(["all", ...namesIn(whole, "chambers")]);
  if (key === "probe") return words(namesIn(whole, "probes"));
  if (key === "maximize" || key === "minimize" || key === "metric") {
    return hello.metrics.map(({ name, kind }) => ({ label: name, detail: kind }));
  }
  const schema = schemaAt(root, place.path, whole);
  if (!schema) return [];
  const control = controlOf(root, schema);
  switch (control.is) {
    case "choice":
      return words(control.values);
    case "switch":
      return [
        { label: "true", plain: true },
        { label: "false", plain: true },
      ];
    case "quantity":
      return words(control.words);
    case "reference":
      if (control.to === "shapes") return words(namesIn(whole, "shapes"));
      return [
        ...words(namesIn(whole, "materials")),
        ...hello.materials.map((card) => ({
          label: card.name,
          detail: card.model,
          info: `${card.title}. ${card.source}`,
        })),
      ];
    default:
      return [];
  }
}

function keyOffers(root: Schema, place: Place): Completion[] {
  if (place.path.length === 0) {
    const lists = listSections(root);
    return Object.entries(root.properties ?? {})
      .filter(([name]) => !(name in place.read))
      .map(([name, schema]) => {
        const control = controlOf(root, schema);
        const header = lists.includes(name) ? `[[${name}]]` : `[${name}]`;
        const nests = control.is === "map" || control.is === "table" || lists.includes(name);
        return {
          label: name,
          type: "property",
          detail: nests ? header : "",
          apply: nests ? `${header}\n` : `${name} = `,
        };
      });
  }
  const table = tableAt(root, place.path, place.read);
  const there = place.path.reduce<unknown>(inside, place.read);
  const help = table ? helpOfKeys(table) : {};
  return Object.keys(table?.properties ?? {})
    .filter((key) => inside(there, key) === undefined)
    .map((key) => ({
      label: key,
      type: "property",
      apply: `${key} = `,
      boost: table?.required?.includes(key) ? 1 : 0,
      detail: table?.required?.includes(key) ? "needed" : "",
      info: help[key] ?? "",
    }));
}

function headerOffers(root: Schema): Completion[] {
  const tables = Object.entries(root.properties ?? {})
    .filter(([, schema]) => ["map", "table"].includes(controlOf(root, schema).is))
    .map(([name]) => name);
  return [...listSections(root), ...tables].map((label) => ({ label, type: "namespace" }));
}

/** The source of completions for the editor. */
export function completions(hello: () => HelloEvent | null) {
  return (context: CompletionContext): CompletionResult | null => {
    const known = hello();
    if (!known) return null;
    const text = context.state.doc.toString();
    const place = placeAt(text, context.pos);
    const root = known.design_schema as Schema;
    if (place.at === "comment") return null;
    if (place.at === "header") return { from: place.from, options: headerOffers(root) };
    if (place.at === "key") {
      if (place.word === "" && !context.explicit) return null;
      return { from: place.from, options: keyOffers(root, place), validFor: /^[\w-]*$/ };
    }
    // Names may be defined below this place: read the whole text for them.
    const whole = placeAt(text, text.length).read;
    const offers = valueOffers(known, place, whole);
    if (offers.length === 0) return null;
    const formula = place.quoted && place.word.trimStart().startsWith("=");
    const start = formula
      ? context.pos - (/[\w-]*$/.exec(place.word)?.[0].length ?? 0)
      : place.from;
    return {
      from: start,
      options: offers.map((offer) => ({
        label: offer.label,
        type: formula ? "variable" : "enum",
        ...(offer.detail ? { detail: offer.detail } : {}),
        ...(offer.info ? { info: offer.info } : {}),
        apply: place.quoted || offer.plain ? offer.label : `"${offer.label}"`,
      })),
      validFor: formula ? /^[\w-]*$/ : /^[^"']*$/,
    };
  };
}

export interface Help {
  readonly from: number;
  readonly to: number;
  readonly title: string;
  readonly text: string;
}

/** Description in the schema of the word at a position of the text. */
export function helpAt(hello: HelloEvent, text: string, position: number): Help | null {
  let end = position;
  while (end < text.length && /[\w-]/.test(text[end] ?? "")) end++;
  const place = placeAt(text, end);
  if (place.word === "" || position < place.from) return null;
  const root = hello.design_schema as Schema;
  const whole = placeAt(text, text.length).read;
  const at = { from: place.from, to: end };
  if (place.at === "key") {
    if (place.path.length === 0) {
      const schema = resolve(root, root.properties?.[place.word] ?? {});
      const said = summary(schema);
      return said ? { ...at, title: place.word, text: said } : null;
    }
    const table = tableAt(root, place.path, whole);
    const said = table && helpOfKeys(table)[place.word];
    return said ? { ...at, title: labelOf(place.word), text: said } : null;
  }
  if (place.at !== "value") return null;
  const card = hello.materials.find((one) => one.name === place.word);
  if (card) return { ...at, title: card.title, text: card.source };
  const owner = tableAt(root, place.path.slice(0, -1), whole);
  const key = place.path.at(-1);
  if ((key === "kind" || key === "model") && owner?.description) {
    return { ...at, title: place.word, text: summary(owner) };
  }
  return null;
}
