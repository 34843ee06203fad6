import { useState } from "react";
import { Select } from "../../controls/Choice";
import {
  factorOf,
  formatNumber,
  formatQuantity,
  parseQuantity,
  shownUnit,
  unitText,
} from "../../controls/units";
import { useStudio } from "../../store/studio";
import { type RangeMode, setView, useShown, useView } from "../../store/view";
import { gradient } from "../body/colormaps";
import { CLIP } from "../body/colorRange";

const SHARES = [1, 0.75, 0.5, 0.25, 0];
const RANGES: { value: RangeMode; label: string }[] = [
  { value: "auto", label: "auto range" },
  { value: "symmetric", label: "symmetric" },
  { value: "locked", label: "locked" },
];

/** The colors with their values; the ends of a locked range can be typed. */
export function Legend() {
  const { coloring, colormap, bands, range, field } = useView();
  const low = useShown((shown) => shown.low);
  const high = useShown((shown) => shown.high);
  const clipped = useShown((shown) => shown.clipped);
  const about = useStudio((state) => state.hello?.fields.find((one) => one.id === field));
  const frame = useShown((shown) => shown.frame);
  // Until a frame with the values of another field comes, its range is that of the field before.
  const here = useShown((shown) => shown.field) === field;
  const solved = useStudio((state) => state.moments.get(frame)?.fields ?? false);
  const [shut, setShut] = useState(false);
  if (coloring !== "field" || !about) return null;
  const unknown = about.contact && !solved;
  const unit = shownUnit(about.unit);
  const factor = factorOf(unit);
  const lock = (mode: RangeMode) =>
    setView(mode === "locked" ? { range: mode, low, high } : { range: mode });
  return (
    <aside className="legend" aria-label={`Colors: ${about.title}`} data-testid="legend">
      <button
        type="button"
        className="legend-title"
        aria-expanded={!shut}
        onClick={() => setShut(!shut)}
      >
        {about.title}
        {unitText(unit) && <span className="muted"> {unitText(unit)}</span>}
      </button>
      {!shut && unknown && (
        <p className="muted legend-flat" data-testid="legend-unknown">
          known where Solve has ended
        </p>
      )}
      {!shut && !unknown && here && high <= low && range !== "locked" && (
        <p className="muted legend-flat">{formatNumber(low / factor, 3)} everywhere</p>
      )}
      {!shut && !unknown && here && (high > low || range === "locked") && (
        <>
          <div className="legend-scale">
            <div className="legend-bar" style={{ background: gradient(colormap, bands) }} />
            <div className="legend-ticks">
              {SHARES.map((share) => {
                const value = low + (high - low) * share;
                const end = share === 0 ? "low" : share === 1 ? "high" : null;
                if (range === "locked" && end) {
                  return (
                    <Limit
                      key={share}
                      label={end === "low" ? "Lowest value" : "Highest value"}
                      value={value}
                      unit={unit}
                      onChange={(next) => setView({ [end]: next })}
                    />
                  );
                }
                // Half way between two opposite ends is zero but for rounding.
                const shown = Math.abs(value) < 1e-9 * (high - low) ? 0 : value;
                return <span key={share}>{formatNumber(shown / factor, 3)}</span>;
              })}
            </div>
          </div>
          {clipped.map((one) => (
            <p key={one.end} className="muted legend-clipped" data-testid="legend-clipped">
              clipped at {100 * CLIP} %; {one.end} {formatQuantity(one.value, about.unit, 3)} at{" "}
              {place(one.at)}
            </p>
          ))}
          <Select
            bare
            label="Range of colors"
            value={range}
            options={RANGES}
            onChange={(mode) => lock(mode as RangeMode)}
          />
        </>
      )}
    </aside>
  );
}

/** A place on the body at rest, in millimeters. */
function place(at: readonly [number, number, number]): string {
  const values = at.map((value) => formatNumber(Number((value * 1e3).toFixed(1)), 4));
  return `(${values.join(", ")}) mm`;
}

function Limit(props: {
  label: string;
  value: number;
  unit: string;
  onChange(value: number): void;
}) {
  const [draft, setDraft] = useState<string | null>(null);
  const commit = () => {
    if (draft === null) return;
    const read = parseQuantity(draft.replaceAll("−", "-"), props.unit);
    if ("value" in read) props.onChange(read.value);
    setDraft(null);
  };
  return (
    <input
      className="input legend-limit"
      aria-label={props.label}
      value={draft ?? formatNumber(props.value / factorOf(props.unit), 4)}
      onChange={(event) => setDraft(event.target.value)}
      onBlur={commit}
      onKeyDown={(event) => event.key === "Enter" && commit()}
    />
  );
}
