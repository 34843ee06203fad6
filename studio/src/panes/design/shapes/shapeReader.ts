// A shape as its grips see it: as it is written, and its values; and the fields of a grip.
import type { Parameter, Triple } from "../../../protocol";
import type { Change } from "../edits";
import { isLocked } from "../parameters/locks";
import type { GripKind } from "./gripKinds";
import { type WrittenNumber, writtenNumber } from "./writtenNumber";

type Table = Readonly<Record<string, unknown>>;

/** The way of a grip: along an axis, to the side of one as it is seen (of none: to any side), or on a ring about one. */
export type Way =
  | { readonly along: Triple }
  | { readonly around: Triple | null }
  | { readonly about: Triple };

/** Change of a shape's picture while a grip is held: stretched along its way, across an axis or in all, or turned. */
export type Stretch = "along" | "across" | "all" | "turn" | "none";

export interface ShapeGrip {
  readonly id: string;
  /** Name of its number, in words. */
  readonly label: string;
  /** Stands before the number. */
  readonly sign: string;
  readonly moves: boolean;
  readonly way: Way;
  /** Fixed point, m. */
  readonly from: Triple;
  /** End of the number along the way from there, m; grips that move have none. */
  readonly reach: number;
  readonly kind: GripKind;
  /** The number, SI, and how much it grows for each meter that the grip goes, or radian on a ring. */
  readonly value: number;
  readonly rate: number;
  readonly stretch: Stretch;
  readonly number: WrittenNumber;
  /** Place of one that moves, m; default: in the middle of the shape. */
  readonly at?: Triple;
  /** Motion of the shape for each unit of the number; default: along its way where it moves. */
  readonly shift?: Triple;
  /** Lines that show the meaning of the number, m. */
  outline?(value: number): readonly (readonly Triple[])[];
}

export const AXES = ["x", "y", "z"] as const;
export const ORIGIN: Triple = [0, 0, 0];
export const unit = (axis: number): Triple => AXES.map((_, i) => (i === axis ? 1 : 0)) as Triple;
const numbersOf = (value: unknown): Triple | null =>
  Array.isArray(value) && value.length === 3 && value.every((one) => typeof one === "number")
    ? (value as Triple)
    : null;

/** An axis as a direction of length one. */
export function directionOf(axis: unknown): Triple {
  if (typeof axis === "string") return unit(Math.max(AXES.indexOf(axis as "x"), 0));
  const given = numbersOf(axis) ?? [0, 0, 1];
  const long = Math.hypot(...given) || 1;
  return given.map((x) => x / long) as Triple;
}

/** Reads one shape, as it is written and as it comes out. */
export class Reader {
  constructor(
    private readonly path: readonly (string | number)[],
    private readonly text: Table,
    readonly solved: Table,
    private readonly source: Table,
    private readonly parameters: readonly Parameter[],
  ) {}

  get kind(): string {
    return String(this.solved.kind);
  }

  has(key: string): boolean {
    return key in this.text;
  }

  point(key: string): Triple {
    return numbersOf(this.solved[key]) ?? ORIGIN;
  }

  value(key: string): number {
    return Number(this.solved[key]);
  }

  number(key: string, kind: GripKind = "length"): WrittenNumber {
    return this.written([...this.path, key], this.text[key], kind);
  }

  /** One of three numbers; a place that is not written is the origin, and is written whole. */
  numberOf(key: string, axis: number, kind: GripKind = "length"): WrittenNumber {
    const path = [...this.path, key];
    const all = this.text[key];
    if (Array.isArray(all)) return this.written([...path, axis], all[axis], kind);
    const one = this.written(path, 0, kind);
    const whole = (changes: readonly Change[]) =>
      changes.map(({ value }) => ({ path, value: AXES.map((_, i) => (i === axis ? value : 0)) }));
    return {
      ...one,
      changes: (value) => whole(one.changes(value)),
      formula: (text) => whole(one.formula(text)),
    };
  }

  private written(
    path: readonly (string | number)[],
    text: unknown,
    kind: GripKind,
  ): WrittenNumber {
    return writtenNumber(path, text, this.source, this.parameters, isLocked, kind);
  }
}
