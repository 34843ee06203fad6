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
      const error = `Mean error ${formatKind(result.mean_error, "length", 3)}.`;
      toast({
        level: result.miss ? "warning" : "good",
        what: result.miss
          ? "The material is fitted, but the model misses the measured shape"
          : "The material is fitted",
        hint: result.miss || error,
        action: { label: "Show the fit", run: showFit },
      });
    }
  });
}

/** Bring the measured points and the simulated shape to the front. */
export function showFit(): void {
  showPane("overlay");
}
