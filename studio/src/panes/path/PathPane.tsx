// Follow equilibria along a load, a tendon or a parameter, and see any number over it.
import { useMemo, useState } from "react";
import { Button, Empty, Select } from "../../controls/Choice";
import { siUnit } from "../../controls/kinds";
import { NumberField } from "../../controls/NumberField";
import { Plot } from "../../controls/Plot";
import { factorOf, shownUnit, unitText } from "../../controls/units";
import type { PathColumn, PathEvent } from "../../protocol";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { useFormOfDocument } from "../design/useForm";
import { JobCard } from "../jobs/JobCard";
import { useJob } from "../study/current";
import { useNewJob } from "../study/StudyPane";
import { type Changeable, changeable, overText, unitOfValue } from "./lines";
import "../design/design.css";
import "./path.css";

const POINTS = 9;

export default function PathPane() {
  const document = useStudio((state) => state.document);
  const paths = useStudio((state) => state.paths);
  const form = useFormOfDocument();
  const job = useJob("run");
  const choices = useMemo(
    () => (form?.design ? changeable(form.design, document?.parameters ?? []) : []),
    [form, document],
  );
  if (choices.length === 0) {
    return (
      <Empty title="Nothing to change along a path">
        <p>Give the design a load, a tendon or a parameter: it is then followed from here.</p>
      </Empty>
    );
  }
  const path = (job ? paths[job.id] : Object.values(paths).at(-1)) ?? null;
  return (
    <div className="pane" data-testid="path-pane">
      <div className="section">
        <Setup choices={choices} valid={document?.valid ?? false} />
      </div>
      {path ? (
        <>
          <Curve path={path} />
          {path.message && (
            <p className={`path-end ${path.status === "ok" ? "muted" : "bad"}`} role="status">
              <span data-testid="path-end">{path.message}</span>
            </p>
          )}
        </>
      ) : (
        <Empty title="No path yet">
          <p>Each point of the curve is an equilibrium; the last one is kept as a run.</p>
        </Empty>
      )}
      {job && job.state !== "done" && <JobCard job={job} unit={path ? "equilibria" : "percent"} />}
    </div>
  );
}

function Setup(props: { choices: readonly Changeable[]; valid: boolean }) {
  const { choices } = props;
  const [key, setKey] = useState("");
  const [range, setRange] = useState<readonly [number, number] | null>(null);
  const [count, setCount] = useState(POINTS);
  const expect = useNewJob("run");
  const what = choices.find((one) => one.key === key) ?? (choices[0] as Changeable);
  const [from, to] = range ?? [what.start, what.value];
  const start = () => {
    expect();
    const name = `${what.label} along a path`;
    send({
      t: "job_start",
      spec: { kind: "run", name, solver: {}, over: overText(what, from, to, count) },
    });
  };
  const trouble = !props.valid
    ? "Fix the errors of the design first."
    : from === to
      ? "Give two different ends."
      : null;
  return (
    <>
      <Select
        label="Change"
        value={what.key}
        options={choices.map((one) => ({ value: one.key, label: one.label }))}
        onChange={(chosen) => {
          setKey(chosen);
          setRange(null);
        }}
      />
      <NumberField
        label="From"
        value={from}
        unit={unitOfValue(what)}
        onChange={(value) => setRange([value, to])}
      />
      <NumberField
        label="To"
        value={to}
        unit={unitOfValue(what)}
        onChange={(value) => setRange([from, value])}
      />
      <NumberField
        label="Equilibria"
        value={count}
        min={2}
        max={1000}
        step={1}
        onChange={(value) => setCount(Math.round(value))}
      />
      {trouble && <p className="muted">{trouble}</p>}
      <Button kind="primary" testId="path-start" disabled={trouble !== null} onClick={start}>
        Follow
      </Button>
    </>
  );
}

function Curve(props: { path: PathEvent }) {
  const { path } = props;
  const [requested, request] = useState("");
  const column =
    path.columns.find((one) => one.name === requested) ?? (mostTelling(path) as PathColumn);
  const shown = (kind: string) => shownUnit(siUnit(kind));
  const label = (name: string, kind: string) => {
    const unit = shown(kind);
    return unit === "1" ? name : `${name} [${unitText(unit)}]`;
  };
  const scaled = (values: readonly (number | null)[], kind: string) =>
    values.map((value) => (value ?? Number.NaN) / factorOf(shown(kind)));
  return (
    <div className="path-curve">
      <div className="plot-bar">
        <Select
          bare
          label="Number along the path"
          value={column.name}
          options={path.columns.map((one) => ({ value: one.name, label: one.name }))}
          onChange={request}
        />
      </div>
      <Plot
        key={column.name}
        label={`${column.name} over ${path.over}`}
        testId="plot-path"
        x={{ label: label(path.over, path.kind) }}
        y={{ label: label(column.name, column.kind) }}
        series={[{ label: column.name, color: "--series-1", points: true }]}
        data={[scaled(path.values, path.kind), scaled(column.values, column.kind)]}
      />
    </div>
  );
}

/** What is asked of the design comes first; without it, the displacement that changes most. */
function mostTelling(path: PathEvent): PathColumn | undefined {
  const first = path.columns[0];
  const moved = path.columns.filter((one) => /\.[xyz]$/.test(one.name));
  const size = (column: PathColumn) =>
    Math.max(...column.values.map((value) => Math.abs(value ?? 0)));
  const standard = first && ["cavity_volume", "elastic_energy"].includes(first.name);
  return standard && moved.length > 0
    ? moved.reduce((best, one) => (size(one) > size(best) ? one : best))
    : first;
}
