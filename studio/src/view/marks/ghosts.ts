// Shapes of the design by themselves, over the body: shapes that cut it, shapes it is made of, unused
// ones. Each shows through the things before it, with a line around its visible part.
import {
  AlwaysStencilFunc,
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  GLSL3,
  Group,
  type IUniform,
  Matrix4,
  Mesh,
  NotEqualStencilFunc,
  type Ray,
  Raycaster,
  ReplaceStencilOp,
  ShaderMaterial,
  Vector2,
  Vector3,
} from "three";
import { bytesOf } from "../../engine/base64";
import type { BodyPose, Ghost } from "../../protocol";
import { showPane } from "../../shell/actions";
import { setView } from "../../store/view";
import type { Label } from "./labels";
import { CHOSEN_COLOR } from "./several";

const COLOR = "#7f9bb8";
/** Opacity of a ghost in the middle, and at its rim. */
const OPACITY = { chosen: 0.34, other: 0.22 } as const;
const RIM = { chosen: 0.3, other: 0.2 } as const;
/** Width of the line around it, CSS pixels. */
const LINE = { chosen: 2, other: 1.2 } as const;
/** The bit of the stencil that says where a ghost is; sections count in the others, before. */
const BIT = 0x80;
/** Ghosts are drawn after all else, one after the other. */
const FIRST = 20;

const VERTEX = /* glsl */ `
uniform vec2 uPixel;
uniform float uLine;
out vec3 vNormal;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  // The line is as wide in pixels at any distance.
  vec2 way = (projectionMatrix * vec4(vNormal, 0.0)).xy / uPixel;
  float size = length(way);
  if (uLine > 0.0 && size > 1e-9) gl_Position.xy += uLine * uPixel * gl_Position.w * way / size;
}
`;

const FRAGMENT = /* glsl */ `
precision highp float;
in vec3 vNormal;
uniform vec3 uOwn;
uniform float uAlpha;
uniform float uRim;
out vec4 color;
void main() {
  vec3 normal = normalize(gl_FrontFacing ? vNormal : -vNormal);
  float key = max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  float rim = pow(1.0 - max(0.0, normal.z), 2.0);
  color = vec4(uOwn * (0.6 + 0.45 * key), uAlpha + uRim * rim);
}
`;

type Pass = Mesh<BufferGeometry, ShaderMaterial>;

interface Drawn {
  readonly ghost: Ghost;
  readonly group: Group;
  readonly geometry: BufferGeometry;
  readonly pose: Matrix4;
  readonly passes: { mask: Pass; fill: Pass; line: Pass; clear: Pass };
}

export class Ghosts {
  readonly group = new Group();
  private drawn: Drawn[] = [];
  /** Those before; their shaders are used again, without compiling, as long as these are not disposed of. */
  private gone: Drawn[] = [];
  private chosen: string | null = null;
  private readonly pixel: IUniform<Vector2> = { value: new Vector2(1, 1) };

  /** Take other shapes; the surfaces of those that are as they were stay. */
  build(ghosts: readonly Ghost[]): void {
    const before = new Map(this.drawn.map((one) => [one.ghost.name, one]));
    for (const { passes } of this.gone)
      for (const pass of Object.values(passes)) pass.material.dispose();
    this.gone = this.drawn;
    this.group.clear();
    this.drawn = [];
    for (const ghost of ghosts.filter((one) => one.vertices !== "")) {
      const known = before.get(ghost.name);
      const same =
        known?.ghost.vertices === ghost.vertices && known.ghost.triangles === ghost.triangles;
      if (same) before.delete(ghost.name);
      const geometry = same ? known.geometry : geometryOf(ghost);
      for (const pose of ghost.poses)
        this.drawn.push(this.drawnOf(ghost, geometry, poseOf(pose), FIRST + 4 * this.drawn.length));
    }
    for (const { geometry } of before.values()) geometry.dispose();
  }

  private drawnOf(ghost: Ghost, geometry: BufferGeometry, pose: Matrix4, order: number): Drawn {
    const passes = {
      mask: this.pass(geometry, order, { colorWrite: false, depthTest: true, depthWrite: true }),
      fill: this.pass(geometry, order + 1, { depthTest: true }),
      line: this.pass(geometry, order + 2, {}),
      clear: this.pass(geometry, order + 3, { colorWrite: false }),
    };
    // Things before a ghost do not hide it, but it hides itself: else many layers were one blot.
    passes.mask.onBeforeRender = (renderer) => renderer.clearDepth();
    for (const [pass, mark] of [
      [passes.mask, BIT],
      [passes.clear, 0],
    ] as const)
      Object.assign(pass.material, {
        ...{ stencilWrite: true, stencilFunc: AlwaysStencilFunc, stencilRef: mark },
        ...{
          stencilWriteMask: BIT,
          stencilZPass: ReplaceStencilOp,
          stencilZFail: ReplaceStencilOp,
        },
      });
    Object.assign(passes.line.material, {
      ...{ stencilWrite: true, stencilWriteMask: 0 },
      ...{ stencilFunc: NotEqualStencilFunc, stencilRef: BIT, stencilFuncMask: BIT },
    });
    const group = new Group();
    group.matrixAutoUpdate = false;
    group.add(...Object.values(passes));
    this.group.add(group);
    return { ghost, group, geometry, pose, passes };
  }

