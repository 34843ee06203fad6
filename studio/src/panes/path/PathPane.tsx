// Follow equilibria along a load, a tendon or a parameter, and see any number over it.
import { useMemo, useRef, useState } from "react";
import { Button, Empty, Select } from "../../controls/Choice";
import { formatKind, siUnit } from "../../controls/kinds";
import { NumberField } from "../../controls/NumberField";
import { Plot } from "../../controls/Plot";
import { factorOf, shownUnit, unitText } from "../../controls/units";
import type { PathColumn, PathEvent } from "../../protocol";
import { toast, useStudio } from "../../store/studio";
import { troubleOf } from "../design/trouble";
import { useFormOfDocument } from "../design/useForm";
import { JobCard } from "../jobs/JobCard";
import { PastNote, useIsPast } from "../jobs/PastNote";
import { useElsewhere, useJob } from "../study/current";
import { useStart } from "../study/useStart";
import { type Changeable, changeable, overText, stiffnessNote, unitOfValue } from "./lines";
import { type Measured, misfit, readMeasured, together } from "./measured";
import "../design/design.css";
import "./path.css";

const POINTS = 9;

export default function PathPane() {
  const document = useStudio((state) => state.document);
  const paths = useStudio((state) => state.paths);
  const form = useFormOfDocument();
  const job = useJob("run");
  const elsewhere = useElsewhere("run");
  const choices = useMemo(
    () => (form?.design ? changeable(form.design, document?.parameters ?? []) : []),
    [form, document],
  );
  if (!document || choices.length === 0) {
    return (
      <Empty title="Nothing to change along a path">
        <p>Give the design a load, a tendon or a parameter: it is then followed from here.</p>
      </Empty>
    );
  }
  const path = (job && paths[job.id]) ?? null;
  return (
    <div className="pane" data-testid="path-pane">
      <div className="section">
        <Setup
          key={document.id}
          choices={choices}
          note={(key) => (form?.design ? stiffnessNote(form.design, key) : null)}
          unfit={troubleOf(document)}
        />
      </div>
      {path ? (
        <>
          <PastNote job={path.job} ofState />
          <Curve key={document.id} path={path} />
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
      {job && job.state !== "done" && <JobCard job={job} />}
      {elsewhere.map((one) => one.id !== job?.id && <JobCard key={one.id} job={one} />)}
    </div>
  );
}

function Setup(props: {
  choices: readonly Changeable[];
  note: (key: string) => string | null;
  unfit: string | null;
}) {
  const { choices } = props;
  const [key, setKey] = useState("");
  const [range, setRange] = useState<readonly [number, number] | null>(null);
  const [count, setCount] = useState(POINTS);
  const { start, starting } = useStart("run");
  const what = choices.find((one) => one.key === key) ?? (choices[0] as Changeable);
  const [from, to] = range ?? [what.start, what.value];
  const follow = () => {
    const name = `${what.label} along a path`;
    start({ kind: "run", name, solver: {}, over: overText(what, from, to, count) });
  };
  const note = props.note(what.key);
  const trouble = props.unfit ?? (from === to ? "Give two different ends." : null);
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
      {note && (
        <p className="muted" data-testid="path-stiffness">
          {note}
        </p>
      )}
      {trouble && <p className="muted">{trouble}</p>}
      <Button
        kind="primary"
        testId="path-start"
        disabled={trouble !== null || starting}
        onClick={follow}
      >
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
  const picker = useRef<HTMLInputElement>(null);
  const [curves, setCurves] = useState<Readonly<Record<string, Measured>>>({});
  const key = `${path.over} ${column.name}`;
  const measured = curves[key];
  const open = async (file: File) => {
    const found = readMeasured(await file.text(), file.name, path.kind, column.kind);
    if ("problem" in found) {
      toast({ level: "error", what: `${file.name} is no measured curve`, hint: found.problem });
    } else setCurves({ ...curves, [key]: found });
  };
  const past = useIsPast({ job: path.job, ofState: true });
  const y = column.values.map((value) => value ?? Number.NaN);
  const data = measured ? together(path.values, y, measured) : [path.values, y];
  const computed = { label: column.name, color: "--series-1", points: true };
  const beside = { label: measured?.name ?? "", color: "--series-2", points: true, dashed: true };
  return (
    <div className={past ? "path-curve is-past" : "path-curve"} data-testid="path-curve">
      <div className="plot-bar">
        <Select
          bare
          label="Number along the path"
          value={column.name}
          options={path.columns.map((one) => ({ value: one.name, label: one.name }))}
          onChange={request}
        />
        <Button
          title="Lay a measured curve over it: two columns of a CSV file, named with their units"
          onClick={() => picker.current?.click()}
        >
          Measured…
        </Button>
        <input
          ref={picker}
          className="visually-hidden"
          type="file"
          tabIndex={-1}
          accept=".csv,.txt"
          aria-label="CSV file of a measured curve"
          data-testid="path-measured"
          onChange={(event) => {
            const file = event.target.files?.[0];
            event.target.value = "";
            if (file) void open(file);
          }}
        />
      </div>
      {measured && <Misfits measured={measured} path={path} column={column} />}
      <Plot
        key={`${column.name} ${measured?.name}`}
        label={`${column.name} over ${path.over}`}
        testId="plot-path"
        x={{ label: label(path.over, path.kind) }}
        y={{ label: label(column.name, column.kind) }}
        series={measured ? [computed, beside] : [computed]}
        data={data.map((values, i) => scaled(values, i === 0 ? path.kind : column.kind))}
      />
    </div>
  );
}

function Misfits(props: { measured: Measured; path: PathEvent; column: PathColumn }) {
  const { measured, path, column } = props;
  const found = misfit(measured, path.values, column.values);
  return (
    <p className="muted path-misfit" data-testid="path-misfit">
      {found
        ? `Off by ${formatKind(found.rms, column.kind, 3)} (root mean square of ${found.count} points), ` +
          `${formatKind(found.largest, column.kind, 3)} at most`
        : "No point of it lies where the path is, or the path turns back."}
      {measured.assumed && ". It names no units: those of the axes were taken."}
    </p>
  );
}

/** A number that the design asks for comes first; without it, the displacement that changes most. */
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
