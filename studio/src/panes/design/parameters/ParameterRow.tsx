import { useEffect, useRef, useState } from "react";
import { Button } from "../../../controls/Choice";
import { readWritten, siUnit, writeValue } from "../../../controls/kinds";
import { NumberField } from "../../../controls/NumberField";
import { TextField } from "../../../controls/TextField";
import { formatQuantity, parseQuantity } from "../../../controls/units";
import type { Parameter } from "../../../protocol";
import { showPane } from "../../../shell/actions";
import { setMode } from "../../../store/page";
import { useStudio } from "../../../store/studio";
import { toggleSweep } from "../../study/draft";
import { edit, problemsAt, problemText, slide } from "../edits";
import { Glyph } from "../fields/Glyph";
import { Menu, type MenuPlace } from "../fields/Menu";
import { useForm } from "../form";
import { remove } from "../removing/remove";
import { GridNote } from "./GridNote";
import { lock, useLocked } from "./locks";
import { ParameterDetails } from "./ParameterDetails";
import { valuePath } from "./parameterPath";

/** The value as it is written, also where the design as a whole is not good. */
function writtenValue(parameter: Parameter): number {
  const read = parseQuantity(parameter.text, parameter.display_unit || "1");
  return !parameter.formula && "value" in read ? read.value : parameter.value;
}

/** A parameter: its value as a number with a slider or as a formula, and a menu of the rest. */
export function ParameterRow(props: { parameter: Parameter }) {
  const { parameter } = props;
  const { source, diagnostics, amounts } = useForm();
  const locked = useLocked(parameter.name);
  const [held, hold] = useState<number | null>(null);
  const [menu, setMenu] = useState<MenuPlace | null>(null);
  const [details, setDetails] = useState(false);
  const sliding = useRef(false);
  const rev = useStudio((state) => state.document?.rev);
  const path = valuePath(source, parameter.name);
  const problem = problemText(problemsAt(diagnostics, ["parameters", parameter.name]));
  const unit = parameter.display_unit;

  useEffect(() => {
    // The document has answered: show its value, unless the slider still moves.
    if (!sliding.current) hold(null);
  }, [rev]);

  const change = (value: number, settled: boolean) => {
    sliding.current = !settled;
    hold(value);
    slide(path, writeValue(value, parameter.factor, unit), settled);
  };
  const say = (value: number) => formatQuantity(value, siUnit(parameter.kind));
  const { [parameter.name]: _self, ...others } = amounts;
  const former = parameter.former;
  const sweep = () => {
    toggleSweep(parameter.name, true);
    setMode("optimize");
    showPane("study");
  };

  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: the same menu is behind the button
    <div
      className={`parameter${locked ? " is-locked" : ""}`}
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
          aside={say(parameter.value)}
          disabled={locked}
          onCommit={(text) => {
            const read = readWritten(text, parameter.kind, [], others);
            if ("problem" in read) return read.problem;
            edit(path, read.value);
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
          {...(former === null ? {} : { fallback: former })}
          formulas={{ parameters: others, take: (formula) => edit(path, formula) }}
          slider
          disabled={locked}
          problem={problem}
          onChange={change}
        />
      )}
      <Button
        icon
        kind="quiet"
        label={`More about ${parameter.name}${locked ? ", which is locked" : ""}`}
        onClick={() => {
          const row = document.querySelector(`[data-testid="parameter-${parameter.name}"]`);
          const box = row?.getBoundingClientRect();
          setMenu({ x: (box?.right ?? 200) - 200, y: (box?.bottom ?? 100) + 2 });
        }}
      >
        <Glyph name={locked ? "lock" : "more"} />
      </Button>
      {menu && (
        <Menu
          label={`Parameter ${parameter.name}`}
          at={menu}
          onClose={() => setMenu(null)}
          items={[
            { label: "Sweep this", disabled: parameter.formula || locked, run: sweep },
            {
              label: former === null ? "Back to the former value" : `Back to ${say(former)}`,
              disabled: former === null || former === parameter.value || locked,
              run: () => former !== null && change(former, true),
            },
            { label: locked ? "Unlock" : "Lock", run: () => lock(parameter.name, !locked) },
            {
              label: details ? "Hide range and name" : "Range, step, name",
              run: () => setDetails(!details),
            },
            {
              label: "Remove",
              disabled: locked,
              run: () => remove(["parameters", parameter.name], parameter.name),
            },
          ]}
        />
      )}
      <GridNote parameter={parameter} />
      {details && <ParameterDetails parameter={parameter} onDone={() => setDetails(false)} />}
    </div>
  );
}
