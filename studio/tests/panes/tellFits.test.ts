import { beforeEach, expect, it, vi } from "vitest";
import { badgeOf } from "../../src/panes/calibrate/Result";
import { tellFits } from "../../src/panes/calibrate/tell";
import type { CalibratedEvent, JobEvent } from "../../src/protocol";
import { provideDock } from "../../src/shell/actions";
import { apply, useStudio } from "../../src/store/studio";

const job = (id: string, state: JobEvent["state"]) =>
  ({ t: "job", id, kind: "calibrate", state }) as JobEvent;
const fitted = (id: string, miss = "") =>
  ({ t: "calibrated", job: id, mean_error: 0.0012, miss }) as CalibratedEvent;

tellFits();
beforeEach(() => useStudio.setState({ toasts: [], jobs: {}, calibrated: {} }));

it("tells of a fit that ran until now, with the way to its picture", () => {
  const show = vi.fn();
  provideDock({ panes: [], show, front: () => [], reset: () => {} });
  apply(job("beam", "running"));
  apply(fitted("beam"));
  const [told] = useStudio.getState().toasts;
  expect(told).toMatchObject({ level: "good", hint: "Mean error 1.2 mm." });
  told?.action?.run();
  expect(show).toHaveBeenCalledWith("overlay", undefined);
});

it("does not tell of a past fit that is opened", () => {
  apply(job("beam", "done"));
  apply(fitted("beam"));
  expect(useStudio.getState().toasts).toEqual([]);
});

it("tells of a model that misses the measured shape in amber, with the place", () => {
  apply(job("beam", "running"));
  apply(fitted("beam", "beam.csv: the model misses by up to 10 mm at arc 90 mm."));
  const [told] = useStudio.getState().toasts;
  expect(told?.level).toBe("warning");
  expect(told?.what).toContain("misses");
  expect(told?.hint).toContain("arc 90 mm");
});

it("calls no constant determined by a model that misses", () => {
  expect(badgeOf(true, "")).toEqual(["good", "determined"]);
  expect(badgeOf(true, "a.csv: misses")[0]).toBe("warn");
  expect(badgeOf(false, "")[0]).toBe("warn");
});
