import { useMemo, useState } from "react";
import { Select } from "../../controls/Choice";
import { type ChartPoint, PointChart } from "./chart/PointChart";
import { coloring } from "./colors";
import { type CurrentStudy, useStudy } from "./current";
import { NoStudy } from "./NoStudy";
import { choose, hover, useSelection } from "./selection";
import { TrialTip } from "./TrialTip";
import { bestSoFar, isDone, rangeOf, valueOn, within } from "./trials";
import "./study.css";

/** Each design in the order in which it was tried, and the best so far. */
export default function HistoryPane() {
  const current = useStudy();
  if (!current || current.study.trials.length === 0) {
    return <NoStudy what="Each design that a study tries is drawn here, with the best so far." />;
  }
  return <History current={current} />;
}

function History(props: { current: CurrentStudy }) {
  const { id, study, axes } = props.current;
  const { hovered, pinned, opened, brushes } = useSelection();
  const [requested, setRequested] = useState(0);
  const objective = Math.min(requested, Math.max(0, study.objectives.length - 1));
  const axis = axes.find(
    (one) => one.role === "objective" && one.name === study.objectives[objective],
  );
  const line = useMemo(() => bestSoFar(study, objective), [study, objective]);
  const range = useMemo(
    () => rangeOf(axis ? study.trials.filter(isDone).map((trial) => valueOn(trial, axis)) : []),
    [study, axis],
  );
  const points = useMemo((): ChartPoint[] => {
    const { color } = coloring(study, axes);
    return study.trials.map((trial) => {
      const done = isDone(trial) && axis;
      return {
        id: trial.index,
        x: trial.index,
        // Trials without a result stand at the bottom, so that they are seen.
        y: done ? valueOn(trial, axis) : range[0],
        color: color(trial),
        faded: !within(trial, axes, brushes),
        hollow: !done || !trial.feasible,
      };
    });
  }, [study, axes, axis, brushes, range]);
  if (!axis) return null;
  const trialOf = new Map(study.trials.map((trial) => [trial.index, trial]));
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        {study.objectives.length > 1 && (
          <Select
            bare
            label="Objective of the history"
            value={String(objective)}
            options={study.objectives.map((name, i) => ({ value: String(i), label: name }))}
            onChange={(value) => setRequested(Number(value))}
          />
        )}
        <span className="plot-key-static">
          <i className="key-line" /> best so far
        </span>
        <span className="plot-key-static">
          <i className="key-hollow" /> failed
        </span>
        <span className="plot-key-static">
          <i className="key-hollow is-broken" /> not allowed
        </span>
      </div>
      <PointChart
        label={`History of ${axis.name} over the designs tried`}
        testId="history-chart"
        x={{ label: "design", kind: "number", range: rangeOf(points.map((p) => p.x)), whole: true }}
        y={{ label: axis.name, kind: axis.kind, range }}
        points={points}
        lines={[{ color: "--accent", points: line, steps: true }]}
        hovered={hovered}
        opened={opened}
        pinned={pinned}
        onHover={hover}
        onChoose={(trial, mark) => choose(id, trial, mark)}
        tip={(index) => {
          const trial = trialOf.get(index);
          return trial && <TrialTip trial={trial} axes={axes} />;
        }}
      />
    </div>
  );
}
