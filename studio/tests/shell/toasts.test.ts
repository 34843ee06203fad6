import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { toastPlace } from "../../src/shell/toastPlace";
import { apply, toast, useStudio } from "../../src/store/studio";

describe("messages", () => {
  beforeEach(() => {
    vi.useFakeTimers();
    useStudio.setState({ toasts: [], log: [] });
  });
  afterEach(() => vi.useRealTimers());

  const error = {
    t: "error",
    seq: 0,
    where: "parts[0]",
    what: "is thin",
    hint: "thicken",
  } as const;

  it("go away by themselves, errors later than others and not from the log", () => {
    apply(error);
    toast({ level: "good", what: "Saved", hint: "" });
    expect(useStudio.getState().toasts).toHaveLength(2);
    vi.advanceTimersByTime(6_000);
    expect(useStudio.getState().toasts.map((one) => one.level)).toEqual(["error"]);
    vi.runAllTimers();
    expect(useStudio.getState().toasts).toEqual([]);
    expect(useStudio.getState().log).toMatchObject([
      { level: "error", text: "parts[0]: is thin · thicken" },
    ]);
  });

  it("give way to a newer one about the same", () => {
    for (const what of ["Clamp", "Layer"]) {
      toast({ level: "good", what, hint: "", about: "design" });
    }
    toast({ level: "good", what: "Saved", hint: "" });
    expect(useStudio.getState().toasts.map((one) => one.what)).toEqual(["Layer", "Saved"]);
  });

  it("are kept in the log as well where the page itself tells of an error", () => {
    toast({ level: "error", what: "No picture was made", hint: "" });
    expect(useStudio.getState().log).toMatchObject([{ text: "No picture was made" }]);
  });
});

describe("the place of messages", () => {
  const stage = { left: 300, right: 1200, bottom: 600 };
  const cube = { left: 1114, right: 1166, bottom: 566 };

  it("is the middle of the picture, above things at its bottom", () => {
    expect(toastPlace(stage, null, cube, 900)).toEqual({ left: 490, width: 520, bottom: 340 });
  });
  it("is beside the card of a vertex and the cube", () => {
    const card = { left: 312, right: 572, bottom: 560 };
    const place = toastPlace(stage, card, cube, 900)!;
    expect(place.left).toBeGreaterThan(card.right);
    expect(place.left + place.width).toBeLessThan(cube.left);
  });
  it("is none in a picture that is too narrow for words", () => {
    expect(toastPlace({ left: 0, right: 180, bottom: 600 }, null, null, 900)).toBeNull();
  });
});
