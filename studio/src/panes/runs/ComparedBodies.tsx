import { useCallback, useState } from "react";
import { Button, Select } from "../../controls/Choice";
import { formatNumber, formatQuantity } from "../../controls/units";
import type { ComparedEvent, Field, Side } from "../../protocol";
import { useStudio } from "../../store/studio";
import { ColorBar } from "../../view/still/ColorBar";
import { commonRange } from "../../view/still/fetchStill";
import { StillView } from "../../view/still/StillView";
import { type StillState, useStill } from "../../view/still/useStill";
import { percentChange, sideTitle } from "./compared";

const NOTHING: readonly Field[] = [];

/** The two bodies at rest, seen by one camera and colored by one field over one range. */
export function ComparedBodies(props: { compared: ComparedEvent }) {
  const { compared } = props;
  const { a, b } = compared;
  const [field, choose] = useState(0);
  const [over, setOver] = useState(false);
  const [fit, setFit] = useState<() => void>(() => () => {});
  const ready = useCallback((next: () => void) => setFit(() => next), []);
  const known = useStudio((state) => state.hello?.fields) ?? NOTHING;
  const rows = useStudio((state) => state.runs?.rows);
  const [first, second] = [useStill(a.id, compared), useStill(b.id, compared)];
  const told = (id: number) =>
    [first, second].some((one) => one.still === null || one.still.frames.has(id));
  // A body at rest has no speed; other fields need a problem that can be set up.
  const fields = known.filter((one) => one.name !== "speed" && told(one.id));
  const about = fields.find((one) => one.id === field) ?? fields[0];
  const stills = [first, second].flatMap((one) => one.still ?? []);
  const range = commonRange(stills, about?.id ?? 0);
  const largest = (state: StillState) => state.still?.frames.get(about?.id ?? 0)?.max ?? null;
  const waiting = (side: Side) =>
    rows?.find((row) => row.id === side.id)?.kind === "run" ? "Reading…" : "Solving…";
  const caption = (side: Side, state: StillState, beside: number | null) => {
    const value = largest(state);
    return (
      <>
        <span>
          <strong title={side.id}>{sideTitle(side)}</strong>
          {over && side === b && <span className="muted"> as wires</span>}
        </span>
        {about && value !== null && (
          <span data-testid={`largest-${side.id}`}>
            largest {formatQuantity(value, about.unit)}
            {beside !== null && beside !== 0 && (
              <span className="muted"> ({formatChange(beside, value)})</span>
            )}
          </span>
        )}
      </>
    );
  };
  return (
    <div className="compare-bodies" data-testid="compared-bodies">
      <div className="plot-bar">
        {about && (
          <Select
            bare
            label="Color both by"
            value={String(about.id)}
            options={fields.map((one) => ({ value: String(one.id), label: one.title }))}
            onChange={(value) => choose(Number(value))}
          />
        )}
        <Button pressed={over} testId="compare-over" onClick={() => setOver(!over)}>
          On top of each other
        </Button>
        <Button kind="quiet" onClick={fit}>
          Fit
        </Button>
        {about && range && <ColorBar field={about} {...range} />}
      </div>
      <div className="compare-stage">
        <StillView
          label={`${sideTitle(a)} and ${sideTitle(b)} at rest`}
          field={about?.id ?? 0}
          over={over}
          onReady={ready}
          cells={[
            { key: a.id, state: first, caption: caption(a, first, null), waiting: waiting(a) },
            {
              key: b.id,
              state: second,
              caption: caption(b, second, largest(first)),
              waiting: waiting(b),
            },
          ]}
        />
      </div>
    </div>
  );
}

function formatChange(from: number, to: number): string {
  const percent = percentChange(from, to);
  return `${percent > 0 ? "+" : ""}${formatNumber(percent, 3)} %`;
}
