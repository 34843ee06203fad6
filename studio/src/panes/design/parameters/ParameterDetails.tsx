import { Button } from "../../../controls/Choice";
import { readWritten, siUnit } from "../../../controls/kinds";
import { TextField } from "../../../controls/TextField";
import { formatQuantity } from "../../../controls/units";
import type { Parameter } from "../../../protocol";
import { edit, problemOfName, rename } from "../edits";
import { useForm } from "../form";

/** Content of a parameter's menu: its name, its range and step, and its meaning. */
export function ParameterDetails(props: { parameter: Parameter; onDone(): void }) {
  const { parameter } = props;
  const { source, amounts } = useForm();
  const written = (source.parameters as Record<string, unknown>)[parameter.name];
  const table =
    typeof written === "object" && written !== null ? (written as Record<string, unknown>) : null;
  const set = (key: "min" | "max" | "step", text: string): string | null => {
    if (text.trim() === "") {
      edit(["parameters", parameter.name, key], null);
      return null;
    }
    const { [parameter.name]: _self, ...others } = amounts;
    const read = readWritten(text, parameter.kind, [], others);
    if ("problem" in read) return read.problem;
    if (table) edit(["parameters", parameter.name, key], read.value);
    else edit(["parameters", parameter.name], { value: written, [key]: read.value });
    return null;
  };
  const shown = (key: "min" | "max" | "step") => {
    const text = table?.[key];
    if (typeof text === "string" && text.trimStart().startsWith("=")) return text;
    const value = parameter[key];
    return value === null ? "" : formatQuantity(value, siUnit(parameter.kind), 8);
  };
  return (
    <div className="details">
      <TextField
        label="Name"
        value={parameter.name}
        onCommit={(name) => {
          const taken = Object.keys((source.parameters as object | undefined) ?? {});
          const problem = problemOfName(name, "parameters", taken);
          if (problem === null) rename("parameters", parameter.name, name);
          return problem;
        }}
      />
      <TextField label="Smallest" value={shown("min")} onCommit={(t) => set("min", t)} />
      <TextField label="Largest" value={shown("max")} onCommit={(t) => set("max", t)} />
      <TextField label="Step" value={shown("step")} onCommit={(t) => set("step", t)} />
      <TextField
        label="Meaning"
        value={parameter.description}
        onCommit={(text) => {
          edit(["parameters", parameter.name, "description"], text.trim() || null);
          return null;
        }}
      />
      <Button kind="quiet" onClick={props.onDone}>
        Done
      </Button>
    </div>
  );
}
