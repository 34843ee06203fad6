// A material from tensile tests: the tests, the fitted curve over them, and the part to make of it.
import { useRef, useState } from "react";
import { Button, Section, Select } from "../../controls/Choice";
import { formatKind } from "../../controls/kinds";
import { Plot } from "../../controls/Plot";
import { TextField } from "../../controls/TextField";
import type { CouponFitEvent, CouponModel } from "../../protocol";
import { TABLES, takeTable } from "../../shell/dropTable";
import { toast, useStudio } from "../../store/studio";
import { editAll } from "../design/edits";
import { Glyph } from "../design/fields/Glyph";
import { freeName } from "../design/fields/starters";
import { type PartChoice, partsOf } from "../materials/use";
import {
  removeTest,
  type SpecimenSizes,
  setSizes,
  setTestMode,
  TESTS,
  type TestMode,
  useCoupons,
} from "./coupons";
import { chartOf } from "./curves";
import "./coupon.css";

const SIZES: readonly (readonly [keyof SpecimenSizes, string, string, string])[] = [
  ["area", "Cross section", "18 mm^2", "Of the unstretched specimen; for a table of forces"],
  ["length", "Gauge length", "33 mm", "For a table of displacements"],
  ["max_strain", "Largest strain", "300 %", "Points beyond it do not count"],
];

export default function CouponPane() {
  const { fit, problem, busy } = useCoupons();
  return (
    <div className="pane" data-testid="coupon-pane">
      <Tests />
      {problem && (
        <p className="section bad" role="status" data-testid="coupon-problem">
          {problem.where && <b>{problem.where}: </b>}
          {problem.what}
          {problem.hint && <span className="muted"> Try: {problem.hint}.</span>}
        </p>
      )}
      {busy && !fit && (
        <p className="section muted" role="status">
          All models are being fitted…
        </p>
      )}
      {fit && <Fitted fit={fit} />}
    </div>
  );
}

function Tests() {
  const tests = useCoupons((state) => state.tests);
  const sizes = useCoupons((state) => state.sizes);
  // A table of stresses and strains needs no sizes: they are shown where something is missing.
  const asked = useCoupons((state) => state.problem !== null);
  const picker = useRef<HTMLInputElement>(null);
  return (
    <Section
      title="Tests of the material"
      action={
        <Button kind="quiet" onClick={() => picker.current?.click()}>
          Choose a file…
        </Button>
      }
    >
      <input
        ref={picker}
        className="visually-hidden"
        type="file"
        tabIndex={-1}
        multiple
        accept={TABLES.join(",")}
        aria-label="Choose a test of the material"
        data-testid="coupon-file"
        onChange={(event) => {
          for (const file of event.target.files ?? []) void takeTable(file, "coupon");
          event.target.value = "";
        }}
      />
      {tests.length === 0 && (
        <p className="muted">
          Drop a tensile test (.csv) anywhere on the page: columns of strain and stress, or of
          displacement and force, with their units. Several tests of one material are fitted
          together.
        </p>
      )}
      {tests.map((test) => (
        <div key={test.name} className="coupon-test" data-testid="coupon-test">
          <strong>{test.name}</strong>
          <Button
            icon
            kind="quiet"
            label={`Remove ${test.name}`}
            onClick={() => removeTest(test.name)}
          >
            <Glyph name="trash" />
          </Button>
          <Select
            bare
            label={`Test of ${test.name}`}
            value={test.mode}
            options={Object.entries(TESTS).map(([value, label]) => ({ value, label }))}
            onChange={(mode) => setTestMode(test.name, mode as TestMode)}
          />
        </div>
      ))}
      {tests.length > 0 &&
        SIZES.filter(([key]) => key === "max_strain" || asked || sizes[key] !== "").map(
          ([key, label, placeholder, title]) => (
            <TextField
              key={key}
              label={label}
              title={title}
              placeholder={placeholder}
              right
              value={sizes[key]}
              onCommit={(text) => {
                setSizes({ [key]: text.trim() });
                return null;
              }}
            />
          ),
        )}
    </Section>
  );
}

