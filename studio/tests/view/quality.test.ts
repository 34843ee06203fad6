import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { StatEvent } from "../../src/protocol";
import { calmed } from "../../src/store/calm";
import { Ladder, ladder, WHOLE } from "../../src/view/drawing/quality";

const hear = (one: Ladder, ...times: number[]) => {
  for (const time of times) one.took(time);
};

describe("Ladder", () => {
  it("leaves pictures whole where they are quick", () => {
    const one = new Ladder();
    hear(one, 5, 300, 5, 20, 30, 20);
    expect(one.quality).toBe(WHOLE);
    expect(one.slow).toBe(false);
  });

  it("leaves more out the longer pictures take, and ends with half the pixels along a side", () => {
    const one = new Ladder();
    hear(one, 50, 50, 50);
    expect(one.quality).toEqual({ smooth: false, share: 1 });
    hear(one, 150, 150, 150);
    expect(one.quality).toEqual({ smooth: false, share: 0.5 });
    hear(one, 900, 900, 900);
    expect(one.quality.share).toBe(0.5);
  });

  it("goes far down at once where a picture takes very long", () => {
    const one = new Ladder();
    hear(one, 400, 400, 400);
    expect(one.quality.share).toBe(0.5);
  });

  it("finds the way back once pictures are quick again", () => {
    const one = new Ladder();
    hear(one, 400, 400, 400);
    for (let n = 0; n < 3; n++) hear(one, 4, 4, 4);
    expect(one.quality).toBe(WHOLE);
  });

  it("stays where pictures are neither slow nor quick", () => {
    const one = new Ladder();
    hear(one, 50, 50, 50);
    hear(one, 20, 20, 20);
    expect(one.quality).toEqual({ smooth: false, share: 1 });
  });
});

describe("calmed", () => {
  beforeEach(() => {
    vi.useFakeTimers();
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.restoreAllMocks();
  });
  const stat = (state: StatEvent["state"], time: number) => ({ state, time }) as StatEvent;

  it("passes everything on where pictures are quick", () => {
    const tell = vi.fn();
    const hearing = calmed(tell);
    for (let n = 0; n < 5; n++) hearing(stat("playing", n));
    expect(tell).toHaveBeenCalledTimes(5);
  });

  it("tells only the newest after a while where they are slow", () => {
    vi.spyOn(ladder, "slow", "get").mockReturnValue(true);
    const tell = vi.fn();
    const hearing = calmed(tell);
    for (let n = 0; n < 5; n++) hearing(stat("playing", n));
    expect(tell.mock.calls).toEqual([[stat("playing", 0)]]);
    vi.runAllTimers();
    expect(tell.mock.calls).toEqual([[stat("playing", 0)], [stat("playing", 4)]]);
  });

  it("tells a change of state at once, and nothing older after it", () => {
    vi.spyOn(ladder, "slow", "get").mockReturnValue(true);
    const tell = vi.fn();
    const hearing = calmed(tell);
    hearing(stat("playing", 0));
    hearing(stat("playing", 1));
    hearing(stat("at-rest", 2));
    expect(tell).toHaveBeenLastCalledWith(stat("at-rest", 2));
    vi.runAllTimers();
    expect(tell).toHaveBeenCalledTimes(2);
  });
});
