import { Button, Section } from "../controls/Choice";
import { formatKind, siUnit } from "../controls/kinds";
import { cleaned, formatNumber, formatQuantity } from "../controls/units";
import { Findings } from "../panes/body/Findings";
import type { EquilibriumEvent } from "../protocol";
import { send } from "../store/session";
import { useStudio } from "../store/studio";
import { FinenessCheck } from "./FinenessCheck";

/** The numbers of the state that is shown, or null where it is no equilibrium, or not yet told. */
export function useEquilibrium(): EquilibriumEvent | null {
  return useStudio(({ equilibrium, stat }) =>
    equilibrium !== null &&
    stat?.state === "at-rest" &&
    stat.topology === equilibrium.topology &&
    stat.frame === equilibrium.frame
      ? equilibrium
      : null,
  );
}

/** Values of the equilibrium that is shown: probes, metrics, chambers, and doubtful points. */
export function EquilibriumCard() {
  const found = useEquilibrium();
  if (!found) return null;
  const facts: [string, string, string][] = [
    ...found.probes.map((probe): [string, string, string] => [
      `Probe ${probe.name}`,
      moved(probe),
      probe.estimate,
    ]),
    ...found.metrics.map(({ name, value, kind, estimate }): [string, string, string] => {
      const shown = value === null ? null : cleaned(value, siUnit(kind));
      return [name.replaceAll("_", " "), formatKind(shown, kind), shown === 0 ? "" : estimate];
    }),
    ...found.tendons.map(({ name, words, estimate }): [string, string, string] => [
      `Tendon ${name}`,
      words,
      estimate,
    ]),
    ...found.reactions.map(({ name, words, estimate }): [string, string, string] => [
      `Reaction of ${name}`,
      words,
      estimate,
    ]),
    ...found.supplies.map(({ name, words, estimate }): [string, string, string] => [
      `Supply ${name}`,
      words,
      estimate,
    ]),
    ["Largest strain", `${formatNumber(100 * found.largest_strain, 3)} %`, ""],
    ["Out of balance", `${found.residual} of the load`, ""],
  ];
  return (
    <Section title="Result">
      <div data-testid="equilibrium">
        {found.missing && (
          <p className="run-sentence is-doubtful" data-testid="missing">
            {found.missing}{" "}
            <Button testId="solve-again" onClick={() => send({ t: "rest" })}>
              Solve again
            </Button>
          </p>
        )}
        <Findings findings={found.warnings} />
        <dl className="facts">
          {facts.map(([name, value, estimate]) => (
            <div key={name}>
              <dt>{name}</dt>
              <dd>
                {value}
                <Estimate words={estimate} />
              </dd>
            </div>
          ))}
          {found.chambers.map((chamber) => (
            <div key={chamber.name}>
              <dt>{chamber.name.charAt(0).toUpperCase() + chamber.name.slice(1)}</dt>
              <dd>
                {formatQuantity(chamber.pressure, "Pa", 4)}, {formatQuantity(chamber.volume, "m^3")}{" "}
                <span className="muted">
                  (unloaded {formatQuantity(chamber.rest_volume, "m^3")})
                </span>
                <Estimate words={chamber.estimate} />
              </dd>
            </div>
          ))}
        </dl>
        {found.error_bars && (
          <p className="muted" data-testid="error-bars">
            {found.error_bars}
          </p>
        )}
        <FinenessCheck of={found} />
      </div>
    </Section>
  );
}

/** Limit of a number on ever smaller voxels, with its error, on a line of its own. */
function Estimate({ words }: { words: string }) {
  return words === "" ? null : (
    <span className="estimate" title="On ever smaller voxels, with its discretization error">
      {words}
    </span>
  );
}

function moved(probe: EquilibriumEvent["probes"][number]): string {
  const total = Math.hypot(...probe.displacement);
  // A rounding error beside the whole is no motion.
  const clean = (x: number) => (Math.abs(x) < 1e-6 * total ? 0 : x);
  const parts = probe.displacement.map((x) => formatNumber(1000 * clean(x), 3)).join(", ");
  return `${formatQuantity(total, "m", 4)} (${parts} mm)`;
}
