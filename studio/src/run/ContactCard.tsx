import { Section } from "../controls/Choice";
import { formatNumber, formatQuantity } from "../controls/units";
import type { Touch } from "../protocol";
import { useStudio } from "../store/studio";
import { holdColor } from "../view/marks/forces";
import { holdOf } from "./hold";

/** Contacts in the frame that is shown: force, area, and whether each holds. */
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
              {(touch.bound ?? 0) > 0 && (
                <div title="The part of the force that is friction, and the most that it can be">
                  <dt>Friction</dt>
                  <dd>{frictionOf(touch)}</dd>
                </div>
              )}
              {isSmooth(touch) ? (
                <div>
                  <dt>Friction</dt>
                  <dd>none</dd>
                </div>
              ) : (
                <div>
                  <dt>Hold</dt>
                  <dd>
                    <i className="hold" style={{ background: holdColor(touch.slipping) }} />
                    {holdOf(touch.slipping)}
                  </dd>
                </div>
              )}
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

/** Without friction surfaces slip by their nature, which is no fault. */
export function isSmooth({ bound, slipping }: Touch): boolean {
  return (bound ?? 0) === 0 && slipping > 0.5;
}

/** Present share of the largest possible friction: both in N, and as a part. */
export function frictionOf({ friction, bound }: Touch): string {
  const most = bound ?? 0;
  const share = most > 0 ? Math.min(1, (friction ?? 0) / most) : 0;
  const of = `${formatQuantity(friction ?? 0, "N", 3)} of ${formatQuantity(most, "N", 3)}`;
  return `${of} (${formatNumber(100 * share, 2)} %)`;
}

/** The force on the first; of the body on itself, which cancels, the sum of the sizes. */
export function forceOf({ of: [first, second], force, pressed }: Touch): number {
  return first === second ? pressed : Math.hypot(...force);
}