function Fitted(props: { fit: CouponFitEvent }) {
  const { fit } = props;
  const chosen = useCoupons((state) => state.model) ?? fit.recommended;
  const model = fit.models.find(({ name }) => name === chosen) ?? fit.models[0]!;
  const { series, data } = chartOf(fit, model);
  const kilopascal = (value: number) => formatKind(value, "modulus", 3);
  return (
    <>
      <Section title="Fit">
        <Select
          label="Model"
          title="Best prediction first"
          value={model.name}
          options={fit.models.map((one) => ({
            value: one.name,
            label: `${one.name}, error ${kilopascal(one.error)}${
              one.name === fit.recommended ? " (recommended)" : ""
            }`,
          }))}
          onChange={(name) => useCoupons.setState({ model: name })}
        />
        <div className="coupon-plot">
          <Plot
            testId="plot-coupon"
            label={`Stress over strain: ${fit.curves.map(({ name }) => name).join(", ")} and ${model.name}`}
            x={{ label: "strain [%]" }}
            y={{ label: "stress [kPa]" }}
            series={series}
            data={data}
          />
        </div>
        <dl className="facts" data-testid="coupon-facts">
          <div>
            <dt>Young's modulus</dt>
            <dd title="At small strain, with its 95 % interval for this model">
              {kilopascal(model.young)} ({kilopascal(model.low)} to {kilopascal(model.high)})
            </dd>
          </div>
          <div>
            <dt>Error of the stress</dt>
            <dd>
              {kilopascal(model.error)}, at most {kilopascal(model.largest)}
            </dd>
          </div>
        </dl>
        {model.warnings.map((sentence) => (
          <p key={sentence} className="coupon-beware">
            {sentence}.
          </p>
        ))}
        {fit.rejected.map((sentence) => (
          <p key={sentence} className="muted">
            {sentence}.
          </p>
        ))}
      </Section>
      <UseIt fit={fit} model={model} />
    </>
  );
}

/** The material goes into the design, and a part is made of it. */
function UseIt(props: { fit: CouponFitEvent; model: CouponModel }) {
  const { fit, model } = props;
  const document = useStudio((state) => state.document);
  const cards = useStudio((state) => state.hello?.materials) ?? [];
  const typed = useCoupons((state) => state.name);
  const [wanted, want] = useState(0);
  const parts = partsOf(document?.source ?? {});
  const part = parts[wanted] ?? parts[0] ?? null;
  const name =
    typed ??
    freeName(
      fit.name,
      cards.map((card) => card.name),
    );
  return (
    <Section title="Use it">
      <TextField
        label="Name"
        title="Name of the material in the design; one that the design has is replaced"
        value={name}
        onCommit={(text) => {
          if (!/^[a-z0-9][a-z0-9-]*$/.test(text)) return "small letters, digits and - only";
          if (cards.some((card) => card.name === text)) return `${text} is a card of VoxSoft`;
          useCoupons.setState({ name: text });
          return null;
        }}
      />
      {parts.length > 1 && (
        <Select
          label="For part"
          value={String(part?.index)}
          options={parts.map(({ index, name: label }) => ({ value: String(index), label }))}
          onChange={(index) => want(Number(index))}
        />
      )}
      {model.refused && <p className="coupon-beware is-bad">{model.refused}.</p>}
      {part === null && <p className="muted">The design has no part of its own.</p>}
      <Button
        kind="primary"
        testId="coupon-use"
        disabled={part === null || model.refused !== ""}
        onClick={() => part && give(name, model, part)}
      >
        {part ? `Make ${part.name} of it` : "Use it"}
      </Button>
    </Section>
  );
}

function give(name: string, model: CouponModel, part: PartChoice): void {
  editAll([
    { path: ["materials", name], value: model.table },
    { path: ["parts", part.index, "material"], value: name },
  ]);
  toast({
    level: "good",
    what: `${part.name} is made of ${name}`,
    hint: "Ctrl+Z takes it back.",
    about: "material",
  });
}
