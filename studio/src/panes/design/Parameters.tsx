import { useEffect, useRef, useState } from "react";
import { Button, Section } from "../../controls/Choice";
import { siUnit, writeValue } from "../../controls/kinds";
import { NumberField } from "../../controls/NumberField";
import { formatQuantity, parseQuantity } from "../../controls/units";
import type { Parameter } from "../../protocol";
import { showPane } from "../../shell/actions";
import { setMode } from "../../store/page";
import { useStudio } from "../../store/studio";
import { toggleSweep } from "../study/draft";
import { edit, problemsAt, problemText, replaceText, slide } from "./edits";
import { useForm } from "./form";
import { Glyph } from "./Glyph";
import { Menu, type MenuPlace } from "./Menu";
import { NAME, renamed } from "./rename";
import { freeName } from "./starters";
import { TextField } from "./TextField";

/** Where the value of a parameter is written: a table has it inside. */
function valuePath(source: Readonly<Record<string, unknown>>, name: string): (string | number)[] {
  const all = source.parameters as Record<string, unknown> | undefined;
  const written = all?.[name];
  return typeof written === "object" && written !== null
    ? ["parameters", name, "value"]
    : ["parameters", name];
}

/** The value as it is written, also where the design as a whole is not good. */
function writtenValue(parameter: Parameter): number {
  const read = parseQuantity(parameter.text, parameter.display_unit || "1");
  return !parameter.formula && "value" in read ? read.value : parameter.value;
}

interface Baseline {
  readonly document: string;
  readonly values: Readonly<Record<string, number>>;
}

/** The values that the document had when it was opened or saved last. */
function useBaseline(): Readonly<Record<string, number>> {
  const document = useStudio((state) => state.document);
  const baseline = useRef<Baseline | null>(null);
  if (document?.valid) {
    const id = `${document.path ?? ""}|${document.name}`;
    if (baseline.current?.document !== id || !document.dirty) {
      baseline.current = {
        document: id,
        values: Object.fromEntries(document.parameters.map((one) => [one.name, one.value])),
      };
    }
  }
  return baseline.current?.values ?? {};
}

export function Parameters() {
  const parameters = useStudio((state) => state.document?.parameters);
  const { source } = useForm();
  const baseline = useBaseline();
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
        <ParameterRow
          key={parameter.name}
          parameter={parameter}
          fallback={baseline[parameter.name]}
        />
      ))}
    </Section>
  );
}

function ParameterRow(props: { parameter: Parameter; fallback: number | undefined }) {
  const { parameter } = props;
  const { source, diagnostics } = useForm();
  const [held, hold] = useState<number | null>(null);
  const [menu, setMenu] = useState<MenuPlace | null>(null);
  const [details, setDetails] = useState(false);
  const sliding = useRef(false);
  const rev = useStudio((state) => state.document?.rev);
  const path = valuePath(source, parameter.name);
  const problem = problemText(problemsAt(diagnostics, ["parameters", parameter.name]));
  const unit = parameter.display_unit;

  useEffect(() => {
    // The document has answered: show what it holds, unless the slider still moves.
    if (!sliding.current) hold(null);
  }, [rev]);

  const change = (value: number, settled: boolean) => {
    sliding.current = !settled;
    hold(value);
    slide(path, writeValue(value, parameter.factor, unit), settled);
  };
  const sweep = () => {
    toggleSweep(parameter.name, true);
    setMode("optimize");
    showPane("study");
  };

  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: the same menu is behind the button
    <div
      className="parameter"
      data-testid={`parameter-${parameter.name}`}
      onContextMenu={(event) => {
        event.preventDefault();
        setMenu({ x: event.clientX, y: event.clientY });
      }}
    >
      {parameter.formula ? (
        <TextField
          label={parameter.name}
          right
          value={parameter.text}
          title={parameter.description}
          problem={problem}
          aside={formatQuantity(parameter.value, siUnit(parameter.kind))}
          onCommit={(text) => {
            edit(path, text.trim());
            return null;
          }}
        />
      ) : (
        <NumberField
          label={parameter.name}
          title={parameter.description}
          value={held ?? writtenValue(parameter)}
          unit={siUnit(parameter.kind)}
          min={parameter.min}
          max={parameter.max}
          step={parameter.step}
          {...(props.fallback === undefined ? {} : { fallback: props.fallback })}
          slider
          problem={problem}
          onChange={change}
        />
      )}
      <Button
        icon
        kind="quiet"
        label={`More about ${parameter.name}`}
        onClick={() => {
          const row = document.querySelector(`[data-testid="parameter-${parameter.name}"]`);
          const box = row?.getBoundingClientRect();
          setMenu({ x: (box?.right ?? 200) - 200, y: (box?.bottom ?? 100) + 2 });
        }}
      >
        <Glyph name="more" />
      </Button>
      {menu && (
        <Menu
          label={`Parameter ${parameter.name}`}
          at={menu}
          onClose={() => setMenu(null)}
          items={[
            { label: "Sweep this", disabled: parameter.formula, run: sweep },
            {
              label: "Back to the value at opening",
              disabled: props.fallback === undefined || props.fallback === parameter.value,
              run: () => props.fallback !== undefined && change(props.fallback, true),
            },
            {
              label: details ? "Hide range and name" : "Range, step, name",
              run: () => setDetails(!details),
            },
            { label: "Remove", run: () => edit(["parameters", parameter.name], null) },
          ]}
        />
      )}
      {details && <Details parameter={parameter} onDone={() => setDetails(false)} />}
    </div>
  );
}

function Details(props: { parameter: Parameter; onDone(): void }) {
  const { parameter } = props;
  const { source } = useForm();
  const written = (source.parameters as Record<string, unknown>)[parameter.name];
  const set = (key: string, text: string): string | null => {
    if (text.trim() === "") {
      edit(["parameters", parameter.name, key], null);
      return null;
    }
    const read = parseQuantity(text, parameter.display_unit || "1");
    if ("problem" in read) return read.problem;
    const value = writeValue(read.value, parameter.factor, parameter.display_unit);
    if (typeof written === "object" && written !== null) {
      edit(["parameters", parameter.name, key], value);
    } else {
      edit(["parameters", parameter.name], { value: written, [key]: value });
    }
    return null;
  };
  const shown = (value: number | null) =>
    value === null ? "" : formatQuantity(value, siUnit(parameter.kind), 8);
  return (
    <div className="details">
      <TextField
        label="Name"
        value={parameter.name}
        onCommit={(name) => {
          if (!NAME.test(name)) return "letters, digits, _ and - only";
          if (name in ((source.parameters as object | undefined) ?? {})) return "is taken";
          const text = useStudio.getState().document?.text ?? "";
          replaceText(renamed(text, "parameters", parameter.name, name));
          return null;
        }}
      />
      <TextField label="Smallest" value={shown(parameter.min)} onCommit={(t) => set("min", t)} />
      <TextField label="Largest" value={shown(parameter.max)} onCommit={(t) => set("max", t)} />
      <TextField label="Step" value={shown(parameter.step)} onCommit={(t) => set("step", t)} />
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
