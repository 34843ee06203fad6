import { Button, Section } from "../../../controls/Choice";
import { useStudio } from "../../../store/studio";
import { edit } from "../edits";
import { Glyph } from "../fields/Glyph";
import { freeName } from "../fields/starters";
import { useForm } from "../form";
import { ParameterRow } from "./ParameterRow";

export function Parameters() {
  const parameters = useStudio((state) => state.document?.parameters);
  const { source } = useForm();
  const add = () => {
    const name = freeName("size", Object.keys((source.parameters as object | undefined) ?? {}));
    edit(["parameters", name], { value: "10 mm", min: "5 mm", max: "20 mm" });
  };
  return (
    <Section
      title="Parameters"
      action={
        <Button icon kind="quiet" label="Add a parameter" onClick={add}>
          <Glyph name="plus" />
        </Button>
      }
    >
      {(parameters ?? []).length === 0 && (
        <p className="muted">None yet. A parameter can be slid here and varied by a study.</p>
      )}
      {parameters?.map((parameter) => (
        <ParameterRow key={parameter.name} parameter={parameter} />
      ))}
    </Section>
  );
}
