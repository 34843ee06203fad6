// The natural vibrations of the equilibrium that is shown: found on request, drawn slowly.
import { Button, Section } from "../controls/Choice";
import { formatNumber, formatQuantity } from "../controls/units";
import { currentEngine, send } from "../store/session";
import { useStudio } from "../store/studio";
import { useEquilibrium } from "./EquilibriumCard";

export function VibrationCard() {
  const equilibrium = useEquilibrium();
  const vibration = useStudio((state) => state.vibration);
  if (!equilibrium || currentEngine()?.kind !== "server") return null;
  const { topology, frame } = equilibrium;
  const found =
    vibration?.topology === topology && vibration.frame === frame ? vibration : undefined;
  return (
    <Section title="Vibrations">
      <div data-testid="vibrations">
        {!found && (
          <Button testId="find-modes" onClick={() => send({ t: "vibrate", mode: 0 })}>
            Find natural vibrations
          </Button>
        )}
        {found?.trouble && (
          <p className="bad" role="status">
            No vibrations: {found.trouble}. Try: {found.hint}.
          </p>
        )}
        {found && !found.trouble && found.frequencies.length === 0 && (
          <p className="muted" role="status">
            Looking for them…
          </p>
        )}
        {found && found.frequencies.length > 0 && (
          <>
            <div className="modes" role="group" aria-label="Natural vibrations">
              {[...found.frequencies.entries()].map(([mode, frequency]) => (
                <Button
                  key={mode}
                  kind={found.mode === mode ? "primary" : "plain"}
                  onClick={() => send({ t: "vibrate", mode: found.mode === mode ? null : mode })}
                >
                  {formatNumber(frequency ?? 0, 3)} Hz
                </Button>
              ))}
            </div>
            <p className="muted">
              {found.mode === null
                ? "Undamped, with pressures that keep their values. Press one to see it."
                : `Drawn ${pace(found.frequencies[found.mode] ?? 0, found.period)}, ` +
                  `${formatQuantity(found.amplitude, "m", 2)} to each side; press it again to stop.`}
            </p>
          </>
        )}
      </div>
    </Section>
  );
}

/** Ratio by which a swing is drawn slower or quicker than it is. */
function pace(frequency: number, period: number): string {
  const slower = frequency * period;
  return slower >= 1
    ? `${formatNumber(slower, 2)} times as slow`
    : `${formatNumber(1 / slower, 2)} times as quick`;
}
