// Kinds of number that grips change: how each is written, shown and read, and its steps.
import { formatNumber, formatQuantity } from "../../../controls/units";
import { written } from "../bodies/placing";

/** The kind of a quantity as the schema names it, or a number of copies. */
export type GripKind = "length" | "angle" | "number" | "count";

export interface KindOfNumber {
  /** Steps at which drags end, and the fine ones of drags and keys with Shift, SI. */
  readonly step: number;
  readonly fine: number;
  /** Unit of a typed number without one. */
  readonly unit: string;
  text(value: number): string;
  /** Value as a design has it. */
  written(value: number): unknown;
}

const DEGREE = Math.PI / 180;
/** A number without the noise of binary fractions. */
const short = (value: number, digits: number) => Number(value.toFixed(digits)) + 0;

export const NUMBERS: Readonly<Record<GripKind, KindOfNumber>> = {
  length: {
    ...{ step: 5e-4, fine: 1e-4, unit: "mm" },
    text: (value) => formatQuantity(value, "m", 5),
    written: (value) => (Math.abs(value) < 5e-7 ? 0 : written(value)),
  },
  angle: {
    ...{ step: 5 * DEGREE, fine: DEGREE, unit: "deg" },
    text: (value) => `${formatNumber(short(value / DEGREE, 3), 5)}°`,
    written: (value) => (Math.abs(value) < 1e-9 ? 0 : `${short(value / DEGREE, 3)} deg`),
  },
  number: {
    ...{ step: 0.05, fine: 0.01, unit: "1" },
    text: (value) => `× ${formatNumber(value, 4)}`,
    written: (value) => short(value, 6),
  },
  count: {
    ...{ step: 1, fine: 1, unit: "1" },
    text: (value) => (value === 1 ? "1 copy" : `${value} copies`),
    written: (value) => Math.round(value),
  },
};
