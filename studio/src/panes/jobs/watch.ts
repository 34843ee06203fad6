// The study or calibration of the address comes back after a reload and after a restart of the
// server, and when a past one is chosen: unknown jobs are asked for. It goes when a document of
// another design is opened.
import { onAnotherDocument } from "../../store/another";
import { setJob, usePage } from "../../store/page";
import { onReady, send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { standing } from "./standing";

function ask(job: string | null): void {
  if (job !== null) send({ t: "job_show", id: job });
}

/** Called once. */
export function watchJob(): void {
  onReady(() => ask(usePage.getState().job));
  usePage.subscribe((page, before) => {
    if (page.job === before.job) return;
    const { link, jobs } = useStudio.getState();
    if (link.state === "open" && page.job !== null && !(page.job in jobs)) ask(page.job);
  });
  onAnotherDocument(() => {
    const { job } = usePage.getState();
    const { subjects, document } = useStudio.getState();
    if (job !== null && standing(subjects[job], document) === "other") setJob(null);
  });
}
