// Rigid objects beside the body: gray, and so that things behind them show through. They stand
// where the frame that is drawn has them.
import {
  type Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  GLSL3,
  Group,
  type IUniform,
  Matrix4,
  Mesh,
  type Ray,
  Raycaster,
  ShaderMaterial,
  Vector3,
  type Vector4,
} from "three";
import { bytesOf } from "../../engine/base64";
import type { BodyObject, Moment, ObjectPose } from "../../protocol";
import { showPane } from "../../shell/actions";
import { setView } from "../../store/view";
import { CUT } from "../drawing/shaders";
import type { Label } from "./labels";
import { CHOSEN_COLOR } from "./several";

const COLOR = "#8d959e";
/** Opacity of an object: the body that it presses must be seen through it. */
const OPACITY = 0.42;
const CHOSEN_OPACITY = 0.5;
const FAINT = 0.08;
/** Room around a body in which its objects are brought into the picture, in lengths of its longest side. */
const AROUND = 1;

const VERTEX = /* glsl */ `
out vec3 vNormal;
out vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  vNormal = normalMatrix * normal;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`;

const FRAGMENT = /* glsl */ `
precision highp float;
${CUT}
in vec3 vNormal;
in vec3 vWorld;
uniform vec3 uOwn;
uniform float uAlpha;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  vec3 normal = normalize(gl_FrontFacing ? vNormal : -vNormal);
  float key = max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  // Its outline shows the shape where light alone would not.
  float rim = pow(1.0 - max(0.0, normal.z), 2.0);
  color = vec4(uOwn * (0.55 + 0.5 * key), min(1.0, uAlpha + 0.4 * rim));
}
`;

/**
 * From where an object is at first to where a pose has it, the way drawn so many times as long: with
 * the rotation R about the middle m, which is brought to p, x becomes x + e (p + R (x − m) − x).
 */
export function placedBy(
  pose: ObjectPose | undefined,
  middle: readonly [number, number, number],
  exaggeration: number,
  out = new Matrix4(),
): Matrix4 {
  out.identity();
  if (!pose) return out;
  const e = exaggeration;
  const entries = out.elements; // column by column
  for (let row = 0; row < 3; row++) {
    let along = pose.position[row] as number;
    for (let column = 0; column < 3; column++) {
      const turn = pose.rotation[3 * row + column] as number;
      entries[4 * column + row] = e * turn + (row === column ? 1 - e : 0);
      along -= turn * (middle[column] as number);
    }
    entries[12 + row] = e * along;
  }
  return out;
}

export type ObjectMesh = Mesh<BufferGeometry, ShaderMaterial>;

/** Plane of the section, and true if it cuts. */
export interface Cut {
  readonly plane: IUniform<Vector4>;
  readonly on: IUniform<number>;
}

/** A surface as objects are drawn. */
export function objectMesh(vertices: Float32Array, triangles: Uint32Array, cut: Cut): ObjectMesh {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  geometry.computeVertexNormals();
  geometry.computeBoundingBox();
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    transparent: true,
    uniforms: {
      uPlane: cut.plane,
      uSection: cut.on,
      uOwn: { value: new Color(COLOR) },
      uAlpha: { value: OPACITY },
    },
  });
  material.forceSinglePass = false; // its far side first
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = 7;
  mesh.frustumCulled = false;
  return mesh;
}

/** A box with boxes of objects, as far as they do not dwarf the body in `box`. */
export function around(box: Box3, objects: Iterable<Box3 | undefined>): Box3 {
  const size = box.getSize(new Vector3());
  const limits = box.clone().expandByScalar(AROUND * Math.max(size.x, size.y, size.z));
  const all = box.clone();
  for (const own of objects)
    if (own?.intersectsBox(limits)) all.union(own.clone().intersect(limits));
  return all;
}

interface Drawn {
  readonly object: BodyObject;
  readonly mesh: ObjectMesh;
  readonly middle: Vector3;
}

export class RigidObjects {
  readonly group = new Group();
  private drawn: Drawn[] = [];
  private built: readonly BodyObject[] = [];
  /** One that is drawn some times as large, while it is sized. */
  sized: { readonly name: string; readonly factor: number } | null = null;

  constructor(private readonly section: Cut) {}

