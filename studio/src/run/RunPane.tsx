import { Button, Empty, Progress, Section, Select } from "../controls/Choice";
import { siUnit } from "../controls/kinds";
import { NumberField } from "../controls/NumberField";
import { formatEnergy, formatNumber, formatQuantity } from "../controls/units";
import type { BodyLoad, SolverCommand } from "../protocol";
import { currentEngine, send } from "../store/session";
import { useStudio } from "../store/studio";
import { setView, useView } from "../store/view";
import { viewport } from "../view/instance";
import { useOverlap } from "../view/marks/overlap";
import { ContactCard } from "./ContactCard";
import { EquilibriumCard, useEquilibrium } from "./EquilibriumCard";
import { GripCard } from "./GripCard";
import { VibrationCard } from "./VibrationCard";
import "./run.css";

const METHOD_TITLES: Readonly<Record<SolverCommand["method"], string>> = {
  auto: "Automatic",
  statics: "Statics (Newton)",
  xpbd: "XPBD (relaxation)",
};
const METHODS = Object.entries(METHOD_TITLES).map(([value, label]) => ({ value, label }));

/** The simulation by hand: loads, pulls, solver, and where it stands. */
export default function RunPane() {
  const body = useStudio((state) => state.body);
  if (!body) {
    return (
      <Empty title="Nothing to simulate yet">
        <p>
          Open a design. Its loads become sliders here, and the body can be pulled with the mouse.
        </p>
      </Empty>
    );
  }
  return (
    <div className="pane">
      <State />
      <GripCard />
      <ContactCard />
      <EquilibriumCard />
      <VibrationCard />
      <Section title="Loads">
        {body.loads.length === 0 && (
          <p className="muted">
            The design has no loads{body.not_live ? "." : "; pull on the body instead."}
          </p>
        )}
        {body.loads.map((load) => (
          <Load key={load.index} load={load} />
        ))}
      </Section>
      {body.not_live ? <NotLive why={body.not_live} /> : <Pulls />}
      {currentEngine()?.kind === "server" && <Solver />}
    </div>
  );
}

function State() {
  const stat = useStudio((state) => state.stat);
  const overlaps = useOverlap() !== null;
  const doubtful = (useEquilibrium()?.warnings.length ?? 0) > 0 || overlaps;
  if (!stat) return null;
  const facts: [string, string][] = [
    ["Real time", stat.state === "playing" ? `${formatNumber(stat.real_time_factor, 2)} ×` : "–"],
    ["Substep", `${formatNumber(stat.step_ms, 3)} ms`],
    ["Residual", stat.residual === null ? "–" : formatQuantity(stat.residual, "%", 2)],
    ["Elastic energy", stat.elastic === null ? "–" : formatEnergy(stat.elastic)],
    ["Kinetic energy", stat.kinetic === null ? "–" : formatEnergy(stat.kinetic)],
    ["Stored frames", `${stat.frames_stored} (${formatNumber(stat.bytes_stored / 1e6, 3)} MB)`],
  ];
  return (
    <Section title="State">
      <p className={`run-sentence is-${stat.state}${doubtful ? " is-doubtful" : ""}`}>
        {stat.sentence}
      </p>
      {stat.progress !== null && <Progress label="Solving" done={stat.progress} total={1} />}
      <dl className="facts">
        {facts.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
    </Section>
  );
}

function Load(props: { load: BodyLoad }) {
  const { load } = props;
  const value = useStudio((state) => state.stat?.loads[load.index] ?? load.value);
  return (
    <NumberField
      label={load.label}
      title={`${load.kind}; the design says ${formatNumber(load.value / load.factor, 4)} ${load.unit}`}
      value={value}
      unit={siUnit(load.quantity)}
      min={load.min}
      max={load.max}
      fallback={load.value}
      slider
      stacked
      onChange={(next) => send({ t: "load", index: load.index, value: next })}
    />
  );
}

function NotLive(props: { why: string }) {
  return (
    <Section title="Live motion">
      <p className="muted" data-testid="not-live-note">
        {props.why} What is solved over time is kept as frames, which Play shows again.
      </p>
    </Section>
  );
}

function Pulls() {
  const stiffness = useView((view) => view.stiffness);
  const grabs = useStudio((state) => state.stat?.grabs);
  return (
    <Section title="Pulling by hand">
      <NumberField
        label="Spring"
        value={stiffness}
        unit="N/m"
        min={1}
        max={1000}
        slider
        fallback={50}
        onChange={(value) => setView({ stiffness: Math.max(value, 1e-6) })}
      />
      {!grabs?.length && (
        <p className="muted">
          Press on the body and drag. Hold Shift when letting go to leave the spring pinned.
        </p>
      )}
      {grabs?.map((grab) => (
        <div key={grab.id} className="facts-row" data-testid="grab">
          <span>Vertex {grab.vertex}</span>
          <span>
            {formatNumber(Math.hypot(...grab.force), 3)} N{" "}
            <Button kind="quiet" onClick={() => viewport().grabs.release(grab.id)}>
              Release
            </Button>
          </span>
        </div>
      ))}
    </Section>
  );
}

function Solver() {
  const solver = useStudio((state) => state.stat?.solver ?? "auto");
  const solving = useStudio((state) => state.stat?.state === "solving");
  const still = useStudio((state) => (state.body?.not_live ?? "") !== "");
  // XPBD would go through objects that the body touches.
  const methods = still ? METHODS.filter(({ value }) => value !== "xpbd") : METHODS;
  return (
    <Section title={still ? "Solution" : "Equilibrium"}>
      <Select
        label="Solver"
        value={solver}
        options={methods}
        onChange={(method) => send({ t: "solver", method: method as SolverCommand["method"] })}
      />
      <div className="run-buttons">
        {solving ? (
          <Button kind="primary" onClick={() => send({ t: "pause" })}>
            Cancel
          </Button>
        ) : (
          <Button kind="primary" onClick={() => send({ t: "rest" })}>
            Solve
          </Button>
        )}
        <Button onClick={() => send({ t: "keep" })}>Keep as a run</Button>
      </div>
    </Section>
  );
}
