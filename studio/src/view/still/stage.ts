// Bodies at rest, each in a cell of its own or all in one, seen by one camera. One renderer draws
// all cells, since browsers allow a page only so many of them.
import {
  Box3,
  ColorManagement,
  LinearSRGBColorSpace,
  Scene,
  Vector3,
  Vector4,
  WebGLRenderer,
} from "three";
import type { Frame } from "../../engine/frames";
import { appearanceOf } from "../../store/appearance";
import type { View } from "../../store/view";
import { BodyMesh } from "../body/body";
import { SmoothMesh } from "../body/smooth";
import { CameraRig, type StandardView } from "../drawing/camera";
import { Ground, Sky } from "../drawing/ground";
import { themeColor } from "../drawing/theme";
import { Labels } from "../marks/labels";
import { around, type ObjectMesh, objectMesh } from "../marks/objects";
import { commonRange, type Still } from "./fetchStill";
import { type Mark, Marks } from "./marks";
import { listen } from "./pointer";

// Colors stay as they are written: those of the maps must be those of the legend.
ColorManagement.enabled = false;

/** A body's own color where it has no field: clay. */
const PARTS = ["#e8b88a"];

export interface StillScene {
  /** One for each cell; null while it is not there. */
  readonly bodies: readonly (Still | null)[];
  /** All in one cell, those after the first as wires. */
  readonly over: boolean;
  readonly field: number;
  readonly view: View;
  readonly marks: readonly Mark[];
}

interface Shown {
  readonly still: Still;
  readonly mesh: BodyMesh;
  readonly smooth: SmoothMesh | null;
  readonly objects: ObjectMesh | null;
  readonly scene: Scene;
}

export class StillStage {
  readonly element = document.createElement("div");
  readonly rig = new CameraRig();
  readonly renderer = new WebGLRenderer({ antialias: true });
  private readonly backdrop = new Scene();
  private readonly sky = new Sky();
  private readonly ground = new Ground();
  private readonly labels = new Labels();
  private readonly overlay = new Scene();
  private marks: Marks | null = null;
  private shown: (Shown | null)[] = [];
  private scene: StillScene | null = null;
  private asked: number | null = null;
  private touched = false;
  private readonly watches: { disconnect(): void }[] = [];

  constructor() {
    this.element.className = "still-stage";
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.autoClear = false;
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    this.element.append(canvas, this.labels.element);
    this.backdrop.add(this.sky.mesh, this.ground.mesh);
    listen(this);
    const size = new ResizeObserver(() => this.resize());
    size.observe(this.element);
    const theme = new MutationObserver(() => this.recolor());
    theme.observe(document.documentElement, { attributeFilter: ["data-theme"] });
    this.watches.push(size, theme);
  }

  /** Show other bodies, or the same ones in another way. */
  set(scene: StillScene): void {
    const before = this.scene;
    this.scene = scene;
    this.rig.flat = scene.view.orthographic;
    let fresh = false;
    for (const [i, still] of scene.bodies.entries()) {
      if (this.shown[i]?.still === still) continue;
      fresh = true;
      this.drop(i);
      this.shown[i] = still && this.build(still);
    }
    for (let i = scene.bodies.length; i < this.shown.length; i++) this.drop(i);
    this.shown.length = scene.bodies.length;
    if (scene.over !== before?.over || scene.bodies.length !== before?.bodies.length) this.resize();
    if (fresh) {
      const box = this.box();
      if (!box.isEmpty()) {
        this.ground.lay(box);
        this.rig.setReach(box.getSize(new Vector3()).length() || 0.1);
        // A view that a user has turned stays as it is.
        if (!this.touched) this.rig.fit(box, true);
      }
    }
    if (fresh || scene.marks !== before?.marks) this.mark();
    this.request();
  }

  /** The camera begins anew with the next bodies. */
  forget(): void {
    this.touched = false;
  }

  /** Turn, move or zoom the one camera of all cells. */
  steer(change: (rig: CameraRig) => void): void {
    this.touched = true;
    change(this.rig);
    this.request();
  }

  look(view: StandardView): void {
    this.steer((rig) => rig.look(view));
  }

  fit(): void {
    const box = this.box();
    if (!box.isEmpty()) this.rig.fit(box);
    this.touched = false;
    this.request();
  }

  /** Position in its cell of a place of the page, -1 to 1 along both sides. */
  within(x: number, y: number): [number, number] {
    const rect = this.renderer.domElement.getBoundingClientRect();
    const width = rect.width / this.columns;
    const across = ((x - rect.left) % width) / width;
    return [2 * across - 1, 1 - (2 * (y - rect.top)) / rect.height];
  }

  dispose(): void {
    if (this.asked !== null) cancelAnimationFrame(this.asked);
    for (const watch of this.watches) watch.disconnect();
    for (let i = 0; i < this.shown.length; i++) this.drop(i);
    this.marks?.dispose();
    for (const { geometry, material } of [this.sky.mesh, this.ground.mesh]) {
      geometry.dispose();
      material.dispose();
    }
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.element.remove();
  }

