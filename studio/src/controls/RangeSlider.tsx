// A slider with two ends over the values that there are, drawn as small bars behind it.
import { type CSSProperties, useMemo } from "react";
import "./range.css";

export interface RangeSliderProps {
  label: string;
  /** All values; others than finite ones do not count. */
  values: readonly number[];
  /** Kept range; infinite where an end is open. */
  range: readonly [number, number];
  /** Allowed range, whose ends are marked; infinite where open. */
  allowed?: readonly [number, number];
  /** A value in words, such as "4.2 mm". */
  text(value: number): string;
  /** Called at once while an end is dragged; null where both ends are open. */
  onChange(range: readonly [number, number] | null): void;
}

/** Steps from one end to the other. */
const STEPS = 200;
const BARS = 28;

export function RangeSlider(props: RangeSliderProps) {
  const { label, values, range, text, onChange } = props;
  const finite = useMemo(() => values.filter(Number.isFinite), [values]);
  const [least, most] = [Math.min(...finite), Math.max(...finite)];
  const bars = useMemo(() => heights(finite, least, most), [finite, least, most]);
  if (!(most > least)) return null;
  const toStep = (value: number) =>
    Math.round(((Math.min(most, Math.max(least, value)) - least) / (most - least)) * STEPS);
  const toValue = (step: number) => least + (step / STEPS) * (most - least);
  const [low, high] = [toStep(range[0]), toStep(range[1])];
  const set = (from: number, to: number) => {
    if (from <= 0 && to >= STEPS) onChange(null);
    else onChange([from <= 0 ? -Infinity : toValue(from), to >= STEPS ? Infinity : toValue(to)]);
  };
  const end = (which: "from" | "to", value: number, move: (step: number) => void) => (
    <input
      type="range"
      aria-label={`${label}, ${which === "from" ? "at least" : "at most"}`}
      aria-valuetext={text(toValue(value))}
      min={0}
      max={STEPS}
      value={value}
      onChange={(event) => move(Number(event.target.value))}
      onDoubleClick={() => onChange(null)}
    />
  );
  return (
    <div className="range-slider" title="Drag the ends; double-click to take any value again">
      <svg viewBox={`0 0 ${BARS} 1`} preserveAspectRatio="none" aria-hidden="true">
        {bars.map((height, i) => {
          const middle = ((i + 0.5) / BARS) * STEPS;
          const kept = middle >= low && middle <= high;
          const key = `bar ${i}`;
          return (
            <rect
              key={key}
              className={kept ? "is-kept" : ""}
              x={i + 0.1}
              width="0.8"
              y={1 - height}
              height={height}
            />
          );
        })}
      </svg>
      {props.allowed
        ?.filter((end) => end > least && end < most)
        .map((end) => (
          <span
            key={end}
            className="range-bound"
            title={`Allowed up to here: ${text(end)}`}
            style={{ "--at": (end - least) / (most - least) } as CSSProperties}
          />
        ))}
      <span className="range-track">
        <i style={{ left: `${(low / STEPS) * 100}%`, right: `${(1 - high / STEPS) * 100}%` }} />
      </span>
      {end("from", low, (step) => set(Math.min(step, high), high))}
      {end("to", high, (step) => set(low, Math.max(step, low)))}
    </div>
  );
}

/** Numbers of values in equal bins, over the largest such number. */
function heights(values: readonly number[], least: number, most: number): number[] {
  const counts = new Array<number>(BARS).fill(0);
  for (const value of values) {
    const bin = Math.min(BARS - 1, Math.floor(((value - least) / (most - least)) * BARS));
    counts[bin] = (counts[bin] ?? 0) + 1;
  }
  const largest = Math.max(1, ...counts);
  return counts.map((count) => (count > 0 ? 0.12 + 0.88 * (count / largest) : 0));
}
