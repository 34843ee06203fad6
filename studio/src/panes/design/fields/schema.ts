// Reading of the JSON Schema of a design at one place: the control that belongs there.

export interface Schema {
  readonly $ref?: string;
  readonly $defs?: Readonly<Record<string, Schema>>;
  readonly type?: string | readonly string[];
  readonly enum?: readonly string[];
  readonly const?: string;
  readonly default?: unknown;
  readonly description?: string;
  readonly title?: string;
  readonly pattern?: string;
  readonly properties?: Readonly<Record<string, Schema>>;
  readonly required?: readonly string[];
  readonly additionalProperties?: Schema | boolean;
  readonly items?: Schema;
  readonly prefixItems?: readonly Schema[];
  readonly anyOf?: readonly Schema[];
  readonly oneOf?: readonly Schema[];
  readonly discriminator?: {
    readonly propertyName: string;
    readonly mapping: Readonly<Record<string, string>>;
  };
  readonly examples?: readonly unknown[];
  readonly "x-kind"?: string;
  readonly "x-names"?: string;
}

/** A control of the form. */
export type Control =
  | { readonly is: "quantity"; readonly kind: string; readonly words: readonly string[] }
  | { readonly is: "choice"; readonly values: readonly string[] }
  | { readonly is: "switch" }
  | { readonly is: "cavity" }
  | { readonly is: "text" }
  | { readonly is: "tuple"; readonly items: readonly Schema[] }
  | { readonly is: "list"; readonly item: Schema }
  | { readonly is: "table"; readonly schema: Schema }
  | { readonly is: "map"; readonly item: Schema }
  | {
      readonly is: "variant";
      readonly tag: string;
      readonly variants: Readonly<Record<string, Schema>>;
    }
  | { readonly is: "reference"; readonly to: "shapes" | "materials"; readonly inline: Schema }
  | { readonly is: "either"; readonly options: readonly Schema[] };

const TAGS: Readonly<Record<string, "shapes" | "materials">> = {
  kind: "shapes",
  model: "materials",
};

/** Follow a reference of the schema; keys beside the reference win. */
export function resolve(root: Schema, schema: Schema): Schema {
  if (!schema.$ref) return schema;
  const name = schema.$ref.split("/").at(-1) ?? "";
  const { $ref: _, ...beside } = schema;
  return { ...resolve(root, root.$defs?.[name] ?? {}), ...beside };
}

function withoutNull(options: readonly Schema[]): readonly Schema[] {
  return options.filter((option) => option.type !== "null");
}

/** Options of nested anyOf, flat and without null. */
function optionsOf(root: Schema, schema: Schema): readonly Schema[] {
  return withoutNull(schema.anyOf ?? []).flatMap((option) => {
    const inner = resolve(root, option);
    return inner.anyOf ? optionsOf(root, inner) : [inner];
  });
}

/** The control for a place of the schema. */
export function controlOf(root: Schema, given: Schema): Control {
  const schema = resolve(root, given);
  if (schema["x-kind"] !== undefined) {
    return { is: "quantity", kind: schema["x-kind"], words: [] };
  }
  if ([schema, ...(schema.anyOf ?? [])].some((one) => one["x-names"] === "chambers")) {
    return { is: "cavity" };
  }
  if (schema.enum) return { is: "choice", values: schema.enum };
  if (schema.const !== undefined) return { is: "choice", values: [schema.const] };
  if (schema.discriminator && schema.oneOf) return variants(root, schema);
  if (schema.anyOf) return either(root, optionsOf(root, schema));
  if (schema.prefixItems) return { is: "tuple", items: schema.prefixItems };
  if (schema.type === "array" && schema.items) return { is: "list", item: schema.items };
  if (schema.type === "boolean") return { is: "switch" };
  if (schema.type === "integer" || schema.type === "number") {
    return { is: "quantity", kind: "number", words: [] };
  }
  if (Array.isArray(schema.type)) return { is: "text" }; // a quantity of any kind
  if (schema.properties) return { is: "table", schema };
  if (typeof schema.additionalProperties === "object") {
    return { is: "map", item: schema.additionalProperties };
  }
  return { is: "text" };
}

function variants(root: Schema, schema: Schema): Control {
  const tag = schema.discriminator?.propertyName ?? "kind";
  const found: Record<string, Schema> = {};
  for (const [name, target] of Object.entries(schema.discriminator?.mapping ?? {})) {
    const inner = resolve(root, { $ref: target });
    // A function of Python has no form in a file.
    if (!("function" in (inner.properties ?? {}))) found[name] = inner;
  }
  return { is: "variant", tag, variants: found };
}

function either(root: Schema, options: readonly Schema[]): Control {
  const first = options[0];
  if (!first) return { is: "text" };
  if (options.length === 1) return controlOf(root, first);
  const inline = options.find((option) => option.discriminator);
  if (inline && options.some((option) => option.type === "string" && !option.enum)) {
    return {
      is: "reference",
      to: TAGS[inline.discriminator?.propertyName ?? ""] ?? "shapes",
      inline,
    };
  }
  const words = options.flatMap((option) =>
    option.enum ? option.enum : option.const !== undefined ? [option.const] : [],
  );
  const others = options.filter(
    // A text that begins with = is a formula, which every number field takes.
    (option) => !option.enum && option.const === undefined && !option.pattern,
  );
  const only = others[0];
  if (others.length === 0) return { is: "choice", values: words };
  if (only && others.length === 1) {
    const control = controlOf(root, only);
    if (control.is === "quantity") return { ...control, words };
    if (words.length === 0) return control;
    return { is: "either", options: [{ enum: words }, only] };
  }
  return { is: "either", options: others };
}