  private pass(
    geometry: BufferGeometry,
    order: number,
    own: { colorWrite?: boolean; depthTest?: boolean; depthWrite?: boolean },
  ): Pass {
    const material = new ShaderMaterial({
      ...{ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT },
      // Also those that are not blended: all have to be drawn in their order.
      ...{ transparent: true, depthTest: false, depthWrite: false, side: DoubleSide },
      uniforms: {
        uPixel: this.pixel,
        uLine: { value: 0 },
        uOwn: { value: new Color(COLOR) },
        uAlpha: { value: 1 },
        uRim: { value: 0 },
      },
      ...own,
    });
    const mesh = new Mesh(geometry, material);
    mesh.renderOrder = order;
    mesh.frustumCulled = false;
    return mesh;
  }

  /** Mark the one that is chosen, and draw it where `preview` has it while it is dragged. */
  place(
    chosen: string | null,
    preview: Matrix4 | null,
    pixels: { x: number; y: number; ratio: number },
  ): void {
    this.chosen = chosen;
    this.pixel.value.set(2 / pixels.x, 2 / pixels.y);
    for (const { ghost, group, pose, passes } of this.drawn) {
      const marked = ghost.name === chosen;
      const style = marked ? "chosen" : "other";
      group.matrix.copy(pose);
      if (marked && preview) group.matrix.multiply(preview);
      group.matrixWorldNeedsUpdate = true;
      for (const pass of [passes.fill, passes.line])
        (pass.material.uniforms.uOwn!.value as Color).set(marked ? CHOSEN_COLOR : COLOR);
      passes.fill.material.uniforms.uAlpha!.value = OPACITY[style];
      passes.fill.material.uniforms.uRim!.value = RIM[style];
      passes.line.material.uniforms.uLine!.value = LINE[style] * pixels.ratio;
    }
  }

  labels(): Label[] {
    return this.firsts.map(({ ghost, group }) => ({
      key: `shape-${ghost.name}`,
      kind: "shape",
      text: ghost.name,
      title: titleOf(ghost),
      color: ghost.name === this.chosen ? CHOSEN_COLOR : COLOR,
      at: (out) => topOf(ghost, out).applyMatrix4(group.matrix),
      onClick: () => {
        setView({ shape: ghost.name });
        showPane("design");
      },
    }));
  }

  /** The ghost that a ray meets first. */
  hit(ray: Ray): string | null {
    const caster = new Raycaster();
    caster.ray.copy(ray);
    let best: { name: string; distance: number } | null = null;
    for (const { ghost, group, passes } of this.drawn) {
      passes.fill.matrixWorld.copy(group.matrix);
      const [met] = caster.intersectObject(passes.fill, false);
      if (met && met.distance < (best?.distance ?? Number.POSITIVE_INFINITY))
        best = { name: ghost.name, distance: met.distance };
    }
    return best?.name ?? null;
  }

  /** Box of a drawn shape, or null where it is not drawn. */
  boxOf(name: string): Box3 | null {
    const found = this.drawn.find((one) => one.ghost.name === name);
    if (!found) return null;
    const { low, high } = found.ghost;
    return new Box3(new Vector3(...low), new Vector3(...high)).applyMatrix4(found.group.matrix);
  }

  /** The frame that a shape is in, its box there and the middle of that, m. */
  frameOf(name: string): { pose: Matrix4; middle: Vector3; box: Ghost } | null {
    const found = this.drawn.find((one) => one.ghost.name === name);
    if (!found) return null;
    const { low, high } = found.ghost;
    const middle = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
    return { pose: found.pose, middle, box: found.ghost };
  }

  get names(): string[] {
    return this.firsts.map((one) => one.ghost.name);
  }

  /** Each shape once, also where several bodies are made of it. */
  private get firsts(): Drawn[] {
    return this.drawn.filter(({ ghost }, i) => this.drawn[i - 1]?.ghost !== ghost);
  }
}

/** From the frame of the body that is made of a shape to that of the picture. */
export function poseOf({ rotation: r, position: p }: BodyPose): Matrix4 {
  return new Matrix4().set(
    ...[r[0]!, r[1]!, r[2]!, p[0], r[3]!, r[4]!, r[5]!, p[1]],
    ...([r[6]!, r[7]!, r[8]!, p[2], 0, 0, 0, 1] as const),
  );
}

function geometryOf(ghost: Ghost): BufferGeometry {
  const geometry = new BufferGeometry();
  const vertices = new Float32Array(bytesOf(ghost.vertices));
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(bytesOf(ghost.triangles)), 1));
  geometry.computeVertexNormals();
  return geometry;
}

function topOf({ low, high }: Ghost, out: Vector3): Vector3 {
  return out.set((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2]);
}

/** Title that explains the drawing of a shape. */
function titleOf({ step, clipped }: Ghost): string {
  const cut = clipped ? ` It goes on along ${[...clipped].join(", ")} beyond what is drawn.` : "";
  const apart = Number((1e3 * step).toPrecision(2));
  return `A shape of the design, drawn from samples ${apart} mm apart: thinner walls may be missing.${cut}`;
}
