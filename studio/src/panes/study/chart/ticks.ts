// Round numbers along an axis.

/** Round values within a range, about `count` of them. */
export function ticks(low: number, high: number, count: number): number[] {
  if (!(high > low) || !Number.isFinite(high - low)) return [low];
  const rough = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((one) => one >= rough * 0.999) ?? rough;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  const found: number[] = [];
  for (let i = first; i <= last; i++) found.push(Number((i * step).toPrecision(12)));
  return found;
}

/** A range that is a little wider on both sides, so that points do not touch the frame. */
export function padded([low, high]: readonly [number, number], share = 0.06): [number, number] {
  const pad = (high - low) * share;
  return [low - pad, high + pad];
}
