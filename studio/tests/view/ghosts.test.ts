import { Vector3 } from "three";
import { expect, it } from "vitest";
import type { BodyPose, Ghost } from "../../src/protocol";
import { isAsBuilt } from "../../src/view/body/asBuilt";
import { wantedGhosts } from "../../src/view/marks/askGhosts";
import { Ghosts, poseOf } from "../../src/view/marks/ghosts";

const SOURCE = {
  shapes: {
    block: { kind: "box" },
    hole: { kind: "cylinder" },
    body: { kind: "difference", of: ["block", "hole"] },
    spare: { kind: "sphere" },
  },
  parts: [{ shape: "body" }],
};

const packed = (values: Float32Array | Uint32Array) =>
  Buffer.from(values.buffer).toString("base64");

function ghost(name: string, over: Partial<Ghost> = {}): Ghost {
  return {
    name,
    vertices: packed(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0])),
    triangles: packed(new Uint32Array([0, 1, 2])),
    ...{ low: [0, 0, 0], high: [1, 1, 0], step: 0.5, clipped: "", trouble: "" },
    poses: [{ position: [0, 0, 0], rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1] }],
    ...over,
  };
}

it("draws the shape that is chosen, and those that nothing uses", () => {
  expect(wantedGhosts(SOURCE, null)).toEqual(["spare"]);
  expect(wantedGhosts(SOURCE, "hole")).toEqual(["hole", "spare"]);
  expect(wantedGhosts(SOURCE, "spare")).toEqual(["spare"]);
  expect(wantedGhosts(SOURCE, "gone")).toEqual(["spare"]);
  expect(wantedGhosts({}, "hole")).toEqual([]);
});

it("draws none over a body that has moved", () => {
  expect(isAsBuilt(null)).toBe(true);
  expect(isAsBuilt({ state: "paused", time: 0 })).toBe(true);
  expect(isAsBuilt({ state: "at-rest", time: 0 })).toBe(false);
  expect(isAsBuilt({ state: "playing", time: 0 })).toBe(false);
  expect(isAsBuilt({ state: "past", time: 0.2 })).toBe(false);
});

it("stands where the body stands that is made of it", () => {
  const turned: BodyPose = { position: [0, 0, 2], rotation: [0, -1, 0, 1, 0, 0, 0, 0, 1] };
  const at = new Vector3(1, 0, 0).applyMatrix4(poseOf(turned));
  expect(at.toArray()).toEqual([0, 1, 2]);
  // With two such bodies it stands at both places, under one name.
  const ghosts = new Ghosts();
  const [first] = ghost("hole").poses;
  ghosts.build([ghost("hole", { poses: [first!, turned] }), ghost("spare")]);
  ghosts.place(null, null, { x: 100, y: 100, ratio: 1 });
  expect(ghosts.group.children).toHaveLength(3);
  expect(ghosts.names).toEqual(["hole", "spare"]);
  expect(ghosts.labels()).toHaveLength(2);
});

it("keeps no shape without a surface, and says how coarse the others are", () => {
  const ghosts = new Ghosts();
  const none = { vertices: "", triangles: "", trouble: "has no inside" };
  ghosts.build([ghost("hole", { step: 1.234e-3, clipped: "xz" }), ghost("thin", none)]);
  ghosts.place("hole", null, { x: 100, y: 100, ratio: 1 });
  expect(ghosts.names).toEqual(["hole"]);
  const [label] = ghosts.labels();
  expect(label?.title).toContain("1.2 mm apart");
  expect(label?.title).toContain("goes on along x, z");
  // Above the middle of it.
  expect(label?.at(new Vector3()).toArray()).toEqual([0.5, 0.5, 0]);
  ghosts.build([]);
  expect(ghosts.group.children).toEqual([]);
});
