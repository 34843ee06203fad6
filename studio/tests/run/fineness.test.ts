import { describe, expect, it } from "vitest";
import type { EquilibriumEvent } from "../../src/protocol";
import { inWords, rated, verdict } from "../../src/run/fineness";

const moved = (name: string, share: number | null) => ({
  name,
  displacement: [0, 0, 1] as [number, number, number],
  estimate: "",
  share,
});

function found(...shares: (number | null)[]): EquilibriumEvent {
  return {
    probes: shares.map((share, i) => moved(`p${i}`, share)),
    metrics: [],
    chambers: [],
  } as unknown as EquilibriumEvent;
}

describe("fineness of a mesh", () => {
  it("parts the numbers at 2 % and at 5 %, the largest error first", () => {
    const rating = rated(found(0.02, 0.021, 0.05, 0.051, 0.3, null));
    expect(inWords(rating.small)).toBe("probe p0 2 %");
    expect(inWords(rating.fair)).toBe("probe p2 5 %, probe p1 2.1 %");
    expect(inWords(rating.beyond)).toBe("probe p4 30 %, probe p3 5.1 %");
    expect(rating.unknown).toEqual(["probe p5", "largest strain"]);
  });

  it("answers with the worst number", () => {
    expect(verdict(rated(found(0.01)))?.tone).toBe("good");
    expect(verdict(rated(found(0.01, 0.03)))?.tone).toBe("warn");
    expect(verdict(rated(found(0.01, 0.06)))?.words).toBe(
      "No: 1 of 2 numbers may be more than 5 % off.",
    );
    expect(verdict(rated(found(0.06, 0.07)))?.words).toBe(
      "No: every number may be more than 5 % off.",
    );
  });

  it("leaves out numbers that are zero up to rounding", () => {
    const metric = { name: "reaction", kind: "force", estimate: "", share: 1.5 };
    const some = { ...found(0.01), metrics: [{ ...metric, value: 8e-11 }] };
    expect(rated(some).beyond).toEqual([]);
    expect(rated({ ...some, metrics: [{ ...metric, value: 0.1 }] }).beyond).toHaveLength(1);
  });

  it("has no answer where no error is known", () => {
    expect(verdict(rated(found(null)))).toBeNull();
  });
});
