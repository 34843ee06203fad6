// Fields of which rounding alone is left, as the stress of a body that nothing loads.
import { cleaned } from "../../controls/units";
import type { Frame } from "../../engine/frames";

/**
 * A frame whose field is zero everywhere if all its values are rounding errors of zero. One value
 * above that keeps all as they are: small values beside large ones are true ones.
 */
export function withoutDust(frame: Frame, unit: string | undefined): Frame {
  if (unit === undefined || frame.max === frame.min) return frame;
  const largest = Math.max(Math.abs(frame.min), Math.abs(frame.max));
  return cleaned(largest, unit) === 0 ? { ...frame, min: 0, max: 0 } : frame;
}
