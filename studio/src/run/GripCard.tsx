import { Section } from "../controls/Choice";
import type { Grip } from "../protocol";
import { useEquilibrium } from "./EquilibriumCard";

/** Tone of a verdict, good, in doubt, or bad: the colors of the whole page. */
const TONES: Readonly<Record<Grip["verdict"], string>> = {
  held: "is-good",
  slips: "is-doubtful",
  touched: "is-doubtful",
  lost: "is-bad",
};

/** Grip on free objects at the end of a run, with its margin. */
export function GripCard() {
  const grips = useEquilibrium()?.grips ?? [];
  if (grips.length === 0) return null;
  return (
    <Section title="Grip">
      <div data-testid="grips">
        {grips.map(({ name, verdict, sentence }) => (
          <p key={name} className={`run-sentence ${TONES[verdict]}`} data-verdict={verdict}>
            {sentence}
          </p>
        ))}
      </div>
    </Section>
  );
}
