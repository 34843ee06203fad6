import { Vector3 } from "three";
import { expect, it } from "vitest";
import type { Places } from "../../src/view/hands/target";
import { placeNow } from "../../src/view/marks/attachments";

const rest = new Float32Array([0, 0, 0, 2, 0, 0]);

/** Two vertices, of which the second has moved up by 1. */
const mesh = (tets: boolean) =>
  ({
    topology: { rest, tets },
    place: (vertex: number, exaggeration: number, out = new Vector3()) =>
      out.set(rest[3 * vertex] ?? 0, 0, vertex * exaggeration),
  }) as unknown as Places;

it("moves an end as its vertices are on the mean, and leaves a fixed one where it is", () => {
  const end = { center: [1, 5, 0] as [number, number, number], vertices: [0, 1] };
  expect(placeNow(end, mesh(false), 1).toArray()).toEqual([1, 5, 0.5]);
  expect(placeNow(end, mesh(false), 4).toArray()).toEqual([1, 5, 2]);
  expect(placeNow({ ...end, vertices: [] }, mesh(false), 1).toArray()).toEqual([1, 5, 0]);
  // Shrunk tetrahedra have other vertices.
  expect(placeNow(end, mesh(true), 1).toArray()).toEqual([1, 5, 0]);
});
