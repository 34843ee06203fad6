import { formatKind } from "../controls/kinds";
import { formatNumber } from "../controls/units";
import { useEquilibrium } from "../run/EquilibriumCard";
import { useStudio } from "../store/studio";
import { useOverlap } from "../view/marks/overlap";
import { showPane } from "./actions";

export function StatusLine() {
  const stat = useStudio((state) => state.stat);
  const body = useStudio((state) => state.body);
  const empty = useStudio((state) => state.document?.empty ?? false);
  const version = useStudio((state) => state.hello?.version);
  const doubts = useEquilibrium()?.warnings.length ?? 0;
  const overlaps = useOverlap() !== null;
  const running = useStudio(
    (state) => Object.values(state.jobs).filter((job) => job.state === "running").length,
  );
  return (
    <footer className="status-line" data-testid="status-line">
      <span
        className={`sentence is-${stat?.state ?? "empty"}${doubts > 0 || overlaps ? " is-doubtful" : ""}`}
        data-testid="sentence"
        aria-live="polite"
      >
        {stat?.sentence || body?.not_live || idle(stat?.state, body !== null, empty)}
      </span>
      {doubts > 0 && (
        <button
          type="button"
          className="badge warn"
          data-testid="doubts"
          onClick={() => showPane("run")}
        >
          {doubts === 1 ? "1 warning" : `${doubts} warnings`}
        </button>
      )}
      {running > 0 && (
        <span className="badge good">{running === 1 ? "1 job runs" : `${running} jobs run`}</span>
      )}
      {body && (
        <>
          <span>{body.voxels.toLocaleString("en")} voxels</span>
          <span>{body.tets.toLocaleString("en")} tets</span>
          <span>{formatKind(body.mass, "mass", 3)}</span>
        </>
      )}
      {stat && stat.state === "playing" && (
        <>
          <span>{formatNumber(stat.step_ms, 2)} ms/substep</span>
          <span>{formatNumber(stat.real_time_factor, 2)}× real time</span>
        </>
      )}
      {version && <span className="muted">VoxSoft {version}</span>}
    </footer>
  );
}

function idle(state: string | undefined, body: boolean, empty: boolean): string {
  if (empty) return "Nothing is here yet. Add a shape to begin.";
  if (!body) return "Open a design to begin.";
  if (state === "playing") return "Time runs. Drag the body to pull on it.";
  return "Ready. Space lets time run; drag the body to pull on it.";
}
