// Sections of the document as the form reads them.
import { resolve, type Schema } from "./fields/schema";

type Source = Readonly<Record<string, unknown>>;

const isTable = (value: unknown): value is Source =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/**
 * Leave out sections that are no lists or tables where the schema has such; entries of lists of
 * tables that are none become empty ones, so that the others keep their places. The text underlines
 * them, and the form has no fields for them.
 */
export function wellFormed(source: Source, root: Schema): Source {
  const entries = Object.entries(source).flatMap(([key, value]): [string, unknown][] => {
    const schema = resolve(root, root.properties?.[key] ?? {});
    if (schema.items) {
      if (!Array.isArray(value)) return [];
      const item = resolve(root, schema.items);
      const ofTables = item.properties ?? item.oneOf;
      return [[key, ofTables ? value.map((one) => (isTable(one) ? one : {})) : value]];
    }
    const isSection = schema.properties ?? typeof schema.additionalProperties === "object";
    return isSection && !isTable(value) ? [] : [[key, value]];
  });
  return Object.fromEntries(entries);
}
