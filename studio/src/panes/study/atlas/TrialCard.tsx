import { Button } from "../../../controls/Choice";
import { Icon } from "../../../shell/icons";
import { useStudio } from "../../../store/studio";
import type { CurrentStudy } from "../current";
import { choose, pin, select, take, useSelection } from "../selection";
import { isDone, reasonOf, textOn, valueOn } from "../trials";

/** The chosen trial in a line, and actions with it. */
export function TrialCard(props: { current: CurrentStudy }) {
  const { id, study, axes } = props.current;
  const selected = useSelection((selection) => selection.selected);
  const pinned = useSelection((selection) => selection.pinned);
  const name = useStudio((state) => state.document?.name ?? "the open design");
  const trial = study.trials.find((one) => one.index === selected);
  if (!trial) return null;
  const shown = axes.filter(
    (axis) => axis.role !== "metric" && (axis.role === "parameter" || isDone(trial)),
  );
  return (
    <section className="trial-card" aria-label={`Design ${trial.index}`} data-testid="trial-card">
      <div className="trial-facts">
        <strong>Design {trial.index}</strong>
        {!isDone(trial) && <span className="badge bad">{trial.status}</span>}
        {isDone(trial) && !trial.feasible && (
          <>
            <span className="badge warn">not allowed</span> {reasonOf(trial, axes)}
          </>
        )}
        {shown.map((axis) => (
          <span key={axis.key}>
            <span className="muted">{axis.name}</span> {textOn(valueOn(trial, axis), axis)}
          </span>
        ))}
        {trial.message && (
          <span className="muted trial-note" title={trial.message}>
            {trial.message}
          </span>
        )}
      </div>
      <div className="trial-verbs">
        <Button
          kind="primary"
          testId="take"
          title={`Write its parameters into ${name}, as one step that undo takes back`}
          onClick={() => take(id, trial.index)}
        >
          Take this design
        </Button>
        <Button testId="open-trial" onClick={() => choose(id, trial.index, false)}>
          Open as its own document
        </Button>
        <Button pressed={pinned.includes(trial.index)} onClick={() => pin(trial.index)}>
          Mark to compare
        </Button>
        <Button icon kind="quiet" label="Close" onClick={() => select(null)}>
          <Icon name="close" />
        </Button>
      </div>
    </section>
  );
}
