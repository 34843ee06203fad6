// The view keeps showing the body of the design, unloaded: a fit that is done is told with the way
// to the picture of it.
import { formatKind } from "../../controls/kinds";
import { showPane } from "../../shell/actions";
import { toast, useStudio } from "../../store/studio";

/** Called once. */
export function tellFits(): void {
  useStudio.subscribe((now, before) => {
    if (now.calibrated === before.calibrated) return;
    for (const [id, result] of Object.entries(now.calibrated)) {
      // A past one that is opened is no news: only one that ran until now is.
      if (id in before.calibrated || now.jobs[id]?.state !== "running") continue;
      toast({
        level: "good",
        what: "The material is fitted",
        hint: `Mean error ${formatKind(result.mean_error, "length", 3)}.`,
        action: { label: "Show the fit", run: showFit },
      });
    }
  });
}

/** Bring the measured points and the simulated shape to the front. */
export function showFit(): void {
  showPane("overlay");
}
