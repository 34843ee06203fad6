// Follow equilibria along a load, a tendon or a parameter, and see any number over it.
import { useMemo, useRef, useState } from "react";
import { Button, Empty, Select } from "../../controls/Choice";
import { formatKind, siUnit } from "../../controls/kinds";
import { NumberField } from "../../controls/NumberField";
import { Plot } from "../../controls/Plot";
import { factorOf, shownUnit, unitText } from "../../controls/units";
import type { PathColumn, PathEvent } from "../../protocol";
import { TABLES, takeTable } from "../../shell/dropTable";
import { useStudio } from "../../store/studio";
import { Glyph } from "../design/fields/Glyph";
import { troubleOf } from "../design/trouble";
import { useFormOfDocument } from "../design/useForm";
import { JobCard } from "../jobs/JobCard";
import { PastNote, useIsPast } from "../jobs/PastNote";
import { useElsewhere, useJob } from "../study/current";
import { useStart } from "../study/useStart";
import { type Changeable, changeable, overText, stiffnessNote, unitOfValue } from "./lines";
import { type Measured, misfit, together } from "./measured";
import { overlaid, suggested } from "./overlay";
import { markOf, type PathTable, removeCurve, showColumn, usePathTables } from "./tables";
import { capital, columnWords, overWords } from "./words";
import "../design/design.css";
import "./path.css";

const POINTS = 9;

export default function PathPane() {
  const document = useStudio((state) => state.document);
  const paths = useStudio((state) => state.paths);
  const form = useFormOfDocument();
  const job = useJob("run");
  const elsewhere = useElsewhere("run");
  const tables = useTables();
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
  const said = (message: string) =>
    path ? message.replace(path.over, overWords(path.over, choices)) : message;
  return (
    <div className="pane" data-testid="path-pane">
      <div className="section">
        <Setup
          key={document.id}
          choices={choices}
          table={tables[0]}
          note={(key) => (form?.design ? stiffnessNote(form.design, key) : null)}
          unfit={troubleOf(document)}
        />
      </div>
      <Curves waiting={path === null} />
      {path ? (
        <>
          <PastNote job={path.job} ofState />
          <Curve key={document.id} path={path} choices={choices} />
          {path.message && (
            <p className={`path-end ${path.status === "ok" ? "muted" : "bad"}`} role="status">
              <span data-testid="path-end">{said(path.message)}</span>
            </p>
          )}
        </>
      ) : (
        <Empty title="No path yet">
          <p>Each point of the curve is an equilibrium; the last one is kept as a run.</p>
        </Empty>
      )}
      {job && job.state !== "done" && <JobCard job={{ ...job, message: said(job.message) }} />}
      {elsewhere.map((one) => one.id !== job?.id && <JobCard key={one.id} job={one} />)}
    </div>
  );
}

function Setup(props: {
  choices: readonly Changeable[];
  /** The newest measured curve, which the path is to be compared with. */
  table: PathTable | undefined;
  note: (key: string) => string | null;
  unfit: string | null;
}) {
  const { choices } = props;
  const [key, setKey] = useState("");
  const [range, setRange] = useState<readonly [number, number] | null>(null);
  const [count, setCount] = useState(POINTS);
  const { start, starting } = useStart("run");
  const { table } = props;
  const asTable = useMemo(() => suggested(choices, table), [choices, table]);
  const what =
    choices.find((one) => one.key === key) ?? asTable?.what ?? (choices[0] as Changeable);
  const end = asTable?.what.key === what.key ? asTable.end : what.value;
  const [from, to] = range ?? [what.start, end];
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

function Curve(props: { path: PathEvent; choices: readonly Changeable[] }) {
  const { path, choices } = props;
  const tables = useTables();
  const requested = usePathTables((state) => state.column);
  const shown = (kind: string) => shownUnit(siUnit(kind));
  const label = (words: string, kind: string) => {
    const unit = shown(kind);
    return unit === "1" ? capital(words) : `${capital(words)} [${unitText(unit)}]`;
  };
  const scaled = (values: readonly (number | null)[], kind: string) =>
    values.map((value) => (value ?? Number.NaN) / factorOf(shown(kind)));
  const past = useIsPast({ job: path.job, ofState: true });
  const found = useMemo(() => overlaid(path, tables, requested), [path, tables, requested]);
  if (!found) return null;
  const { column, measured, problem } = found;
  const over = overWords(path.over, choices);
  const words = columnWords(column.name);
  const y = column.values.map((value) => value ?? Number.NaN);
  const data = measured ? together(path.values, y, measured) : [path.values, y];
  const computed = { label: words, color: "--series-1", points: true };
  const beside = { label: measured?.name ?? "", color: "--series-2", points: true, dashed: true };
  return (
    <div className={past ? "path-curve is-past" : "path-curve"} data-testid="path-curve">
      <div className="plot-bar">
        <Select
          bare
          label="Number along the path"
          value={column.name}
          options={path.columns.map(({ name }) => ({ value: name, label: columnWords(name) }))}
          onChange={(name) => showColumn(name, column.name)}
        />
      </div>
      {measured && <Misfits measured={measured} path={path} column={column} />}
      {problem && (
        <p className="path-misfit bad" role="status" data-testid="path-problem">
          {tables[0]?.name}: {problem}.
        </p>
      )}
      <Plot
        key={`${column.name} ${measured?.name}`}
        label={`${capital(words)} over ${over}`}
        testId="plot-path"
        x={{ label: label(over, path.kind) }}
        y={{ label: label(words, column.kind) }}
        series={measured ? [computed, beside] : [computed]}
        data={data.map((values, i) => scaled(values, i === 0 ? path.kind : column.kind))}
      />
    </div>
  );
}

/** Tables of the open document. */
function useTables(): readonly PathTable[] {
  const tables = usePathTables((state) => state.tables);
  const mark = useStudio((state) => markOf(state.document));
  return useMemo(() => tables.filter(({ of }) => of === mark), [tables, mark]);
}

/** The measured curves that were dropped, and the way to choose one. */
function Curves(props: { waiting: boolean }) {
  const tables = useTables();
  const picker = useRef<HTMLInputElement>(null);
  return (
    <div className="path-tables">
      {tables.map(({ name }) => (
        <span key={name} className="path-table" data-testid="path-table">
          {name}
          <Button icon kind="quiet" label={`Remove ${name}`} onClick={() => removeCurve(name)}>
            <Glyph name="trash" />
          </Button>
        </span>
      ))}
      {props.waiting && tables.length > 0 && (
        <span className="muted">lies over the path once it is followed.</span>
      )}
      <Button
        title="Lay a measured curve over it: columns of a CSV file, named with their units"
        onClick={() => picker.current?.click()}
      >
        Measured…
      </Button>
      <input
        ref={picker}
        className="visually-hidden"
        type="file"
        tabIndex={-1}
        accept={TABLES.join(",")}
        aria-label="CSV file of a measured curve"
        data-testid="path-measured"
        onChange={(event) => {
          const file = event.target.files?.[0];
          event.target.value = "";
          if (file) void takeTable(file, "curve");
        }}
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
