import { useMemo } from "react";
import { Button } from "../../../controls/Choice";
import { RangeSlider } from "../../../controls/RangeSlider";
import type { TrialEvent } from "../../../protocol";
import { Icon } from "../../../shell/icons";
import { brush, useSelection } from "../selection";
import { type Axis, isDone, rangeText, textOn, valueOn } from "../trials";

const OPEN: readonly [number, number] = [-Infinity, Infinity];

/** A slider for each quantity in which trials differ: requirements for a design. */
export function Requirements(props: {
  trials: readonly TrialEvent[];
  axes: readonly Axis[];
  onClose(): void;
}) {
  const { trials, axes } = props;
  const brushes = useSelection((selection) => selection.brushes);
  const rows = useMemo(() => {
    const done = trials.filter(isDone);
    return axes
      .filter((axis) => axis.role !== "parameter" && !axis.name.startsWith("d "))
      .map((axis) => ({ axis, values: done.map((trial) => valueOn(trial, axis)) }))
      .filter(({ values }) => new Set(values.filter(Number.isFinite)).size > 1);
  }, [trials, axes]);
  return (
    <aside className="atlas-requirements" aria-label="Requirements" data-testid="requirements">
      <h3>
        Requirements
        <Button icon kind="quiet" label="Hide the requirements" onClick={props.onClose}>
          <Icon name="close" />
        </Button>
      </h3>
      {rows.length === 0 && <p className="muted">All designs have the same numbers so far.</p>}
      {rows.map(({ axis, values }) => {
        const range = brushes[axis.key] ?? OPEN;
        return (
          <div key={axis.key} className="requirement" data-testid={`requirement-${axis.name}`}>
            <span className="requirement-name">{axis.name.replaceAll("_", " ")}</span>
            <span className="muted">{rangeText(axis, range)}</span>
            {axis.allowed && (
              <span className="requirement-allowed">allowed: {rangeText(axis, axis.allowed)}</span>
            )}
            <RangeSlider
              label={axis.name}
              values={values}
              range={range}
              {...(axis.allowed ? { allowed: axis.allowed } : {})}
              text={(value) => textOn(value, axis, 3)}
              onChange={(next) => brush(axis.key, next)}
            />
          </div>
        );
      })}
    </aside>
  );
}
