// Copies of a body or an object: beside it, in a mirror, around an axis. One press is one step.
import { useState } from "react";
import { Button, Select } from "../../../controls/Choice";
import { NumberField } from "../../../controls/NumberField";
import type { CopyCommand, Triple } from "../../../protocol";
import { send } from "../../../store/session";
import { useStudio } from "../../../store/studio";
import { besideOf } from "./several";

type Axis = "x" | "y" | "z";
const AXES: readonly Axis[] = ["x", "y", "z"];

export function CopyTools(props: { name: string; mirrors?: boolean }) {
  const { name } = props;
  const [open, setOpen] = useState<"mirror" | "around" | null>(null);
  const copy = (way: CopyCommand["way"]) => {
    send({ t: "copy", name, way });
    setOpen(null);
  };
  const beside = () => copy({ kind: "beside", by: besideOf(name, useStudio.getState().body) });
  const toggle = (tool: "mirror" | "around") => setOpen(open === tool ? null : tool);
  return (
    <div className="copy-tools" data-testid={`copy-${name}`}>
      <div className="row">
        <Button
          testId="copy-beside"
          label={`Copy ${name} beside all that there is`}
          onClick={beside}
        >
          Copy
        </Button>
        {props.mirrors !== false && (
          <Button
            testId="copy-mirror"
            label={`Add the mirror image of ${name}`}
            pressed={open === "mirror"}
            onClick={() => toggle("mirror")}
          >
            Mirror…
          </Button>
        )}
        <Button
          testId="copy-around"
          label={`Arrange copies of ${name} around an axis`}
          pressed={open === "around"}
          onClick={() => toggle("around")}
        >
          Arrange…
        </Button>
      </div>
      {open === "mirror" && <InMirror copy={copy} />}
      {open === "around" && <Around copy={copy} />}
    </div>
  );
}

interface ToolProps {
  copy(way: CopyCommand["way"]): void;
}

function InMirror({ copy }: ToolProps) {
  const [axis, setAxis] = useState<Axis>("x");
  const [at, setAt] = useState(0);
  return (
    <div className="details" data-testid="mirror-tool">
      <p className="muted">Adds the mirror image in a plane of the whole design.</p>
      <Select
        label="Plane"
        value={axis}
        options={AXES.map((value) => ({ value, label: `across ${value}` }))}
        onChange={(value) => setAxis(value as Axis)}
      />
      <NumberField label={`At ${axis}`} unit="m" value={at} step={1e-3} onChange={setAt} />
      <Button kind="primary" testId="mirror-do" onClick={() => copy({ kind: "mirror", axis, at })}>
        Add the mirror image
      </Button>
    </div>
  );
}

const MOST_COPIES = 100;

function Around({ copy }: ToolProps) {
  const [count, setCount] = useState(3);
  const [axis, setAxis] = useState<Axis>("z");
  const [center, setCenter] = useState<Triple>([0, 0, 0]);
  const direction = AXES.map((one) => Number(one === axis)) as Triple;
  const more = count - 1;
  return (
    <div className="details" data-testid="around-tool">
      <p className="muted">Adds copies at equal angles around an axis.</p>
      <NumberField
        label="In all"
        title="How many there are then, with the one that is copied"
        value={count}
        min={2}
        max={MOST_COPIES}
        step={1}
        onChange={(value) => setCount(Math.min(MOST_COPIES, Math.max(2, Math.round(value))))}
      />
      <Select
        label="Axis"
        value={axis}
        options={AXES.map((value) => ({ value, label: `along ${value}` }))}
        onChange={(value) => setAxis(value as Axis)}
      />
      {AXES.map((one, i) =>
        one === axis ? null : (
          <NumberField
            key={one}
            label={`Through ${one}`}
            title="A point that the axis goes through"
            unit="m"
            value={center[i] as number}
            step={1e-3}
            onChange={(value) =>
              setCenter(center.map((old, j) => (j === i ? value : old)) as Triple)
            }
          />
        ),
      )}
      <Button
        kind="primary"
        testId="around-do"
        onClick={() => copy({ kind: "around", count, axis: direction, center })}
      >
        Add {more} {more === 1 ? "copy" : "copies"}
      </Button>
    </div>
  );
}
