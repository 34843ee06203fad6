// Ticks of the axes of plots, so that narrow and low ones can be read too.
import { formatNumber } from "./units";

// Pixels from one tick to the next: as wide as a label at least, and no wider than looks good.
const NARROWEST = 26;
const WIDEST = 50;
/** Height of a line of labels, pixels. */
const LINE = 16;

/**
 * Least distance of ticks along an axis of some pixels. Steps go by 1, 2, 2.5 and 5, so the
 * distance may become twice as large: a quarter of the length leaves two ticks at least.
 */
export function tickSpace(pixels: number): number {
  return Math.min(WIDEST, Math.max(NARROWEST, pixels / 4));
}

/** Powers of ten on a logarithmic axis, each or every second, third, ... as there is room. */
export function decades(low: number, high: number, pixels: number): number[] {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const room = Math.max(2, Math.floor(pixels / LINE));
  const step = Math.max(1, Math.ceil((last - first + 1) / room));
  const ticks: number[] = [];
  for (let power = first; power <= last; power += step) ticks.push(10 ** power);
  return ticks;
}

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A power of ten as it is read: 0.001 to 1000 in full, others as 10⁻⁴. */
export function decadeName(value: number): string {
  const power = Math.round(Math.log10(value));
  if (Math.abs(power) <= 3) return formatNumber(10 ** power, 1);
  const digits = [...String(Math.abs(power))].map((digit) => RAISED[Number(digit)]).join("");
  return `10${power < 0 ? "⁻" : ""}${digits}`;
}
