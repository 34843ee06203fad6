import { formatQuantity } from "../../controls/units";
import { useShown, useView } from "../../store/view";
import { HOLD_COLORS } from "../marks/forces";

const HOLDS = [
  ["sticks", "sticks"],
  ["partly", "slips in part"],
  ["slips", "slips"],
] as const;

/** Legend of the arrows of contact forces: the length of a newton, and their colors. */
export function ForceLegend() {
  const scale = useShown((shown) => shown.forceScale);
  const on = useView((view) => view.forces);
  if (!on || scale === 0) return null;
  return (
    <div className="force-legend" data-testid="force-legend">
      <strong>Contact forces</strong>
      <span className="muted">{scaleText(scale)}</span>
      {HOLDS.map(([hold, text]) => (
        <span key={hold} className="force-key">
          <i style={{ background: HOLD_COLORS[hold] }} />
          {text}
        </span>
      ))}
    </div>
  );
}

/** The length of which force, m/N, in words: 10 mm of the model are so many newtons. */
export function scaleText(scale: number): string {
  return `10 mm = ${formatQuantity(Number((0.01 / scale).toPrecision(3)), "N", 3)}`;
}