  private get columns(): number {
    return this.scene?.over ? 1 : Math.max(1, this.scene?.bodies.length ?? 1);
  }

  private build(still: Still): Shown {
    const uncut = { plane: { value: new Vector4() }, section: { value: 0 } };
    const mesh = new BodyMesh(still.topology, uncut);
    const scene = new Scene();
    scene.add(mesh.group);
    const smooth =
      still.smooth && new SmoothMesh(still.smooth, { plane: uncut.plane, section: uncut.section });
    if (smooth) scene.add(smooth.group);
    const { rest, triangles } = still.objects ?? {};
    const cut = { plane: uncut.plane, on: uncut.section };
    const objects = rest && triangles ? objectMesh(rest, triangles, cut) : null;
    if (objects) scene.add(objects);
    return { still, mesh, smooth, objects, scene };
  }

  private drop(index: number): void {
    const gone = this.shown[index];
    gone?.mesh.dispose();
    gone?.smooth?.dispose();
    gone?.objects?.geometry.dispose();
    gone?.objects?.material.dispose();
    this.shown[index] = null;
  }

  private mark(): void {
    this.marks?.dispose();
    this.marks = null;
    const marks = this.scene?.marks ?? [];
    const box = this.box();
    if (marks.length > 0 && !box.isEmpty()) {
      const size = box.getSize(new Vector3()).length();
      this.marks = new Marks(marks, size);
      this.overlay.add(this.marks.group);
    }
    this.labels.set(this.marks?.labels ?? []);
  }

  private box(): Box3 {
    const box = new Box3();
    for (const one of this.shown) {
      if (!one) continue;
      // Whatever the field, the places are the same.
      if (!one.mesh.frame) one.mesh.setFrame(anyFrame(one.still));
      box.union(around(one.mesh.box(1), [one.objects?.geometry.boundingBox ?? undefined]));
    }
    for (const { measured } of this.scene?.marks ?? []) box.expandByPoint(new Vector3(...measured));
    return box;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width < 2 || height < 2) return;
    this.renderer.setSize(width, height);
    this.rig.resize(width / this.columns, height);
    if (!this.touched) {
      const box = this.box();
      if (!box.isEmpty()) this.rig.fit(box, true);
    }
    this.request();
  }

  private recolor(): void {
    this.sky.recolor();
    this.ground.recolor();
    this.mark();
    this.request();
  }

  private request(): void {
    this.asked ??= requestAnimationFrame((now) => {
      this.asked = null;
      if (this.rig.advance(now)) this.request();
      this.draw();
    });
  }

  private draw(): void {
    const { scene, renderer } = this;
    if (!scene) return;
    this.style(scene);
    const { clientWidth: width, clientHeight: height } = this.element;
    const cell = Math.floor(width / this.columns);
    this.ground.face(this.rig.toEye.z);
    this.ground.mesh.visible = scene.view.grid && this.shown.some(Boolean);
    renderer.setScissorTest(true);
    for (let column = 0; column < this.columns; column++) {
      const left = column * cell;
      renderer.setViewport(left, 0, cell, height);
      renderer.setScissor(left, 0, cell, height);
      renderer.clear();
      renderer.render(this.backdrop, this.rig.camera);
      for (const [i, one] of this.shown.entries())
        if (one && (scene.over || i === column)) renderer.render(one.scene, this.rig.camera);
      renderer.render(this.overlay, this.rig.camera);
    }
    const left = this.marks?.leanLeft(this.rig.camera) ?? false;
    this.labels.element.classList.toggle("lean-left", left);
    this.labels.place(this.rig.camera, cell, height);
  }

  private style(scene: StillScene): void {
    const stills = this.shown.flatMap((one) => one?.still ?? []);
    const { low, high } = commonRange(stills, scene.field) ?? { low: 0, high: 1 };
    const colors = { parts: PARTS, ink: themeColor("--ink") };
    for (const [i, one] of this.shown.entries()) {
      if (!one) continue;
      const frame = one.still.frames.get(scene.field) ?? anyFrame(one.still);
      const wire = scene.over && i > 0;
      if (one.mesh.frame !== frame) one.mesh.setFrame(frame);
      one.mesh.setRange(low, high);
      one.mesh.setPixels(this.renderer.domElement.height / 2);
      const told = one.still.frames.has(scene.field) && !wire;
      const appearance = wire ? "wireframe" : "voxels";
      const coloring = told ? "field" : "parts";
      const traced = one.smooth !== null;
      const drawn = wire ? appearance : appearanceOf(scene.view, { smooth: traced, cut: traced });
      const smooth = drawn === "smooth";
      one.mesh.style({ ...scene.view, appearance, coloring }, colors, true, smooth);
      one.smooth?.style({ ...scene.view, coloring }, colors, smooth, one.mesh);
      if (smooth) one.smooth?.follow(one.mesh, 1);
    }
  }
}

function anyFrame(still: Still): Frame {
  return still.frames.values().next().value as Frame;
}
