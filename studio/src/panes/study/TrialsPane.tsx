// All designs of a study as a table, the best first: sort by a click, filter by words and comparisons.
import { useDeferredValue, useMemo, useState } from "react";
import { Button, Toggle } from "../../controls/Choice";
import { copy } from "../../controls/clipboard";
import { writtenUnit } from "../../controls/kinds";
import { type Column, Table } from "../../controls/Table";
import { formatSpan, parseQuantity } from "../../controls/units";
import type { TrialEvent } from "../../protocol";
import { type CurrentStudy, useStudy } from "./current";
import { NoStudy } from "./NoStudy";
import { choose, comparePinned, hover, pin, useSelection } from "./selection";
import {
  type Axis,
  bestFirst,
  brokenBy,
  matchesFilter,
  rangeText,
  reasonOf,
  textOn,
  trialsText,
  valueOn,
  within,
} from "./trials";
import "./study.css";

export default function TrialsPane() {
  const current = useStudy();
  if (!current || current.study.trials.length === 0) {
    return (
      <NoStudy what="Each design that a study tried, with its parameters and what it came to." />
    );
  }
  return <Trials current={current} />;
}

/** Rows that are drawn; each costs the page time whenever a trial arrives. */
const MOST = 300;

function read(text: string, kind: string): number {
  const parsed = parseQuantity(text, writtenUnit(kind) || "1");
  return "value" in parsed ? parsed.value : Number.NaN;
}

function Trials(props: { current: CurrentStudy }) {
  const { id, study, axes, front } = props.current;
  const { pinned, opened, brushes } = useSelection();
  const [filter, setFilter] = useState("");
  const [metrics, showMetrics] = useState(false);
  const words = useDeferredValue(filter);
  const rows = useMemo(
    () =>
      bestFirst(study, front).filter(
        (trial) => within(trial, axes, brushes) && matchesFilter(trial, axes, words, read),
      ),
    [study, axes, front, brushes, words],
  );
  const columns = useMemo((): Column<TrialEvent>[] => {
    const shown = axes.filter((axis) => metrics || axis.role !== "metric");
    return [
      {
        key: "compare",
        title: <span className="visually-hidden">Compare</span>,
        cell: (trial) => (
          <input
            type="checkbox"
            aria-label={`Compare design ${trial.index}`}
            checked={pinned.includes(trial.index)}
            onClick={(event) => event.stopPropagation()}
            onChange={() => pin(trial.index)}
          />
        ),
      },
      { key: "#", title: "#", right: true, cell: (t) => t.index, sort: (t) => t.index },
      {
        key: "status",
        title: "Status",
        cell: (trial) => <Status trial={trial} axes={axes} best={front.has(trial.index)} />,
        sort: (trial) => trial.status,
      },
      ...shown.map(
        (axis): Column<TrialEvent> => ({
          key: axis.key,
          title: <Title axis={axis} />,
          right: axis.choices === null,
          cell: (trial) => {
            const text = textOn(valueOn(trial, axis), axis, 4);
            return brokenBy(trial, [axis]).length > 0 ? <span className="bad">{text}</span> : text;
          },
          sort: (trial) => {
            const value = valueOn(trial, axis);
            return Number.isFinite(value) ? value : null;
          },
        }),
      ),
      {
        key: "seconds",
        title: "Took",
        right: true,
        cell: (trial) => formatSpan(trial.seconds),
        sort: (trial) => trial.seconds,
      },
      {
        key: "message",
        title: "Note",
        cell: (trial) => (
          <span className="reason muted" title={trial.message}>
            {reasonOf(trial, axes) || trial.message}
          </span>
        ),
      },
    ];
  }, [axes, metrics, pinned, front]);
  const failed = study.trials.filter((trial) => trial.objectives === null).length;
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        <input
          className="input filter"
          type="search"
          aria-label="Filter the designs"
          placeholder="Filter: ok, diverged, wall > 8 mm, #12"
          value={filter}
          onChange={(event) => setFilter(event.target.value)}
        />
        <span className="muted" data-testid="trial-count">
          {rows.length === study.trials.length
            ? `${rows.length} designs`
            : `${rows.length} of ${study.trials.length} designs`}
          {failed > 0 && `, ${failed} failed`}
        </span>
        <Toggle label="all metrics" checked={metrics} onChange={showMetrics} />
        <Button
          kind="quiet"
          testId="copy-trials"
          title="Copy these designs as a table, in SI units"
          onClick={() => void copy(trialsText(rows, axes), `${rows.length} designs`)}
        >
          Copy data
        </Button>
        <Button
          disabled={pinned.length < 2}
          testId="compare-pinned"
          onClick={() => comparePinned(id)}
        >
          {pinned.length === 2 ? `Compare ${pinned[0]} and ${pinned[1]}` : "Compare two"}
        </Button>
      </div>
      <div className="plot-rest">
        <Table
          label="Designs of the study"
          testId="trials-table"
          most={MOST}
          columns={columns}
          rows={rows}
          rowKey={(trial) => String(trial.index)}
          selected={new Set(opened === null ? [] : [String(opened)])}
          onChoose={(trial, extend) => choose(id, trial.index, extend)}
          onHover={(trial) => hover(trial?.index ?? null)}
          empty={<p className="section muted">No design is meant by this filter.</p>}
        />
      </div>
    </div>
  );
}

function Title({ axis }: { axis: Axis }) {
  if (axis.role === "parameter") return axis.name;
  if (!axis.allowed) return <b>{axis.name}</b>;
  return (
    <>
      <b>{axis.name}</b> <span className="muted">{rangeText(axis, axis.allowed)}</span>
    </>
  );
}

function Status(props: { trial: TrialEvent; axes: readonly Axis[]; best: boolean }) {
  const { trial, axes } = props;
  if (trial.status !== "ok") {
    return (
      <span className="badge bad" title={trial.message}>
        {trial.status}
      </span>
    );
  }
  if (!trial.feasible) {
    return (
      <span className="badge warn" title={reasonOf(trial, axes)}>
        not allowed
      </span>
    );
  }
  return props.best ? <span className="badge good">best</span> : <span className="muted">ok</span>;
}
