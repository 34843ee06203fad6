import { Section } from "../controls/Choice";
import { formatNumber, formatQuantity } from "../controls/units";
import type { Touch } from "../protocol";
import { useStudio } from "../store/studio";

/** Parts of the pressure under which all sticks, or all slips: bounds are right to a few percent. */
const FEW = 0.02;

/** What touches what in the frame that is shown: with how much force, over which area, and whether it holds. */
export function ContactCard() {
  const moment = useStudio(({ moments, stat }) => moments.get(stat?.frame ?? 0));
  if (!moment) return null;
  return (
    <Section title="What touches">
      <div data-testid="contacts">
        {moment.contacts.length === 0 && <p className="muted">Nothing touches in this frame.</p>}
        {(moment.depth ?? 0) > 0 && (
          <p className="warn" data-testid="contact-depth">
            Surfaces are {formatNumber(1e3 * (moment.depth ?? 0), 2)} mm in each other: pressed too
            hard to be told live.
          </p>
        )}
        {moment.contacts.map((touch) => (
          <div key={touch.of.join()} className="touch">
            <strong>{whoOf(touch)}</strong>
            <dl className="facts">
              <div>
                <dt>Force</dt>
                <dd>{formatQuantity(forceOf(touch), "N", 4)}</dd>
              </div>
              <div>
                <dt>Area</dt>
                <dd>{formatNumber(1e6 * touch.area, 3)} mm²</dd>
              </div>
              <div>
                <dt>Hold</dt>
                <dd>{holdOf(touch.slipping)}</dd>
              </div>
            </dl>
          </div>
        ))}
      </div>
    </Section>
  );
}

function whoOf({ of: [first, second] }: Touch): string {
  return first === second ? `${first} on itself` : `${first} on ${second}`;
}

/** The force on the first; of the body on itself, which cancels, the sum of the sizes. */
export function forceOf({ of: [first, second], force, pressed }: Touch): number {
  return first === second ? pressed : Math.hypot(...force);
}

/** Whether surfaces hold, by the part of the pressure under which they slip. */
export function holdOf(slipping: number): string {
  if (slipping < FEW) return "sticks";
  if (slipping > 1 - FEW) return "slips";
  return `${formatNumber(100 * slipping, 2)} % slips`;
}
