import type { TrialEvent } from "../../protocol";
import { type Axis, reasonOf, textOn, valueOn } from "./trials";

const MOST = 8;

/** A trial in a few lines, beside the pointer. */
export function TrialTip(props: { trial: TrialEvent; axes: readonly Axis[] }) {
  const { trial } = props;
  const shown = props.axes.filter((axis) => axis.role !== "metric").slice(0, MOST);
  return (
    <>
      <strong>Design {trial.index}</strong>
      {trial.status !== "ok" && <span className="bad"> {trial.status}</span>}
      {trial.status === "ok" && !trial.feasible && (
        <span className="bad"> not allowed: {reasonOf(trial, props.axes)}</span>
      )}
      <dl>
        {shown.map((axis) => (
          <div key={axis.key} style={{ display: "contents" }}>
            <dt>{axis.name}</dt>
            <dd>{textOn(valueOn(trial, axis), axis, 4)}</dd>
          </div>
        ))}
      </dl>
      {trial.message && <p className="muted">{trial.message}</p>}
    </>
  );
}
