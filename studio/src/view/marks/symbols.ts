// Clamps, layers, loads and probes: marks on the body, and words that can be clicked.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineLoop,
  Mesh,
  MeshBasicMaterial,
  Points,
  PointsMaterial,
  Vector3,
} from "three";
import { cavityName } from "../../controls/cavities";
import { formatNumber, formatQuantity, unitText } from "../../controls/units";
import type { BodyEvent, BodyLoad, BodyPlane, StatEvent } from "../../protocol";
import { showPane } from "../../shell/actions";
import { type BodyMesh, CAVITY_COLORS } from "../body/body";
import { LAYER_COLOR } from "../body/membranes";
import type { Label } from "./labels";

const CLAMP_COLOR = "#98a1ab";
const LOAD_COLOR = "#e8704a";
const PLANE_COLOR = "#b48ead";
/** Margin of a drawn plane of symmetry beyond the body, as a part of its size. */
const BEYOND = 0.08;
const PROBE_COLOR = "#56b4e9";

/** The value of a load as text, at present. */
export function loadText(load: BodyLoad, stat: StatEvent | null): string {
  const value = stat?.loads[load.index] ?? load.value;
  return `${formatNumber(value / load.factor, 3)} ${unitText(load.unit)}`.trim();
}

/** The mean of drawn vertices where they are now, if they are drawn. */
function meanPlace(
  vertices: readonly number[],
  mesh: BodyMesh | null,
  exaggeration: number,
): [number, number, number] | null {
  if (!mesh || mesh.topology.tets || vertices.length === 0) return null;
  const sum = new Vector3();
  const one = new Vector3();
  for (const vertex of vertices) sum.add(mesh.place(vertex, exaggeration, one));
  return sum.divideScalar(vertices.length).toArray();
}

/**
 * Tip of a load's arrow: at the place that it pushes on, or so far out of a place that
 * it pulls on that the whole arrow stands outside of the body, where it is seen.
 */
export function arrowTip(
  at: Vector3,
  direction: Vector3,
  middle: Vector3,
  length: number,
): Vector3 {
  const pulls = at.clone().sub(middle).dot(direction) > 0;
  return pulls ? at.clone().addScaledVector(direction, length) : at;
}

/** The corners of a plane of symmetry around the body, in turn. */
export function planeCorners(
  plane: BodyPlane,
  bounds: BodyEvent["bounds"],
): [number, number, number][] {
  const [low, high] = bounds;
  const size = Math.hypot(...high.map((x, axis) => x - (low[axis] ?? 0)));
  const [first, second] = [0, 1, 2].filter((axis) => axis !== plane.axis) as [number, number];
  const ends = (axis: number) => [low[axis]! - BEYOND * size, high[axis]! + BEYOND * size];
  return [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ].map(([i, j]) => {
    const corner: [number, number, number] = [0, 0, 0];
    corner[plane.axis] = plane.at;
    corner[first] = ends(first)[i!]!;
    corner[second] = ends(second)[j!]!;
    return corner;
  });
}

export class Symbols {
  readonly group = new Group();
  // Kept from body to body: their shaders would have to be compiled for each again.
  private readonly held = new PointsMaterial({
    color: new Color(CLAMP_COLOR),
    size: 5,
    sizeAttenuation: false,
    transparent: true,
    opacity: 0.9,
    depthWrite: false,
  });
  private readonly loaded = new MeshBasicMaterial({ color: new Color(LOAD_COLOR) });
  private readonly glass = new MeshBasicMaterial({
    color: new Color(PLANE_COLOR),
    transparent: true,
    opacity: 0.14,
    side: DoubleSide,
    depthWrite: false,
  });
  private readonly rim = new LineBasicMaterial({ color: new Color(PLANE_COLOR) });
  private geometries: BufferGeometry[] = [];

  build(body: BodyEvent): void {
    this.clear();
    const size = Math.hypot(
      ...body.bounds[1].map((high, axis) => high - (body.bounds[0][axis] ?? 0)),
    );
    const [low, high] = body.bounds;
    const middle = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
    for (const clamp of body.clamps) this.points(clamp.points.flat());
    for (const plane of body.planes) this.plane(planeCorners(plane, body.bounds));
    for (const load of body.loads) {
      const direction = new Vector3(...load.direction);
      // A tendon is a line of its own, which says how it is pulled.
      if (load.kind !== "pressure" && load.kind !== "tendon" && direction.lengthSq() > 0) {
        direction.normalize();
        const tip = arrowTip(new Vector3(...load.at), direction, middle, 0.16 * size);
        this.arrow(tip, direction, 0.16 * size);
      }
    }
  }

