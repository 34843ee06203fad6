import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { AnyEvent, GenerationEvent, TrialEvent } from "../../src/protocol";
import { gathering } from "../../src/store/gather";
import { applyAll, useStudio } from "../../src/store/studio";

function trial(index: number, job = "s"): TrialEvent {
  return {
    t: "trial",
    job,
    index,
    parameters: { wall: 0.01 },
    objectives: { rise: index },
    metrics: {},
    status: "ok",
    seconds: 0,
    feasible: true,
    message: "",
    front: false,
  };
}

function generation(index: number, error: number): GenerationEvent {
  return { t: "generation", job: "c", index, error, best: 1, mean: 1, spread: {}, parameters: {} };
}

describe("gathering", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  function listening() {
    const told: string[] = [];
    const take = gathering(
      (event) => told.push(event.t),
      (events) => told.push(`${events.length} at once`),
    );
    return { told, take };
  }

  it("takes many trials up at once, and soon", () => {
    const { told, take } = listening();
    for (let i = 0; i < 500; i++) take(trial(i));
    expect(told).toEqual([]);
    vi.advanceTimersByTime(200);
    expect(told).toEqual(["500 at once"]);
    take(trial(500));
    vi.advanceTimersByTime(200);
    expect(told).toEqual(["500 at once", "1 at once"]);
  });
  it("keeps the order where an event refers to earlier ones", () => {
    const { told, take } = listening();
    take(trial(0));
    take({ t: "job", state: "running" } as AnyEvent);
    take(trial(1));
    take({ t: "job", state: "done" } as AnyEvent);
    take({ t: "trials" } as AnyEvent);
    vi.advanceTimersByTime(1000);
    expect(told).toEqual(["job", "2 at once", "job", "trials"]);
  });
});

describe("applyAll", () => {
  beforeEach(() => useStudio.setState({ trials: {}, generations: {}, jobs: {} }));

  it("draws once, keeps studies apart, and replaces old events by those sent again", () => {
    let drawn = 0;
    const stop = useStudio.subscribe(() => void drawn++);
    applyAll([trial(0), trial(1), trial(0, "other")]);
    stop();
    expect(drawn).toBe(1);
    applyAll([{ ...trial(0), status: "diverged" }]);
    const { trials } = useStudio.getState();
    expect(trials.s?.trials.map((one) => [one.index, one.status])).toEqual([
      [1, "ok"],
      [0, "diverged"],
    ]);
    expect(trials.other?.trials).toHaveLength(1);
  });
  it("forgets the generations after one that is told again", () => {
    applyAll([generation(0, 3), generation(1, 2), generation(2, 1)]);
    applyAll([generation(1, 5)]);
    const known = useStudio.getState().generations.c ?? [];
    expect(known.map((one) => one.error)).toEqual([3, 5]);
  });
});
