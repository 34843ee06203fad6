// A number that is typed beside a grip: an amount goes where a drag would put it, a formula to its place.
import { readWritten } from "../../controls/kinds";
import { parseQuantity } from "../../controls/units";
import type { DocumentEvent } from "../../protocol";
import type { Change } from "./edits";
import { amountsOf } from "./useForm";
import type { WrittenNumber } from "./writtenNumber";

export function typedChanges(
  number: WrittenNumber,
  text: string,
  document: DocumentEvent | null,
): { readonly changes: readonly Change[] } | { readonly problem: string } {
  const names = Object.keys((document?.source?.parameters as object | undefined) ?? {});
  const amounts = document ? amountsOf(names, document) : {};
  const read = readWritten(text, "length", [], amounts);
  if ("problem" in read) return read;
  if (String(read.value).startsWith("=")) return { changes: number.formula(String(read.value)) };
  const amount = parseQuantity(String(read.value), "mm");
  if ("problem" in amount) return amount;
  const { least, most } = number;
  if (amount.value < least || amount.value > most) return { problem: outside(least, most) };
  return { changes: number.changes(amount.value) };
}

function outside(least: number, most: number): string {
  const mm = (meters: number) => `${Number((1e3 * meters).toFixed(3))} mm`;
  if (!Number.isFinite(most)) return `must be at least ${mm(least)}`;
  return Number.isFinite(least)
    ? `must be between ${mm(least)} and ${mm(most)}`
    : `must be at most ${mm(most)}`;
}
