// Set a study up, start it, and see how far it is.
import { Button, Empty, Section, Select } from "../../controls/Choice";
import { formatKind } from "../../controls/kinds";
import { NumberField } from "../../controls/NumberField";
import { RangeRow } from "../../controls/RangeRow";
import { TextField } from "../../controls/TextField";
import type { JobEvent } from "../../protocol";
import { setJob } from "../../store/page";
import { useStudio } from "../../store/studio";
import { FormContext } from "../design/form";
import { Goals } from "../design/Goals";
import { troubleOf } from "../design/trouble";
import { useFormOfDocument } from "../design/useForm";
import { JobCard } from "../jobs/JobCard";
import { PastNote } from "../jobs/PastNote";
import { jobsOf, useJob, useStudy } from "./current";
import { changeDraft, changeRange, toggleSweep, useStudyDraft } from "./draft";
import { type Choice, choices, countOf, gridSize, obstacle, samplerOf, studySpec } from "./setup";
import { useStart } from "./useStart";
import "../design/design.css";
import "./study.css";

export function JobChooser(props: { kind: JobEvent["kind"]; label: string }) {
  const jobs = useStudio((state) => state.jobs);
  const current = useJob(props.kind);
  const all = jobsOf(jobs, props.kind);
  if (all.length === 0 || (all.length === 1 && current)) return null;
  const none = { value: "", label: "of other designs…", disabled: true };
  return (
    <div className="section">
      <Select
        label={props.label}
        value={current?.id ?? ""}
        options={[
          ...(current ? [] : [none]),
          ...all.map((job) => ({ value: job.id, label: `${job.name || job.id} (${job.state})` })),
        ]}
        onChange={setJob}
      />
    </div>
  );
}

export default function StudyPane() {
  const document = useStudio((state) => state.document);
  const samplers = useStudio((state) => state.hello?.samplers) ?? [];
  const cores = useStudio((state) => state.hello?.cores) ?? 1;
  const refused = useStudio((state) => state.body?.refused);
  const draft = useStudyDraft();
  const form = useFormOfDocument();
  const job = useJob("study");
  const { start, starting } = useStart("study");
  const shown = useStudy();
  const past = shown?.id ?? null;
  if (!document || !form) {
    return (
      <Empty title="No design to vary">
        <p>Open a template or a design file; its parameters are then varied here.</p>
      </Empty>
    );
  }
  const all = choices(document.parameters, draft, shown?.study.space);
  const chosen = all.filter((one) => one.on);
  const objectives = Object.keys((form.source.objectives as object | undefined) ?? {}).length;
  const trouble = troubleOf(document) ?? obstacle(all, objectives, draft, samplers, refused);
  const grid = gridSize(chosen);
  const sampler = samplerOf(chosen, draft);
  const designs = sampler === "grid" ? grid : draft.budget;
  return (
    <div className="pane study" data-testid="study-form">
      {job && (past === null || past === job.id) && <JobCard job={job} />}
      {past !== null && past !== job?.id && <Past id={past} />}
      {past !== null && <PastNote job={past} />}
      <JobChooser kind="study" label="Study" />
      <Section title="Vary">
        {all.length === 0 && (
          <p className="muted">The design has no parameters; add some in its form.</p>
        )}
        {all.map((choice) => (
          <Vary key={choice.parameter.name} choice={choice} grid={sampler === "grid"} />
        ))}
      </Section>
      <FormContext value={form}>
        <Goals />
      </FormContext>
      <Section title="Search">
        <Select
          label="Sampler"
          value={sampler}
          title={samplers.find((one) => one.name === sampler)?.title ?? ""}
          options={samplers.map((one) => ({
            value: one.name,
            label: one.name,
            disabled: one.single_objective && objectives > 1,
          }))}
          onChange={(sampler) => changeDraft(() => ({ sampler }))}
        />
        <p className="sampler-note muted">{samplers.find((one) => one.name === sampler)?.title}</p>
        {sampler === "grid" ? (
          <div className="field">
            <span className="field-label">Designs</span>
            <span className="field-value">{grid === null ? "needs steps" : grid}</span>
          </div>
        ) : (
          <NumberField
            label="Budget"
            title="How many designs are tried at most."
            value={draft.budget}
            min={1}
            max={100_000}
            step={1}
            onChange={(budget) => changeDraft(() => ({ budget: Math.round(budget) }))}
          />
        )}
        <Select
          label="At once"
          title="How many designs are solved at the same time."
          value={draft.workers === null ? "" : String(draft.workers)}
          options={[
            { value: "", label: "as suits this machine" },
            ...Array.from({ length: cores }, (_, i) => ({
              value: String(i + 1),
              label: i === 0 ? "1 design" : `${i + 1} designs`,
            })),
          ]}
          onChange={(workers) =>
            changeDraft(() => ({ workers: workers === "" ? null : Number(workers) }))
          }
        />
        <NumberField
          label="Seed"
          title="The same seed gives the same study."
          value={draft.seed}
          min={0}
          step={1}
          onChange={(seed) => changeDraft(() => ({ seed: Math.round(seed) }))}
        />
        <TextField
          label="Name"
          value={draft.name}
          onCommit={(name) => {
            changeDraft(() => ({ name }));
            return null;
          }}
        />
      </Section>
      <div className="start">
        {trouble && <p className="muted">{trouble}</p>}
        <Button
          kind="primary"
          testId="study-start"
          disabled={trouble !== null || starting}
          onClick={() => start(studySpec(all, draft))}
        >
          {designs ? `Try ${designs.toLocaleString("en")} designs` : "Start"}
        </Button>
      </div>
    </div>
  );
}

/** A study that was not started in the studio, which the plots show. */
function Past(props: { id: string }) {
  const count = useStudio((state) => state.trials[props.id]?.trials.length ?? 0);
  return (
    <div className="job" data-testid="past-study">
      <div className="job-head">
        <strong>{props.id}</strong>
        <span className="badge">{count} designs</span>
      </div>
      <p className="muted">It was made outside the studio, and goes on where it was begun.</p>
    </div>
  );
}

function Vary(props: { choice: Choice; grid: boolean }) {
  const { parameter, on, sweep, problem } = props.choice;
  const { name, kind } = parameter;
  const count = countOf(sweep);
  const values = count === null ? "any value" : count === 1 ? "1 value" : `${count} values`;
  return (
    <RangeRow
      name={name}
      kind={kind}
      unit={parameter.display_unit || "1"}
      title={parameter.description}
      on={on}
      note={on ? values : formatKind(parameter.value, kind)}
      low={sweep.low}
      high={sweep.high}
      step={sweep.step}
      {...(sweep.step === null && !props.grid ? { log: sweep.log } : {})}
      problem={problem ?? undefined}
      onChange={({ on: wanted, ...change }) => {
        if (wanted === undefined) changeRange(name, change);
        else toggleSweep(name, wanted);
      }}
    />
  );
}
