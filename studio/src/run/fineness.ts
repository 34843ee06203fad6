// Verdict on the errors of an equilibrium: the numbers for which the mesh is fine enough.
import { siUnit } from "../controls/kinds";
import { cleaned, formatNumber } from "../controls/units";
import type { EquilibriumEvent } from "../protocol";

/** Errors up to these parts of a number count as small and as fair. */
const SMALL = 0.02;
const FAIR = 0.05;

/** A number of the result, with its error as a part of it. */
export interface Rated {
  readonly name: string;
  readonly share: number;
}

export interface Rating {
  readonly small: readonly Rated[];
  readonly fair: readonly Rated[];
  readonly beyond: readonly Rated[];
  /** Numbers whose error is not known. */
  readonly unknown: readonly string[];
}

/** All numbers of an equilibrium by the size of their errors, the largest error first. */
export function rated(found: EquilibriumEvent): Rating {
  const all = [
    ...found.probes.map(({ name, share }) => ({ name: `probe ${name}`, share })),
    // A number that is zero up to rounding has no relative error.
    ...found.metrics
      .filter(({ value, kind }) => value !== null && cleaned(value, siUnit(kind)) !== 0)
      .map(({ name, share }) => ({ name: name.replaceAll("_", " "), share })),
    ...found.chambers.map(({ name, share }) => ({ name: `growth of ${name}`, share })),
  ];
  const known = all
    .filter((one): one is Rated => one.share !== null)
    .sort((a, b) => b.share - a.share);
  return {
    small: known.filter(({ share }) => share <= SMALL),
    fair: known.filter(({ share }) => share > SMALL && share <= FAIR),
    beyond: known.filter(({ share }) => share > FAIR),
    unknown: [
      ...all.filter(({ share }) => share === null).map(({ name }) => name),
      "largest strain",
    ],
  };
}

export interface Verdict {
  readonly tone: "good" | "warn" | "bad";
  readonly words: string;
}

/** The answer in one sentence, or null where no error is known. */
export function verdict({ small, fair, beyond }: Rating): Verdict | null {
  const count = small.length + fair.length + beyond.length;
  if (count === 0) return null;
  if (beyond.length > 0) {
    const many = beyond.length === count ? "every number" : `${beyond.length} of ${count} numbers`;
    return { tone: "bad", words: `No: ${many} may be more than 5 % off.` };
  }
  if (fair.length > 0)
    return { tone: "warn", words: "Nearly: every number is within 5 %, not all within 2 %." };
  return { tone: "good", words: "Yes: every number with an error bar is within 2 %." };
}

/** Numbers with their errors in words, such as `probe tip 3.1 %`. */
export function inWords(some: readonly Rated[]): string {
  return some.map(({ name, share }) => `${name} ${formatNumber(100 * share, 2)} %`).join(", ");
}
