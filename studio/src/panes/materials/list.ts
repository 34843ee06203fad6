// Which materials the browser lists, and in which order.
import type { MaterialFacts } from "../../protocol";

export const SORTS = {
  name: "Name",
  shore: "Shore hardness",
  young: "Young's modulus",
  stress: "Stress at 100 %",
  tested: "Tested stretch",
} as const;

export type Sort = keyof typeof SORTS;

/** Shore hardness on one scale, soft to hard: all of 00 is softer than A, and A than D. */
export function shoreOrder(shore: string): number | null {
  if (shore === "") return null;
  if (shore.startsWith("00-")) return Number(shore.slice(3));
  return Number.parseFloat(shore) + (shore.endsWith("D") ? 2000 : 1000);
}

const KEYS: Readonly<Record<Exclude<Sort, "name">, (one: MaterialFacts) => number | null>> = {
  shore: (one) => shoreOrder(one.shore),
  young: (one) => one.young,
  stress: (one) => one.stress_at_double,
  tested: (one) => one.tested_to,
};

/** Listed materials: the design's own first, then in order; unstated values come last. */
export function listed(
  materials: readonly MaterialFacts[],
  words: string,
  model: string,
  sort: Sort,
): MaterialFacts[] {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const found = materials.filter((one) => {
    const { name, title, same_as, source, shore } = one;
    const text = `${name} ${title} ${same_as} ${one.model} ${shore} ${source}`.toLowerCase();
    return (model === "" || one.model === model) && wanted.every((word) => text.includes(word));
  });
  const key = sort === "name" ? null : KEYS[sort];
  return found.sort((a, b) => {
    if (key === null) {
      const own = Number(a.origin === "card") - Number(b.origin === "card");
      return own || a.name.localeCompare(b.name);
    }
    const [first, second] = [key(a), key(b)];
    if (first === null || second === null) return Number(first === null) - Number(second === null);
    return first - second || a.name.localeCompare(b.name);
  });
}

/** The models that there are, in order. */
export function modelsOf(materials: readonly MaterialFacts[]): string[] {
  return [...new Set(materials.map((one) => one.model))].sort();
}

/** The part of a curve that was tested, and the part beyond, which begins where the other ends. */
export function testedAndBeyond(one: MaterialFacts): [number[], (number | null)[], number] {
  const { stretches, stresses, tested_to } = one;
  const count = tested_to === null ? 0 : stretches.filter((x) => x <= tested_to + 1e-9).length;
  return [stretches, stresses, count];
}
