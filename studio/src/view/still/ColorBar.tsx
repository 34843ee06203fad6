import { factorOf, formatNumber, shownUnit, unitText } from "../../controls/units";
import type { Field } from "../../protocol";
import { useView } from "../../store/view";
import { gradient } from "../body/colormaps";
import { CLIP } from "../body/colorRange";

/** The colors that several bodies share, with the values at both ends. */
export function ColorBar(props: {
  field: Field;
  low: number;
  high: number;
  clipped?: boolean;
  named?: boolean;
}) {
  const { field, low, high } = props;
  const { colormap, bands } = useView();
  const unit = shownUnit(field.unit);
  const factor = factorOf(unit);
  return (
    <span className="color-bar" data-testid="color-bar" title={field.title}>
      {props.named && <span>{field.title}</span>}
      {formatNumber(low / factor, 3)}
      <i style={{ background: gradient(colormap, bands).replace("to top", "to right") }} />
      {formatNumber(high / factor, 3)} {unitText(unit)}
      {props.clipped && <span className="muted"> clipped at {100 * CLIP} %</span>}
    </span>
  );
}
