// The friction of an object with the bodies: a number with a slider, or the formula that it follows.
import { formatKind, readWritten } from "../../../controls/kinds";
import { NumberField } from "../../../controls/NumberField";
import { TextField } from "../../../controls/TextField";
import { editAll } from "../edits";
import { useForm } from "../form";
import { PromoteTool } from "../parameters/PromoteTool";
import { promotedTo } from "../parameters/promote";
import { frictionEdit, frictionOf } from "./gripped";
import { meetingOf } from "./pairs";
import { bodyNames } from "./several";

const TITLE = "Coulomb's coefficient between it and the body";

export function FrictionField(props: { name: string; objects: number }) {
  const { source, design, amounts } = useForm();
  const { name, objects } = props;
  const bodies = bodyNames(source);
  const friction = frictionOf(source.contact, name, bodies);
  const change = (next: number | string) =>
    frictionEdit(source.contact, name, objects, next, bodies);
  const bonded = bodies.filter((body) => meetingOf(source.contact, body, name).kind === "bonded");
  if (bonded.length > 0)
    return <p className="muted">Bonded to {bonded.join(", ")}, as Contact below says.</p>;
  if (typeof friction === "number") {
    const wanted = objects < 2 ? "friction" : `friction_${name}`;
    return (
      <NumberField
        label="Friction"
        title={TITLE}
        value={friction}
        min={0}
        max={1.5}
        step={0.05}
        slider
        tool={
          <PromoteTool label="Friction" changes={promotedTo(wanted, friction, source, change)} />
        }
        onChange={(next, settled) => settled && editAll(change(next))}
      />
    );
  }
  const worth = frictionOf((design as { contact?: unknown } | null)?.contact, name, bodies);
  return (
    <TextField
      label="Friction"
      title={TITLE}
      right
      value={String(friction)}
      aside={typeof worth === "number" ? formatKind(worth, "number") : undefined}
      onCommit={(text) => {
        const read = readWritten(text, "number", [], amounts);
        if ("problem" in read) return read.problem;
        editAll(change(read.value));
        return null;
      }}
    />
  );
}
