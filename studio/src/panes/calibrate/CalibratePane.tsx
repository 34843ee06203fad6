// Fit the material of the design to measured points: data, constants, method, result.

import { useEffect } from "react";
import { Button, Empty, Section, Select, Toggle } from "../../controls/Choice";
import { writtenUnit } from "../../controls/kinds";
import { NumberField } from "../../controls/NumberField";
import { RangeRow } from "../../controls/RangeRow";
import type { FitRange } from "../../protocol";
import { onReady } from "../../store/session";
import { useStudio } from "../../store/studio";
import { openHere } from "../design/edits";
import { troubleOf } from "../design/trouble";
import { useFormOfDocument } from "../design/useForm";
import { JobCard } from "../jobs/JobCard";
import { PastNote } from "../jobs/PastNote";
import { JobChooser } from "../study/StudyPane";
import { useStart } from "../study/useStart";
import { useCalibration } from "./current";
import { askAgain, type Bound, useCalibrateDraft } from "./draft";
import { Result } from "./Result";
import { boundsOf, calibrateSpec, helpOfModel, modelOf, obstacle } from "./setup";
import { Tables } from "./Tables";
import "../design/design.css";
import "../study/study.css";
import "./calibrate.css";

export default function CalibratePane() {
  const document = useStudio((state) => state.document);
  const hello = useStudio((state) => state.hello);
  const measured = useStudio((state) => state.measured);
  const draft = useCalibrateDraft();
  const form = useFormOfDocument();
  const current = useCalibration();
  const { start, starting } = useStart("calibrate");

  useEffect(() => {
    return onReady(askAgain);
  }, []);

  if (!hello || !document || !form) {
    return (
      <Empty title="No design to fit">
        <p>
          A calibration simulates the specimen that was measured. Start from the cantilever beam, or
          open a design of your own specimen.
        </p>
        <Button kind="primary" onClick={() => openHere("template", "beam")}>
          Open the beam
        </Button>
      </Empty>
    );
  }
  const material = modelOf(form.source, hello.materials);
  const constants = hello.fit_ranges[material?.model ?? ""] ?? [];
  const help = helpOfModel(form.root, material?.model ?? "");
  const probes = Object.keys((form.source.probes as object | undefined) ?? {}).length;
  const trouble = troubleOf(document) ?? obstacle(draft, measured, constants);
  return (
    <div className="pane calibrate" data-testid="calibrate-form">
      {current?.job && <JobCard job={current.job} />}
      {current && <PastNote job={current.id} />}
      <JobChooser kind="calibrate" label="Calibration" />
      {current?.result && (
        <Result key={current.result.job} result={current.result} root={form.root} />
      )}
      <Section
        title="Specimen"
        action={
          <Button
            kind="quiet"
            label="Use the beam: open the cantilever beam as the specimen"
            onClick={() => openHere("template", "beam")}
          >
            Use the beam
          </Button>
        }
      >
        <p>
          <strong>{document.name}</strong>{" "}
          <span className="muted">
            of {material?.name ?? "an unknown material"} ({material?.model ?? "?"})
          </span>
        </p>
        {probes === 0 && (
          <p className="muted">
            It has no probes: measured rows name a probe or a distance along a beam.
          </p>
        )}
      </Section>
      <Tables />
      <Section title="Fit">
        {constants.map((constant) => (
          <Fit key={constant.name} constant={constant} help={help[constant.name] ?? ""} />
        ))}
        <Toggle
          label="free the scale of the shape"
          title="For photographs whose scale is doubtful: one factor for each table."
          checked={draft.freeScale}
          onChange={(freeScale) => useCalibrateDraft.setState({ freeScale })}
        />
      </Section>
      <Section title="Search">
        <Select
          label="Method"
          value={draft.method}
          options={hello.calibration_methods}
          onChange={(method) => useCalibrateDraft.setState({ method })}
        />
        <NumberField
          label="Generations"
          value={draft.generations}
          min={1}
          max={10_000}
          step={1}
          onChange={(value) => useCalibrateDraft.setState({ generations: Math.round(value) })}
        />
        <NumberField
          label="Population"
          title="Candidates in each generation."
          value={draft.population}
          min={2}
          max={10_000}
          step={1}
          onChange={(value) => useCalibrateDraft.setState({ population: Math.round(value) })}
        />
        <NumberField
          label="Seed"
          title="The same seed gives the same answer."
          value={draft.seed}
          min={0}
          step={1}
          onChange={(value) => useCalibrateDraft.setState({ seed: Math.round(value) })}
        />
        <div className="toggles">
          <Toggle
            label="refine"
            title="Walk to the bottom of the valley that the search found."
            checked={draft.refine}
            onChange={(refine) => useCalibrateDraft.setState({ refine })}
          />
          <Toggle
            label="ask what the data determine"
            title="Profiles of the error along each constant."
            checked={draft.identify}
            onChange={(identify) => useCalibrateDraft.setState({ identify })}
          />
        </div>
      </Section>
      <div className="start">
        {trouble && <p className="muted">{trouble}</p>}
        <Button
          kind="primary"
          testId="calibrate-start"
          disabled={trouble !== null || starting}
          onClick={() => start(calibrateSpec(draft, constants))}
        >
          Fit the material
        </Button>
      </div>
    </div>
  );
}

function Fit(props: { constant: FitRange; help: string }) {
  const { name, kind } = props.constant;
  const draft = useCalibrateDraft();
  const bound: Bound = draft.bounds[name] ?? { on: true, low: null, high: null };
  return (
    <RangeRow
      name={name}
      kind={kind}
      unit={writtenUnit(kind) || "1"}
      on={bound.on}
      title={props.help}
      note={bound.on ? "" : "as the design has it"}
      {...boundsOf(draft, props.constant)}
      onChange={(change) =>
        useCalibrateDraft.setState({ bounds: { ...draft.bounds, [name]: { ...bound, ...change } } })
      }
    />
  );
}
