// The study that the panes speak of.
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import type { JobEvent, TrialsEvent } from "../../protocol";
import { usePage } from "../../store/page";
import { useStudio } from "../../store/studio";
import { standing } from "../jobs/standing";
import { attend } from "./selection";
import { type Axis, axesOf, frontOf } from "./trials";

export interface CurrentStudy {
  readonly id: string;
  readonly job: JobEvent | null;
  readonly study: TrialsEvent;
  readonly axes: readonly Axis[];
  readonly front: ReadonlySet<number>;
}

/** All jobs of a kind, oldest first. */
export function jobsOf(
  jobs: Readonly<Record<string, JobEvent>>,
  kind: JobEvent["kind"],
): readonly JobEvent[] {
  return Object.values(jobs).filter((job) => job.kind === kind);
}

/** Tells of each job if it is of the open document. */
export function useIsOwn(): (job: string) => boolean {
  const subjects = useStudio((state) => state.subjects);
  const document = useStudio((state) => state.document);
  return useCallback(
    (job: string) => standing(subjects[job], document) !== "other",
    [subjects, document],
  );
}

/** The chosen job of a kind, or else the newest one of the open document. */
export function useJob(kind: JobEvent["kind"]): JobEvent | null {
  const chosen = usePage((page) => page.job);
  const jobs = useStudio((state) => state.jobs);
  const isOwn = useIsOwn();
  return useMemo(() => {
    const job = chosen === null ? undefined : jobs[chosen];
    if (job?.kind === kind) return job;
    return jobsOf(jobs, kind).findLast(({ id }) => isOwn(id)) ?? null;
  }, [chosen, jobs, kind, isOwn]);
}

const LIVE: ReadonlySet<JobEvent["state"]> = new Set(["running", "pausing", "paused", "stopping"]);

/** Jobs of a kind that are at work for other designs than the open one. */
export function useElsewhere(kind: JobEvent["kind"]): readonly JobEvent[] {
  const jobs = useStudio((state) => state.jobs);
  const isOwn = useIsOwn();
  return useMemo(
    () => jobsOf(jobs, kind).filter(({ id, state }) => LIVE.has(state) && !isOwn(id)),
    [jobs, kind, isOwn],
  );
}

/** Shortest time between two pictures of a study that runs, ms; longer where it has many trials. */
const CALM = 150;

/** A study as it was lately: quick trials would have the plots drawn more often than is seen. */
function useCalm(study: TrialsEvent | undefined): TrialsEvent | undefined {
  const [shown, show] = useState(study);
  const latest = useRef(study);
  const timer = useRef<ReturnType<typeof setTimeout> | null>(null);
  latest.current = study;
  useEffect(() => {
    if (study === shown || timer.current !== null) return;
    const pause = study?.job === shown?.job ? CALM + (study?.trials.length ?? 0) : 0;
    timer.current = setTimeout(() => {
      timer.current = null;
      show(latest.current);
    }, pause);
  }, [study, shown]);
  useEffect(
    () => () => {
      if (timer.current !== null) clearTimeout(timer.current);
      timer.current = null;
    },
    [],
  );
  return shown?.job === study?.job ? shown : study;
}

/** The trials of the chosen study, of one that runs, or of a past one that was opened. */
export function useStudy(): CurrentStudy | null {
  const chosen = usePage((page) => page.job);
  const job = useJob("study");
  const all = useStudio((state) => state.trials);
  const isOwn = useIsOwn();
  const newest = job?.id ?? Object.keys(all).findLast(isOwn) ?? null;
  const id = chosen !== null && all[chosen] ? chosen : newest;
  const study = useCalm(id === null ? undefined : all[id]);
  const found = useMemo(
    () => (study ? { axes: axesOf(study), front: frontOf(study) } : null),
    [study],
  );
  useEffect(() => {
    if (id !== null) attend(id);
  }, [id]);
  return useMemo(
    () =>
      id !== null && study && found
        ? { id, job: job?.id === id ? job : null, study, ...found }
        : null,
    [id, job, study, found],
  );
}
