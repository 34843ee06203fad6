// Point of the body under the pointer, in every way to show it. Hands, tapes and questions hold
// on to vertices of its surface: a hit on the smooth shape or on a tetrahedron goes to the nearest.
import type { Ray, Vector3 } from "three";
import type { Topology } from "../../engine/frames";
import type { BodyMesh } from "../body/body";
import type { SmoothMesh } from "../body/smooth";
import { type Hit, pick } from "./pick";

/** A hit on the surface, and the vertex of the drawn mesh. */
export interface Target extends Hit {
  readonly drawn: number;
}

/** Positions where the vertices of the surface are drawn. */
export interface Places {
  readonly topology: Topology;
  place(vertex: number, exaggeration: number, out?: Vector3): Vector3;
}

/** The vertex nearest to a point, of x, y, z each. */
export function nearest(vertices: Float32Array, x: number, y: number, z: number): number {
  let best = 0;
  let least = Number.POSITIVE_INFINITY;
  for (let i = 0; i < vertices.length; i += 3) {
    const far = (vertices[i]! - x) ** 2 + (vertices[i + 1]! - y) ** 2 + (vertices[i + 2]! - z) ** 2;
    if (far < least) [best, least] = [i / 3, far];
  }
  return best;
}

function vertexAt(vertices: Float32Array, i: number): [number, number, number] {
  return [vertices[3 * i]!, vertices[3 * i + 1]!, vertices[3 * i + 2]!];
}

/** Move a hit to a vertex of the surface. */
function onSurface(hit: Hit, surface: BodyMesh, rest: Float32Array): Target {
  const vertex = nearest(surface.topology.rest, ...vertexAt(rest, hit.vertex));
  return {
    ...hit,
    vertex,
    triangle: [vertex, vertex, vertex],
    weights: [1, 0, 0],
    drawn: hit.vertex,
  };
}

/** The first point of a ray on the drawn body: `mesh` at `positions`, or the smooth shape. */
export function targetOf(
  ray: Ray,
  surface: BodyMesh,
  mesh: BodyMesh,
  positions: Float32Array,
  smooth: SmoothMesh | null,
  keep: (point: Vector3) => boolean,
): Target | null {
  if (smooth) {
    const hit = pick(ray, smooth.drawn, smooth.triangles, keep);
    const target = hit && onSurface(hit, surface, smooth.vertices);
    return target && { ...target, drawn: target.vertex };
  }
  const hit = pick(ray, positions, mesh.topology.triangles, keep);
  if (!hit) return null;
  return mesh === surface
    ? { ...hit, drawn: hit.vertex }
    : onSurface(hit, surface, mesh.topology.rest);
}

/** The surface's vertices where tetrahedra are drawn: each at the nearest corner of one. */
export class TetPlaces implements Places {
  readonly topology: Topology;
  private readonly corners = new Map<number, number>();

  constructor(
    surface: BodyMesh,
    readonly tets: BodyMesh,
  ) {
    this.topology = surface.topology;
  }

  place(vertex: number, exaggeration: number, out?: Vector3): Vector3 {
    let corner = this.corners.get(vertex);
    if (corner === undefined) {
      corner = nearest(this.tets.topology.rest, ...vertexAt(this.topology.rest, vertex));
      this.corners.set(vertex, corner);
    }
    return this.tets.place(corner, exaggeration, out);
  }
}
