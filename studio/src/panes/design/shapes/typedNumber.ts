// A number that is typed beside a grip: an amount goes where a drag would put it, a formula to its place.
import { readWritten } from "../../../controls/kinds";
import { parseQuantity } from "../../../controls/units";
import type { DocumentEvent } from "../../../protocol";
import type { Change } from "../edits";
import { amountsOf } from "../useForm";
import { type GripKind, NUMBERS } from "./gripKinds";
import type { WrittenNumber } from "./writtenNumber";

export function typedChanges(
  { number, kind }: { readonly number: WrittenNumber; readonly kind: GripKind },
  text: string,
  document: DocumentEvent | null,
): { readonly changes: readonly Change[] } | { readonly problem: string } {
  const names = Object.keys((document?.source?.parameters as object | undefined) ?? {});
  const amounts = document ? amountsOf(names, document) : {};
  const about = NUMBERS[kind];
  // The number beside a factor has its sign before it.
  const typed = text.replace(/^\s*×/, "").replace(/cop(y|ies)\s*$/, "");
  const read = readWritten(typed, kind === "count" ? "number" : kind, [], amounts);
  if ("problem" in read) return read;
  if (String(read.value).startsWith("=")) return { changes: number.formula(String(read.value)) };
  const amount = parseQuantity(String(read.value), about.unit);
  if ("problem" in amount) return amount;
  if (kind === "count" && !Number.isInteger(amount.value))
    return { problem: "expected a whole number" };
  const { least, most } = number;
  const value = amount.value;
  if (value < least - SLACK || value > most + SLACK)
    return { problem: outside(least, most, about.text) };
  return { changes: number.changes(value) };
}

/** Rounding of a typed number at a bound. */
const SLACK = 1e-12;

function outside(least: number, most: number, text: (value: number) => string): string {
  if (!Number.isFinite(most)) return `must be at least ${text(least)}`;
  return Number.isFinite(least)
    ? `must be between ${text(least)} and ${text(most)}`
    : `must be at most ${text(most)}`;
}
