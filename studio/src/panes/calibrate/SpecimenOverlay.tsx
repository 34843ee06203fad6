// The specimen as the best candidate so far bends it, with the measured points in space.
import { type ReactNode, useMemo } from "react";
import { formatKind } from "../../controls/kinds";
import type { OverlayEvent } from "../../protocol";
import { useStudio } from "../../store/studio";
import { ColorBar } from "../../view/still/ColorBar";
import { StillView } from "../../view/still/StillView";
import { useStill } from "../../view/still/useStill";
import { marksOf } from "./marksOf";

const DISPLACEMENT = 0;

export function SpecimenOverlay(props: { overlay: OverlayEvent; bar: ReactNode }) {
  const { overlay, bar } = props;
  const state = useStill(overlay.job, overlay);
  const marks = useMemo(() => marksOf(overlay.experiments), [overlay]);
  const field = useStudio((all) => all.hello?.fields.find((one) => one.id === DISPLACEMENT));
  const frame = state.still?.frames.get(DISPLACEMENT);
  const errors = overlay.experiments.flatMap((one) => one.error);
  const mean = errors.reduce((sum, one) => sum + one, 0) / Math.max(1, errors.length);
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        {bar}
        <span className="muted" data-testid="overlay-errors">
          mean error {formatKind(mean, "length", 3)}, largest{" "}
          {formatKind(Math.max(0, ...errors), "length", 3)}
        </span>
        {field && frame && <ColorBar field={field} low={frame.min} high={frame.max} named />}
      </div>
      <div className="plot-rest" data-testid="overlay-space">
        <StillView
          label="The specimen and what was measured on it"
          field={DISPLACEMENT}
          marks={marks}
          cells={[{ key: overlay.job, state, caption: null, waiting: "Reading…" }]}
        />
      </div>
    </div>
  );
}