  private points(places: number[]): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
    const points = new Points(geometry, this.held);
    points.renderOrder = 6;
    this.group.add(points);
    this.geometries.push(geometry);
  }

  private plane(corners: [number, number, number][]): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners.flat()), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    // Four lines have no use for the two triangles' index.
    const rim = new BufferGeometry().setAttribute("position", geometry.getAttribute("position"));
    for (const drawing of [new Mesh(geometry, this.glass), new LineLoop(rim, this.rim)]) {
      drawing.renderOrder = 6;
      this.group.add(drawing);
    }
    this.geometries.push(geometry, rim);
  }

  private arrow(tip: Vector3, direction: Vector3, length: number): void {
    const head = 0.28 * length;
    const shaft = new CylinderGeometry(0.028 * length, 0.028 * length, length - head, 12);
    shaft.translate(0, -(head + (length - head) / 2), 0);
    const cone = new ConeGeometry(0.1 * length, head, 20);
    cone.translate(0, -head / 2, 0);
    for (const geometry of [shaft, cone]) {
      const mesh = new Mesh(geometry, this.loaded);
      mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), direction);
      mesh.position.copy(tip);
      mesh.renderOrder = 6;
      this.group.add(mesh);
    }
    this.geometries.push(shaft, cone);
  }

  clear(): void {
    this.group.clear();
    for (const geometry of this.geometries) geometry.dispose();
    this.geometries = [];
  }

  /** Words for the loads, clamps and probes of the body; probes follow their vertices. */
  labels(
    body: BodyEvent,
    stat: StatEvent | null,
    mesh: BodyMesh | null,
    exaggeration: number,
    cavities: boolean,
  ): Label[] {
    const labels: Label[] = [];
    const fixed = (point: readonly number[]) => (out: Vector3) =>
      out.set(point[0] ?? 0, point[1] ?? 0, point[2] ?? 0);
    for (const [i, clamp] of body.clamps.entries()) {
      labels.push({
        key: `clamp-${i}`,
        kind: "clamp",
        text: clamp.name,
        title: `${clamp.vertices} vertices are held`,
        color: CLAMP_COLOR,
        at: fixed(clamp.center),
        onClick: () => showPane("design"),
      });
    }
    for (const [i, plane] of body.planes.entries()) {
      const name = "xyz"[plane.axis];
      labels.push({
        key: `plane-${i}`,
        kind: "plane",
        text: `symmetry ${name} = ${formatQuantity(plane.at, "m", 3)}`,
        title: "What is on its other side is the mirror image, and is not solved for",
        color: PLANE_COLOR,
        at: fixed(planeCorners(plane, body.bounds)[2] as [number, number, number]),
        onClick: () => showPane("design"),
      });
    }
    for (const [i, layer] of body.layers.entries()) {
      labels.push({
        key: `layer-${i}`,
        kind: "layer",
        text: layer.name,
        title: `A layer of ${formatNumber(layer.stiffness, 3)} N/m`,
        color: LAYER_COLOR,
        at: (out) => fixed(meanPlace(layer.triangles, mesh, exaggeration) ?? layer.center)(out),
        onClick: () => showPane("design"),
      });
    }
    for (const load of body.loads) {
      if (load.kind === "tendon") continue;
      labels.push({
        key: `load-${load.index}`,
        kind: "load",
        text: `${load.label} ${loadText(load, stat)}`,
        title: "Change this load",
        color: LOAD_COLOR,
        at: fixed(load.at),
        onClick: () => showPane("run"),
      });
    }
    for (const probe of body.probes) {
      const place = (out: Vector3) =>
        fixed(meanPlace(probe.vertices, mesh, exaggeration) ?? probe.center)(out);
      labels.push({
        key: `probe-${probe.name}`,
        kind: "probe",
        text: probe.name,
        title: "Show what this probe measured",
        color: PROBE_COLOR,
        at: place,
        onClick: () => showPane("probes"),
      });
    }
    if (cavities) {
      for (const [i, cavity] of body.cavities.entries()) {
        labels.push({
          key: `cavity-${i}`,
          kind: "cavity",
          text: `${cavityName(cavity, i)} · ${formatQuantity(cavity.volume, "m^3", 3)}`,
          color: CAVITY_COLORS[i % CAVITY_COLORS.length] as string,
          at: fixed(cavity.center),
        });
      }
    }
    for (const [i, leak] of body.leaks.entries()) {
      labels.push({
        key: `leak-${i}`,
        kind: "leak",
        text: `open here: ${formatQuantity(leak.volume, "m^3", 3)} is not enclosed`,
        at: fixed(leak.point),
      });
    }
    return labels;
  }
}
