// Steps of a slider whose value may stand between two of them.

/** True if a value is a whole number of steps above the least one, to rounding. */
export function isOnStep(value: number, min: number, step: number): boolean {
  const count = (value - min) / step;
  return Math.abs(count - Math.round(count)) < 1e-6;
}

/** The step at or beyond `to` for a slider that moves there from a value between two steps. */
export function stepToward(to: number, from: number, min: number, step: number): number {
  const count = (to - min) / step;
  const whole = to > from ? Math.ceil(count - 1e-9) : Math.floor(count + 1e-9);
  return Number((min + whole * step).toPrecision(12));
}
