import { beforeEach, expect, it, vi } from "vitest";
import { tellFits } from "../../src/panes/calibrate/tell";
import type { CalibratedEvent, JobEvent } from "../../src/protocol";
import { provideDock } from "../../src/shell/actions";
import { apply, useStudio } from "../../src/store/studio";

const job = (id: string, state: JobEvent["state"]) =>
  ({ t: "job", id, kind: "calibrate", state }) as JobEvent;
const fitted = (id: string) =>
  ({ t: "calibrated", job: id, mean_error: 0.0012 }) as CalibratedEvent;

tellFits();
beforeEach(() => useStudio.setState({ toasts: [], jobs: {}, calibrated: {} }));

it("tells of a fit that ran until now, with the way to its picture", () => {
  const show = vi.fn();
  provideDock({ panes: [], show, reset: () => {} });
  apply(job("beam", "running"));
  apply(fitted("beam"));
  const [told] = useStudio.getState().toasts;
  expect(told).toMatchObject({ level: "good", hint: "Mean error 1.2 mm." });
  told?.action?.run();
  expect(show).toHaveBeenCalledWith("overlay");
});

it("does not tell of a past fit that is opened", () => {
  apply(job("beam", "done"));
  apply(fitted("beam"));
  expect(useStudio.getState().toasts).toEqual([]);
});
