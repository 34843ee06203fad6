// Sticking or slipping of surfaces, in words.
import { formatNumber } from "../controls/units";

/** Parts of the pressure under which all sticks, or all slips: bounds are right to a few percent. */
export const FEW = 0.02;

/** Describe sticking or slipping, by the part of the pressure under which surfaces slip. */
export function holdOf(slipping: number): string {
  if (slipping < FEW) return "sticks";
  if (slipping > 1 - FEW) return "slips";
  return `${formatNumber(100 * slipping, 2)} % slips`;
}
