import { useMemo, useState } from "react";
import { Select } from "../../controls/Choice";
import { type ChartPoint, PointChart } from "./chart/PointChart";
import { coloring } from "./colors";
import { type CurrentStudy, useStudy } from "./current";
import { NoStudy } from "./NoStudy";
import { choose, hover, useSelection } from "./selection";
import { TrialTip } from "./TrialTip";
import { type Axis, isDone, rangeOf, valueOn, within } from "./trials";
import "./study.css";

/** Any quantity over any other; for two objectives the front of the best trade-offs. */
export default function ParetoPane() {
  const current = useStudy();
  if (!current || current.study.trials.length === 0) {
    return (
      <NoStudy what="Two objectives over each other, with the front of the best trade-offs." />
    );
  }
  return <Pareto current={current} />;
}

function Pareto(props: { current: CurrentStudy }) {
  const { id, study, axes, front } = props.current;
  const { hovered, pinned, opened, brushes } = useSelection();
  const [xKey, setX] = useState<string | null>(null);
  const [yKey, setY] = useState<string | null>(null);
  const objectives = axes.filter((one) => one.role === "objective");
  const x =
    axes.find((one) => one.key === xKey) ?? (objectives.length > 1 ? objectives[0] : axes[0]);
  const y =
    axes.find((one) => one.key === yKey) ?? (objectives.length > 1 ? objectives[1] : objectives[0]);
  const done = useMemo(() => study.trials.filter(isDone), [study]);
  const points = useMemo((): ChartPoint[] => {
    if (!x || !y) return [];
    const { color } = coloring(study, axes);
    return done.map((trial) => ({
      id: trial.index,
      x: valueOn(trial, x),
      y: valueOn(trial, y),
      color: color(trial),
      faded: !within(trial, axes, brushes),
      hollow: !trial.feasible,
    }));
  }, [study, done, axes, x, y, brushes]);
  const line = useMemo(() => {
    if (x?.role !== "objective" || y?.role !== "objective" || x === y) return [];
    return points
      .filter((point) => front.has(point.id))
      .map(({ x: px, y: py }) => ({ x: px, y: py }))
      .sort((a, b) => a.x - b.x);
  }, [points, front, x, y]);
  if (!x || !y) return null;
  const trialOf = new Map(study.trials.map((trial) => [trial.index, trial]));
  const options = axes.map((axis) => ({ value: axis.key, label: axis.name }));
  const range = (axis: Axis) => rangeOf(done.map((trial) => valueOn(trial, axis)));
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        <Select bare label="Vertical axis" value={y.key} options={options} onChange={setY} />
        <span className="muted">over</span>
        <Select bare label="Horizontal axis" value={x.key} options={options} onChange={setX} />
        {line.length > 1 && (
          <span className="plot-key-static">
            <i className="key-line" /> Pareto front
          </span>
        )}
      </div>
      <PointChart
        label={`${y.name} over ${x.name}`}
        testId="pareto-chart"
        x={{ label: x.name, kind: x.kind, range: range(x) }}
        y={{ label: y.name, kind: y.kind, range: range(y) }}
        points={points}
        lines={[{ color: "--accent", points: line }]}
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
