// Pairs of contact in the text: entries of two things that differ from all others, read and written.
import type { Change } from "../edits";

type Table = Readonly<Record<string, unknown>>;
export type PairKind = "touching" | "none" | "bonded";

/** Contact of two things, as it is written: the last pair of theirs, or the entries for all. */
export interface Meeting {
  readonly kind: PairKind;
  readonly friction: unknown;
  /** True if it is written in a pair of their own. */
  readonly own: boolean;
}

export const pairsOf = (contact: unknown): readonly Table[] => {
  const pairs = (contact as { pairs?: unknown } | null | undefined)?.pairs;
  return Array.isArray(pairs) ? (pairs as Table[]) : [];
};

const isOf = ({ of }: Table, a: string, b: string) =>
  Array.isArray(of) && ((of[0] === a && of[1] === b) || (of[0] === b && of[1] === a));

export function meetingOf(contact: unknown, a: string, b: string): Meeting {
  const pair = pairsOf(contact).findLast((one) => isOf(one, a, b));
  const kind = pair?.kind === "none" || pair?.kind === "bonded" ? pair.kind : "touching";
  const all = (contact as { friction?: unknown } | null | undefined)?.friction ?? 0;
  return { kind, friction: pair?.friction ?? all, own: pair !== undefined };
}

/** The changes that make two things meet otherwise than all others. */
export function pairChanges(
  contact: unknown,
  of: readonly [string, string],
  says: Readonly<{ kind?: PairKind; friction?: number | string }>,
): Change[] {
  const pairs = pairsOf(contact);
  const value = { of: [...of], ...says };
  const at = pairs.findLastIndex((one) => isOf(one, ...of));
  if (contact === undefined) return [{ path: ["contact"], value: { pairs: [value] } }];
  if (at >= 0) return [{ path: ["contact", "pairs", at], value }];
  if (pairs.length === 0) return [{ path: ["contact", "pairs"], value: [value] }];
  return [{ path: ["contact", "pairs", pairs.length], value }];
}
