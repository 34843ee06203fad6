// Start of a job: once for each press or double click, and shown as soon as it is known.
import { useCallback, useEffect, useRef, useState } from "react";
import type { JobEvent, JobStartCommand } from "../../protocol";
import { setJob } from "../../store/page";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { jobsOf } from "./current";

/** Time after which a start that came to nothing, as one that was refused, may be tried again, ms. */
const PATIENCE = 3000;

export interface Start {
  /** True from the press until the job is known. */
  readonly starting: boolean;
  start(spec: JobStartCommand["spec"]): void;
}

/** Start jobs of a kind; presses while one starts do nothing. */
export function useStart(kind: JobEvent["kind"]): Start {
  const jobs = useStudio((state) => state.jobs);
  const [starting, setStarting] = useState(false);
  // Known jobs at the press; null where no start is awaited.
  const before = useRef<ReadonlySet<string> | null>(null);
  const end = useCallback(() => {
    before.current = null;
    setStarting(false);
  }, []);
  useEffect(() => {
    if (before.current === null) return;
    const fresh = jobsOf(jobs, kind).find((job) => !before.current?.has(job.id));
    if (!fresh) return;
    end();
    setJob(fresh.id);
  }, [jobs, kind, end]);
  useEffect(() => {
    if (!starting) return;
    // An effect apart, as news of other jobs must not restart the time.
    const timer = setTimeout(end, PATIENCE);
    return () => clearTimeout(timer);
  }, [starting, end]);
  return {
    starting,
    start(spec) {
      if (before.current !== null) return;
      before.current = new Set(Object.keys(useStudio.getState().jobs));
      setStarting(true);
      if (send({ t: "job_start", spec }) === 0) end();
    },
  };
}
