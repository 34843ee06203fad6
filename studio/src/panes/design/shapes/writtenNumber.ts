// A number of the document that a hand in the picture changes: the one that is written there, or the
// parameter that it is.
import { writeValue } from "../../../controls/kinds";
import type { Parameter } from "../../../protocol";
import type { Change, Path } from "../edits";
import { valuePath } from "../parameters/parameterPath";
import { type GripKind, NUMBERS } from "./gripKinds";

type Table = Readonly<Record<string, unknown>>;

export interface WrittenNumber {
  /** The parameter that is changed instead of the place. */
  readonly parameter: string | null;
  /** Why it cannot be changed in the picture. */
  readonly blocked: string | null;
  readonly least: number;
  readonly most: number;
  changes(value: number): Change[];
  /** Changes for a formula, which always goes to the place itself. */
  formula(text: string): Change[];
}

/** A number at a place of the document, as it is written there; `undefined` where nothing is. */
export function writtenNumber(
  path: Path,
  text: unknown,
  source: Table,
  parameters: readonly Parameter[],
  isLocked: (parameter: string) => boolean,
  kind: GripKind = "length",
): WrittenNumber {
  const ends = { least: Number.NEGATIVE_INFINITY, most: Number.POSITIVE_INFINITY };
  const here = (value: unknown): Change[] => [{ path, value }];
  const formula = typeof text === "string" && text.trim().startsWith("=") ? text.trim() : null;
  if (formula === null) {
    const changes = (value: number) => here(NUMBERS[kind].written(value));
    return { parameter: null, blocked: null, ...ends, changes, formula: here };
  }
  const name = formula.replace(/^=\s*/, "");
  const own = parameters.find((one) => one.name === name);
  const blocked = blockedBy(formula, own, own !== undefined && isLocked(name));
  if (!own || blocked)
    return { parameter: null, blocked, ...ends, changes: () => [], formula: here };
  return {
    ...{ parameter: name, blocked: null, formula: here },
    least: own.min ?? ends.least,
    most: own.max ?? ends.most,
    changes: (value) => [
      { path: valuePath(source, name), value: writeValue(value, own.factor, own.display_unit) },
    ],
  };
}

function blockedBy(formula: string, own: Parameter | undefined, locked: boolean): string | null {
  if (!own) return `follows the formula “${formula}”: change it in the form`;
  if (own.formula) return `is the parameter ${own.name}, which follows a formula itself`;
  return locked ? `is the parameter ${own.name}, which is locked` : null;
}

/** Several numbers that change by the same way, as one. */
export function together(
  all: readonly { readonly number: WrittenNumber; readonly value: number }[],
): WrittenNumber {
  const first = all[0]!;
  const more = (one: (typeof all)[number]) => one.value - first.value;
  return {
    parameter: all.find((one) => one.number.parameter)?.number.parameter ?? null,
    blocked: all.find((one) => one.number.blocked)?.number.blocked ?? null,
    least: Math.max(...all.map((one) => one.number.least - more(one))),
    most: Math.min(...all.map((one) => one.number.most - more(one))),
    changes: (value) => all.flatMap((one) => one.number.changes(value + more(one))),
    formula: first.number.formula,
  };
}
