import { useState } from "react";
import { Button, Section } from "../../controls/Choice";
import { formatKind } from "../../controls/kinds";
import { TextField } from "../../controls/TextField";
import type { CalibratedEvent } from "../../protocol";
import { send } from "../../store/session";
import { toast, useStudio } from "../../store/studio";
import { edit } from "../design/edits";
import type { Schema } from "../design/fields/schema";
import { withUnits } from "./setup";
import { showFit } from "./tell";

/** Result: the constants, whether the data fix them, and actions with them. */
export function Result(props: { result: CalibratedEvent; root: Schema }) {
  const { result } = props;
  const [name, setName] = useState(`${result.job}`.toLowerCase().replaceAll(/[^a-z0-9]+/g, "-"));
  const apply = () => {
    edit(["materials", name], withUnits(props.root, result.material));
    const parts = (useStudio.getState().document?.source?.parts as unknown[] | undefined) ?? [];
    if (parts.length > 0) edit(["parts", 0, "material"], name);
    toast({ level: "good", what: `The first part is made of ${name} now`, hint: "" });
  };
  return (
    <Section title="Result">
      <div data-testid="calibrated">
        {result.parameters.map((one) => (
          <div key={one.name} className="fitted">
            <span>{one.name}</span>
            <strong>{one.text}</strong>
            <span className={`badge ${badgeOf(one.identifiable, result.miss)[0]}`}>
              {badgeOf(one.identifiable, result.miss)[1]}
            </span>
            {one.identifiable !== null && <p className="muted">{one.sentence}</p>}
          </div>
        ))}
        {result.warnings.map((sentence) => (
          <p key={sentence} className="fit-miss" role="status" data-testid="fit-miss">
            {sentence}
          </p>
        ))}
        <p>
          Mean error <strong>{formatKind(result.mean_error, "length", 3)}</strong>, largest{" "}
          <strong>{formatKind(result.max_error, "length", 3)}</strong>
        </p>
      </div>
      <TextField
        label="Card"
        value={name}
        title="The name under which designs can speak of this material."
        onCommit={(text) => {
          if (!/^[a-z0-9][a-z0-9-]*$/.test(text)) return "small letters, digits and - only";
          setName(text);
          return null;
        }}
      />
      <div className="row result-buttons">
        <Button testId="fit-show" onClick={showFit}>
          Show the fit
        </Button>
        <Button testId="card-save" onClick={() => send({ t: "card_save", job: result.job, name })}>
          Save the card
        </Button>
        <Button testId="card-apply" onClick={apply}>
          Apply to the design
        </Button>
      </div>
    </Section>
  );
}

/** Color and words for a constant: nothing is settled by a model that misses the measured shape. */
export function badgeOf(identifiable: boolean | null, miss: string): readonly [string, string] {
  if (identifiable === null) return ["", "not asked"];
  if (!identifiable) return ["warn", "not determined"];
  return miss ? ["warn", "determined, but the model misses"] : ["good", "determined"];
}