  build(objects: readonly BodyObject[]): void {
    // The report of a body's checks comes with the same objects again.
    const key = (all: readonly BodyObject[]) => all.map((one) => `${one.name} ${one.vertices}`);
    if (key(objects).join() === key(this.built).join()) return;
    this.clear();
    this.built = objects;
    this.drawn = objects.map((object) => {
      const vertices = new Float32Array(bytesOf(object.vertices));
      const triangles = new Uint32Array(bytesOf(object.triangles));
      const mesh = objectMesh(vertices, triangles, this.section);
      mesh.matrixAutoUpdate = false;
      this.group.add(mesh);
      return { object, mesh, middle: new Vector3() };
    });
    this.place(undefined, 1, null);
  }

  /** Put all in their poses of a frame, and mark the chosen one; faint ones do not hide the bodies they press. */
  place(
    moment: Moment | undefined,
    exaggeration: number,
    chosen: string | null,
    faint = false,
  ): void {
    for (const [i, { object, mesh, middle }] of this.drawn.entries()) {
      placedBy(moment?.poses[i], object.middle, exaggeration, mesh.matrix);
      if (object.name === this.sized?.name) {
        const about = new Matrix4().makeTranslation(...object.middle);
        const { factor } = this.sized;
        mesh.matrix.multiply(about).scale(new Vector3(factor, factor, factor));
        mesh.matrix.multiply(about.invert());
      }
      mesh.matrixWorldNeedsUpdate = true;
      middle.set(...object.middle).applyMatrix4(mesh.matrix);
      const { uniforms } = mesh.material;
      const marked = object.name === chosen;
      (uniforms.uOwn!.value as Color).set(marked ? CHOSEN_COLOR : COLOR);
      uniforms.uAlpha!.value = faint ? FAINT : marked ? CHOSEN_OPACITY : OPACITY;
    }
  }

  /** A box with all of them, as far as they do not dwarf the body in `box`. */
  around(box: Box3): Box3 {
    const boxes = this.drawn.map(({ mesh }) =>
      mesh.geometry.boundingBox?.clone().applyMatrix4(mesh.matrix),
    );
    return around(box, boxes);
  }

  labels(): Label[] {
    return this.drawn.map(({ object, middle }) => ({
      key: `object-${object.name}`,
      kind: "object",
      text: object.name,
      title: `A rigid object, ${object.motion}`,
      color: COLOR,
      at: (out) => out.copy(middle),
      onClick: () => {
        setView({ chosen: object.name });
        showPane("design");
      },
    }));
  }

  /** The points of an object where a moment has it; null where there is none of that name. */
  pointsOf(name: string, moment: Moment, exaggeration: number): Float32Array | null {
    const index = this.drawn.findIndex((one) => one.object.name === name);
    const found = this.drawn[index];
    if (!found) return null;
    const place = placedBy(moment.poses[index], found.object.middle, exaggeration);
    const points = Float32Array.from(found.mesh.geometry.getAttribute("position").array);
    const at = new Vector3();
    for (let i = 0; i < points.length; i += 3)
      at.fromArray(points, i).applyMatrix4(place).toArray(points, i);
    return points;
  }

  /** The free object that a ray meets first: its place in the list, where it is met, and its middle. */
  hit(ray: Ray): { index: number; point: Vector3; middle: Vector3 } | null {
    const caster = new Raycaster();
    caster.ray.copy(ray);
    let best: { index: number; point: Vector3; middle: Vector3; distance: number } | null = null;
    for (const [index, { object, mesh, middle }] of this.drawn.entries()) {
      if (object.motion !== "free") continue;
      mesh.matrixWorld.copy(mesh.matrix);
      const [met] = caster.intersectObject(mesh, false);
      if (met && met.distance < (best?.distance ?? Number.POSITIVE_INFINITY)) {
        best = { index, point: met.point, middle: middle.clone(), distance: met.distance };
      }
    }
    return best;
  }

  /** Position where the middle of an object is drawn, m. */
  middleAt(index: number): Vector3 | undefined {
    return this.drawn[index]?.middle;
  }

  /** Position of the middle of an object by its name. */
  middleOf(name: string): [number, number, number] | null {
    return this.drawn.find((one) => one.object.name === name)?.middle.toArray() ?? null;
  }

  private clear(): void {
    this.group.clear();
    for (const { mesh } of this.drawn) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.drawn = [];
    this.built = [];
  }
}
