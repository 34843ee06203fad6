// The calibration that the panes speak of: one that runs, or a past one that was opened.
import { useMemo } from "react";
import type { CalibratedEvent, GenerationEvent, JobEvent, OverlayEvent } from "../../protocol";
import { usePage } from "../../store/page";
import { useStudio } from "../../store/studio";
import { useIsOwn, useJob } from "../study/current";

export interface CurrentCalibration {
  readonly id: string;
  readonly job: JobEvent | null;
  readonly generations: readonly GenerationEvent[];
  readonly overlay: OverlayEvent | null;
  readonly result: CalibratedEvent | null;
}

const NONE: readonly GenerationEvent[] = [];

export function useCalibration(): CurrentCalibration | null {
  const chosen = usePage((page) => page.job);
  const job = useJob("calibrate");
  const generations = useStudio((state) => state.generations);
  const overlays = useStudio((state) => state.overlays);
  const results = useStudio((state) => state.calibrated);
  const isOwn = useIsOwn();
  return useMemo(() => {
    const known = (id: string) => id in generations || id in overlays || id in results;
    const newest = () =>
      Object.keys(results).findLast(isOwn) ?? Object.keys(overlays).findLast(isOwn) ?? null;
    const id = chosen !== null && known(chosen) ? chosen : (job?.id ?? newest());
    if (id === null) return null;
    return {
      id,
      job: job?.id === id ? job : null,
      generations: generations[id] ?? NONE,
      overlay: overlays[id] ?? null,
      result: results[id] ?? null,
    };
  }, [chosen, job, generations, overlays, results, isOwn]);
}
