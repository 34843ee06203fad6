// The button in a field of a number that makes a parameter of it.
import { toast } from "../../../store/studio";
import { type Change, editAll } from "../edits";
import { Glyph } from "../fields/Glyph";

/** `changes` add the parameter first, then put its name where the number was. */
export function PromoteTool(props: { label: string; changes: readonly Change[] }) {
  const { label, changes } = props;
  const name = String(changes[0]?.path[1] ?? "");
  return (
    <button
      type="button"
      className="promote"
      aria-label={`Make a parameter of ${label}`}
      title="Make a parameter of it, which can be slid and varied by a study"
      onClick={() => {
        editAll(changes);
        toast({
          level: "good",
          what: `${name} is a parameter of the design`,
          hint: "It stands at the top of the form, with bounds of ± 50 %. Ctrl+Z takes it back.",
          about: "design",
        });
      }}
    >
      <Glyph name="sweep" />
    </button>
  );
}
