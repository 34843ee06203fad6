import { useEffect, useRef } from "react";
import { Button, Progress } from "../controls/Choice";
import type { StatEvent } from "../protocol";
import { stepFrames, togglePlay } from "../shell/actions";
import { Icon } from "../shell/icons";
import { currentEngine, send } from "../store/session";
import { useStudio } from "../store/studio";
import { stopFilm, useFilm, useHasFilm } from "./film";
import { PaceChoice } from "./PaceChoice";
import "./run.css";

/** Time: play, step, reset, rest, and the stored frames to go back to. */
export function Transport() {
  const stat = useStudio((state) => state.stat);
  const body = useStudio((state) => state.body);
  const film = useFilm((state) => state.on);
  const hasFilm = useHasFilm();
  const wanted = useRef<number | null>(null);
  const asked = useRef<number | null>(null);
  useEffect(
    () => () => {
      if (asked.current !== null) cancelAnimationFrame(asked.current);
    },
    [],
  );
  if (!body) return null;
  const still = body.not_live !== "";
  const playing = stat?.state === "playing" || film;
  const past = stat?.state === "past";
  const solving = stat?.state === "solving";
  const first = stat?.first_frame ?? 0;
  const last = stat?.last_frame ?? 0;
  // Drags move faster than answers come: only the newest requested is sent, once for each picture.
  const seek = (frame: number) => {
    stopFilm();
    wanted.current = frame;
    asked.current ??= requestAnimationFrame(() => {
      asked.current = null;
      if (wanted.current !== null) send({ t: "seek", frame: wanted.current });
      wanted.current = null;
    });
  };
  return (
    <div className="transport" role="toolbar" aria-label="Time" data-testid="transport">
      <Button
        icon
        kind="primary"
        label={
          playing
            ? "Pause (Space)"
            : still
              ? hasFilm
                ? "Show the motion that was solved (Space)"
                : body.not_live
              : "Play (Space)"
        }
        testId="play"
        disabled={solving || (still && !hasFilm)}
        onClick={togglePlay}
      >
        <Icon name={playing ? "pause" : "play"} />
      </Button>
      <Button
        icon
        kind="quiet"
        label="One frame forward (→)"
        testId="step"
        disabled={playing || solving || (still && last <= first)}
        onClick={() => stepFrames(1)}
      >
        <Icon name="step" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Back to the unloaded shape (0)"
        testId="reset"
        disabled={solving}
        onClick={() => {
          stopFilm();
          send({ t: "reset" });
        }}
      >
        <Icon name="reset" />
      </Button>
      {currentEngine()?.kind === "server" && !solving && (
        <Button
          kind="quiet"
          label={
            still
              ? "Find contact: the equilibrium under these loads, or the motion over time (R)"
              : "Solve for the equilibrium under these loads (R)"
          }
          testId="rest"
          onClick={() => send({ t: "rest" })}
        >
          <Icon name="rest" /> Solve
        </Button>
      )}
      {solving && (
        <span className="solving">
          <Button
            label="Cancel: the body stays as it is (Esc)"
            testId="cancel"
            onClick={() => send({ t: "pause" })}
          >
            Cancel
          </Button>
          <Progress label="Solving" done={stat?.progress ?? 0} total={1} />
        </span>
      )}
      <PaceChoice />
      <input
        className="scrubber"
        type="range"
        aria-label="Stored frames"
        data-testid="scrubber"
        min={first}
        max={Math.max(first, last)}
        step={1}
        value={stat?.frame ?? 0}
        disabled={last <= first}
        onChange={(event) => seek(Number(event.target.value))}
      />
      <button
        type="button"
        className={`live${playing ? " on" : ""}`}
        data-testid="live"
        aria-pressed={!past}
        title="Back to the present (L)"
        onClick={() => {
          stopFilm();
          send({ t: "live" });
        }}
      >
        <i /> LIVE
      </button>
      <output className="clock" data-testid="clock">
        {clockText(stat)}
      </output>
    </div>
  );
}

/** Time of the shown state; a state found without time has none. */
export function clockText(stat: Pick<StatEvent, "state" | "time" | "untimed"> | null): string {
  const resting = stat?.state === "at-rest";
  if (stat?.untimed || (resting && stat?.time === 0)) return resting ? "at rest" : "no time";
  return `${(stat?.time ?? 0).toFixed(3)} s`;
}
