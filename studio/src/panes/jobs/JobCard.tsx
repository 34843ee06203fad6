// A job that runs, waits or is done: how far it is, and the buttons that hold it or end it.
import { Button, Progress } from "../../controls/Choice";
import { formatSpan } from "../../controls/units";
import type { JobEvent } from "../../protocol";
import { Icon } from "../../shell/icons";
import { send } from "../../store/session";
import { Glyph } from "../design/fields/Glyph";
import { RecipeButtons } from "./Recipe";
import "./jobs.css";

const WORDS: Readonly<Record<JobEvent["state"], string>> = {
  running: "running",
  pausing: "pausing",
  paused: "paused",
  stopping: "stopping",
  stopped: "stopped",
  done: "done",
  failed: "failed",
  interrupted: "interrupted",
};

const TONES: Readonly<Record<JobEvent["state"], string>> = {
  running: "good",
  pausing: "warn",
  paused: "warn",
  stopping: "warn",
  stopped: "warn",
  done: "good",
  failed: "bad",
  interrupted: "warn",
};

export function JobCard(props: { job: JobEvent }) {
  const { job } = props;
  const held = job.state === "pausing" || job.state === "paused";
  const live = job.state === "running" || held || job.state === "stopping";
  const ended = job.state === "stopped" || job.state === "interrupted" || job.state === "failed";
  // Only a study has a journal from which it goes on; other work gives the same again.
  const again = ended && job.kind !== "study" ? "Start again" : "Go on";
  return (
    <div className="job" data-testid={`job-${job.kind}`} data-state={job.state}>
      <div className="job-head">
        <strong>{job.name || job.kind}</strong>
        <span className={`badge ${TONES[job.state]}`}>{WORDS[job.state]}</span>
        <span className="job-buttons">
          {job.state === "running" && (
            <Button icon label="Pause" onClick={() => send({ t: "job_pause", id: job.id })}>
              <Icon name="pause" />
            </Button>
          )}
          {(ended || held) && (
            <Button icon label={again} onClick={() => send({ t: "job_resume", id: job.id })}>
              <Icon name="play" />
            </Button>
          )}
          {live && (
            <Button
              icon
              label="Stop; finished work is kept"
              disabled={job.state === "stopping"}
              onClick={() => send({ t: "job_stop", id: job.id })}
            >
              <Glyph name="stop" />
            </Button>
          )}
        </span>
      </div>
      <Progress label={`Progress of ${job.name || job.kind}`} done={job.done} total={job.total} />
      <div className="job-line" aria-live="polite">
        <span>{job.total > 0 ? `${job.done} of ${job.total} ${job.of}` : "getting ready"}</span>
        <span>
          {formatSpan(job.elapsed)}
          {job.state === "running" && job.left !== null && `, about ${formatSpan(job.left)} left`}
        </span>
      </div>
      {job.stage && live && <p className="muted">{job.stage}</p>}
      {job.best && live && (
        <p>
          <span className="muted">best</span> {job.best}
        </p>
      )}
      {job.message && <p className={job.state === "failed" ? "bad" : "muted"}>{job.message}</p>}
      <RecipeButtons job={job.id} />
    </div>
  );
}