/** Which option of an `either` a value was written as. */
export function optionFor(root: Schema, options: readonly Schema[], value: unknown): number {
  const found = options.findIndex((option) => {
    const control = controlOf(root, option);
    if (Array.isArray(value)) return control.is === "tuple" || control.is === "list";
    if (typeof value === "object" && value !== null) {
      return control.is === "table" || control.is === "map" || control.is === "variant";
    }
    return control.is === "quantity" || control.is === "choice" || control.is === "text";
  });
  return Math.max(found, 0);
}

const HELP = new WeakMap<Schema, Readonly<Record<string, string>>>();

/** Descriptions of the keys of a table in its own description: "name" or "x, y" with indented text below. */
export function helpOfKeys(schema: Schema): Readonly<Record<string, string>> {
  const known = HELP.get(schema);
  if (known) return known;
  const found: Record<string, string> = {};
  const lines = (schema.description ?? "").split("\n");
  const start = lines.indexOf("Parameters");
  let keys: string[] = [];
  for (const line of start < 0 ? [] : lines.slice(start + 2)) {
    if (/^\S/.test(line)) {
      if (!/^[a-z_][\w ,]*$/.test(line)) break;
      keys = line.split(",").map((key) => key.trim());
    } else if (line.trim() === "") {
      keys = [];
    } else {
      for (const key of keys) found[key] = `${found[key] ?? ""} ${line.trim()}`.trim();
    }
  }
  for (const [key, inner] of Object.entries(schema.properties ?? {})) {
    if (inner.description && !("$ref" in inner)) found[key] ??= inner.description;
  }
  for (const key of Object.keys(found)) found[key] = plain(found[key] ?? "");
  HELP.set(schema, found);
  return found;
}

/** The first paragraph of a description, for tips. */
export function summary(schema: Schema): string {
  return plain((schema.description ?? "").split("\n\n")[0]?.replaceAll("\n", " ") ?? "");
}

/** A description without the marks of its source: of ":meth:`~a.b.young`" a reader needs "young". */
function plain(text: string): string {
  return text.replace(/:\w+:`~?(?:[\w.]+\.)?(\w+)`/g, "$1").replaceAll("``", "");
}

/** The sections of a design that are lists of tables, such as the loads. */
export function listSections(root: Schema): readonly string[] {
  const sections = Object.entries(root.properties ?? {});
  return sections
    .filter(([, schema]) => {
      const control = controlOf(root, schema);
      return (
        control.is === "list" && ["table", "variant"].includes(controlOf(root, control.item).is)
      );
    })
    .map(([name]) => name);
}

/** Name of one entry of a list: "Clamp" for "clamps", "Body" for "bodies". */
export function single(section: string): string {
  return labelOf(section.replace(/ies$/, "y").replace(/([^s])s$/, "$1"));
}

/** A key as a label: "top_radius" becomes "Top radius". */
export function labelOf(key: string): string {
  const words = key.replaceAll(/[_-]/g, " ");
  return words.length <= 1 ? words : words[0]?.toUpperCase() + words.slice(1);
}

/** Name of an entry of a list in a table of some kind: its number, or its role there. */
export function entryLabel(kind: string | undefined, index: number): string {
  if (kind === "difference") return index === 0 ? "From" : "Minus";
  return String(index + 1);
}

/** The schema of the place that a path of a document leads to, or null where it leads nowhere. */
export function schemaAt(
  root: Schema,
  path: readonly (string | number)[],
  document: unknown,
): Schema | null {
  let here: Schema | null = root;
  let value: unknown = document;
  for (const step of path) {
    here = stepInto(root, here, step, value);
    if (!here) return null;
    value = inside(value, step);
  }
  return resolve(root, here);
}

/** The value at one step of a path. */
export function inside(value: unknown, step: string | number): unknown {
  return typeof value === "object" && value !== null
    ? (value as Record<string | number, unknown>)[step]
    : undefined;
}

function stepInto(
  root: Schema,
  schema: Schema,
  step: string | number,
  value: unknown,
): Schema | null {
  const control = controlOf(root, schema);
  switch (control.is) {
    case "table":
      return control.schema.properties?.[step] ?? null;
    case "map":
      return control.item;
    case "list":
      return control.item;
    case "tuple":
      return control.items[Number(step)] ?? null;
    case "variant": {
      const tag = inside(value, control.tag);
      return control.variants[String(tag)]?.properties?.[step] ?? null;
    }
    case "reference":
      return stepInto(root, control.inline, step, value);
    case "either":
      for (const option of control.options) {
        const found = stepInto(root, option, step, value);
        if (found) return found;
      }
      return null;
    default:
      return null;
  }
}
