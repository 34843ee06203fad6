import { Box3, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { extent, kept, turned } from "../../src/view/body/section";

const box = new Box3(new Vector3(0, -1, 0), new Vector3(4, 1, 3));

describe("a section plane", () => {
  it("goes from one end of the body to the other, in any direction", () => {
    expect(extent(box, new Vector3(1, 0, 0))).toEqual([0, 4]);
    expect(extent(box, new Vector3(0, -1, 0))).toEqual([-1, 1]);
    const [low, high] = extent(box, new Vector3(0.6, 0, 0.8));
    expect([low, high]).toEqual([expect.closeTo(0), expect.closeTo(4.8)]);
  });

  it("snaps to an axis near by, and stays turned elsewhere", () => {
    const near = turned(new Vector3(0, 0, -1), new Vector3(1, 0, 0), 0.1);
    expect(kept(near, true)).toMatchObject({ section: "z", sectionFlipped: true });
    expect(kept(near, false).section).toBe("free");
    const far = turned(new Vector3(1, 0, 0), new Vector3(0, 0, 1), 0.5);
    const { section, sectionNormal } = kept(far, true);
    expect(section).toBe("free");
    expect(sectionNormal[1]).toBeCloseTo(Math.sin(0.5));
  });
});
