// The picture: scene, render loop and changes by frames, outside of React. It draws only
// when something has changed. Long because it is the one place where all parts of the view meet.
import {
  Box3,
  ColorManagement,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  type WebGLRenderer,
} from "three";
import { FrameGate } from "../engine/credits";
import { type Frame, positionIn, type Smooth, type Topology, valueIn } from "../engine/frames";
import { resized } from "../panes/design/bodies/gripped";
import { BODY, roomOf } from "../panes/design/bodies/several";
import { edit, editAll } from "../panes/design/edits";
import { shapeGrips } from "../panes/design/shapes/shapeGrips";
import type { ShapeGrip } from "../panes/design/shapes/shapeReader";
import { typedChanges } from "../panes/design/shapes/typedNumber";
import type { DocumentEvent, OverlapPlace, StatEvent } from "../protocol";
import { appearanceOf } from "../store/appearance";
import { chooseFace, useFace } from "../store/face";
import { usePage } from "../store/page";
import { currentEngine, onReady, present, send, sinceSent } from "../store/session";
import { useStudio } from "../store/studio";
import { setView, useShown, useView, type View } from "../store/view";
import { isAsBuilt } from "./body/asBuilt";
import { BodyMesh } from "./body/body";
import { type ColorRange, colorRange } from "./body/colorRange";
import { withoutDust } from "./body/dust";
import { Section } from "./body/section";
import { SectionFill } from "./body/sectionFill";
import { SmoothMesh } from "./body/smooth";
import { CameraRig, type StandardView } from "./drawing/camera";
import { roundLength } from "./drawing/ground";
import { Painter } from "./drawing/painter";
import { ladder, type Quality, WHOLE } from "./drawing/quality";
import { Stopwatch } from "./drawing/stopwatch";
import { themeColor } from "./drawing/theme";
import { faceAt, triangleAt } from "./hands/face";
import { Grabs } from "./hands/grab";
import { MoveHandle } from "./hands/moveHandle";
import { listen } from "./hands/pointer";
import { SectionHandle } from "./hands/sectionHandle";
import { type Edited, ShapeHandle } from "./hands/shapeHandle";
import { SizeHandle } from "./hands/sizeHandle";
import { type Places, type Target, TetPlaces, targetOf } from "./hands/target";
import { askGhosts } from "./marks/askGhosts";
import { Attachments } from "./marks/attachments";
import { ContactMarks } from "./marks/contactMarks";
import { FaceMark } from "./marks/faceMark";
import { ContactForces } from "./marks/forces";
import { Ghosts } from "./marks/ghosts";
import { type Label, Labels } from "./marks/labels";
import { RigidObjects } from "./marks/objects";
import { drawnAt, overlapLabels, overlapOf } from "./marks/overlap";
import { Panels } from "./marks/panels";
import { partColors, Several } from "./marks/several";
import { Spot } from "./marks/spot";
import { Symbols } from "./marks/symbols";
import { Tape } from "./marks/tape";

// Colors stay as they are written: those of the maps must be those of the legend.
ColorManagement.enabled = false;

const TELL_EVERY = 120;
const TELL_EVERY_WHERE_SLOW = 400;
const HOVER_EVERY = 100;
/** A picture in which nothing changed for so long stands still, ms. */
const SETTLED = 400;
/** Room of the grid while there is no body, m: that of the first shape. */
const EMPTY_ROOM = new Box3(new Vector3(-0.02, -0.02, 0), new Vector3(0.02, 0.02, 0.04));
/** Body of the picture while there is none. */
const NO_BODY = 0;
/** Only a picture that has moved for so long, ms, changes its size: that alone takes a while. */
const LASTING = 300;

// Another document, not another revision of the same one, is a reason to fit the view.
function nameOf(document: DocumentEvent | null): string | null {
  return document && `${document.path} ${document.name}`;
}

/** Mode of the engine's packing for a view: with a section through a field also the voxels behind the surface. */
function modeOf(view: View): "surface" | "solid" | "tets" {
  if (view.appearance === "tets") return "tets";
  const opened = view.section !== "off" && view.coloring === "field";
  return opened && view.appearance !== "wireframe" && !view.cavities ? "solid" : "surface";
}

/** Component of the direction to the eye across a section below which the section is seen edge on. */
const EDGE_ON = 0.05;

export class Viewport {
  readonly element = document.createElement("div");
  readonly rig = new CameraRig();
  readonly grabs = new Grabs();
  readonly tape = new Tape();
  private readonly faceMark = new FaceMark();
  private readonly spot = new Spot(() => this.request());
  private readonly painter = new Painter();
  private readonly stopwatch: Stopwatch;
  private readonly scene = new Scene();
  private readonly section = new Section();
  private readonly fill = new SectionFill();
  private readonly sectionHandle = new SectionHandle(this.section, this.rig);
  private readonly mover = new MoveHandle(
    this.rig,
    () => this.request(),
    (by) => {
      const { chosen } = useView.getState();
      if (chosen) send({ t: "move", name: chosen, by });
    },
  );
  private readonly sizer = new SizeHandle(
    this.rig,
    () => this.request(),
    (factor) => {
      const sized = this.objectToSize(useView.getState());
      const shape = sized && resized(sized.shape, factor);
      if (shape) editAll([{ path: ["objects", sized.index, "shape"], value: shape }]);
    },
  );
  private readonly shaper = new ShapeHandle(this.rig, {
    changed: () => this.request(),
    // Each drag is a step of its own; keys that follow each other are undone together.
    dropped: (grip, value) => editAll(grip.number.changes(value)),
    stepped: (grip, value) => {
      const changes = grip.number.changes(value);
      if (changes.length > 1) editAll(changes);
      else for (const change of changes) edit(change.path, change.value);
    },
    typed: (grip, text) => {
      const read = typedChanges(grip, text, useStudio.getState().document);
      if ("problem" in read) return read.problem;
      editAll(read.changes);
      return null;
    },
  });
  private shapeGrips: { key: readonly unknown[]; grips: ShapeGrip[] } | null = null;
  private readonly attachments = new Attachments();
  private readonly symbols = new Symbols();
  private readonly contactMarks = new ContactMarks();
  private readonly objects = new RigidObjects(this.section);
  private readonly several = new Several();
  private readonly ghosts = new Ghosts();
  private readonly forces = new ContactForces();
  private readonly labels = new Labels();
  private readonly panels = new Panels();
  private ink = themeColor("--ink");
  private readonly gate = new FrameGate();
  // Disposed of after the next picture, which then uses their shaders again without compiling.
  private readonly gone: BodyMesh[] = [];
  private drawnTopology = 0;
  private readonly raycaster = new Raycaster();
  private surface: BodyMesh | null = null;
  private tets: BodyMesh | null = null;
  /** Mesh that takes the place of the surface with its first frame. */
  private coming: BodyMesh | null = null;
  private smooth: SmoothMesh | null = null;
  private tetPlaces: TetPlaces | null = null;
  // A body of which no frame was drawn yet.
  private unseen = false;
  private latest: Frame | null = null;
  private positions: { key: string; values: Float32Array } | null = null;
  private asked: number | null = null;
  private attached = false;
  private lastTold = 0;
  private tellTimer: ReturnType<typeof setTimeout> | null = null;
  private lastHover = 0;
  private hoverAt: { x: number; y: number } | null = null;
  private hoverTimer: ReturnType<typeof setTimeout> | null = null;
  private placedBefore = 0;
  private movingSince = 0;
  private lastMoved = Number.NEGATIVE_INFINITY;
  private settleTimer: ReturnType<typeof setTimeout> | null = null;
  private times: number[] = [];
  private latency: number | null = null;
  private lastSeq = 0;
  private extremes: { low: number; high: number } | null = null;
  private colors: ColorRange | null = null;
  private fitNext = true;
  /** True while an empty grid is drawn. */
  private bare = false;
  /** The body to which the picture was fitted before its objects came; 0 for none. */
  private fitted = 0;
  private pullsDue = true;
  private documentName = nameOf(useStudio.getState().document);
  private drawnListeners = new Set<() => void>();

  constructor() {
    this.element.className = "viewport";
    this.stopwatch = new Stopwatch(
      this.renderer.getContext() as WebGL2RenderingContext,
      (milliseconds) => ladder.took(milliseconds),
    );
    this.renderer.domElement.setAttribute("aria-label", "The body");
    this.renderer.domElement.tabIndex = 0;
    this.element.append(
      this.renderer.domElement,
      this.labels.element,
      this.sectionHandle.element,
      this.mover.element,
      this.sizer.element,
      this.shaper.element,
    );
    this.scene.add(
      this.section.group,
      this.fill.mesh,
      this.symbols.group,
      this.contactMarks.group,
      this.objects.group,
      this.several.group,
      this.forces.group,
      this.attachments.group,
      this.grabs.group,
      this.tape.group,
      this.faceMark.mesh,
      this.ghosts.group,
    );
    new ResizeObserver(() => this.resize()).observe(this.element);
    new MutationObserver(() => this.recolor()).observe(document.documentElement, {
      attributeFilter: ["data-theme"],
    });
    listen(this);
    useView.subscribe((now, before) => this.viewChanged(now, before));
    useFace.subscribe(({ face }) => {
      if (face) setView({ shape: null });
      this.request();
    });
    usePage.subscribe((now, before) => now.mode !== before.mode && this.request());
    useStudio.subscribe((now, before) => {
      if (now.body !== before.body) this.bodyChanged();
      if (now.stat !== before.stat) {
        this.takePulls(now.stat);
        if (now.stat?.grabs.length === 0 && before.stat?.grabs.length) this.grabs.forgetPinned();
        // While time runs the next frame is on its way and will show other news too.
        if (now.stat?.state !== "playing" || before.stat?.state !== "playing") this.request();
      }
      if (now.ghosts !== before.ghosts) this.ghostsChanged();
      if (now.overlap !== before.overlap || now.moments !== before.moments) this.request();
      if (now.document !== before.document && !now.document?.valid) this.shaper.forget();
      const name = nameOf(now.document);
      if (name !== null && name !== this.documentName) {
        this.documentName = name;
        this.fitNext = true;
      }
    });
    document.addEventListener("visibilitychange", () => {
      this.tellView();
      this.request();
    });
    onReady(() => {
      this.gate.clear();
      this.tellView();
    });
    askGhosts();
    present(this);
    if (useStudio.getState().body) this.bodyChanged();
  }

  // ---- messages of the engine ----

  topology(topology: Topology): void {
    const current = this.surface ?? this.tets;
    const fresh = current?.topology.id !== topology.id;
    // A change from tetrahedra back to the surface sends again the known one.
    const surface = this.surface?.topology;
    if (!fresh && !topology.tets && surface?.rest.length === topology.rest.length) return;
    const mesh = new BodyMesh(topology, { plane: this.section.plane, section: this.section.on });
    if (fresh) this.clearBody(mesh.box(1), topology.id);
    if (topology.tets) {
      this.drop(this.tets);
      this.tets = mesh;
    } else if (surface && !fresh) {
      // Surface with the voxels behind it, or without: drawn once its positions are known.
      this.coming?.dispose();
      this.coming = mesh;
      return;
    } else this.surface = mesh;
    this.scene.add(mesh.group);
    this.coverSurface();
    if (fresh) {
      this.takeIn();
      this.takeInShape();
    }
    this.stir(performance.now());
    this.request();
  }

  clear(): void {
    this.fitNext = true;
    this.clearBody(EMPTY_ROOM.clone(), NO_BODY);
    this.bare = this.fitNext = true;
    this.drawnTopology = NO_BODY;
    this.request();
  }

  // Another body: things attached to the old one go, the camera stays where it is.
  private clearBody(box: Box3, id: number): void {
    this.bare = false;
    this.drop(this.surface);
    this.drop(this.tets);
    this.coming?.dispose();
    this.surface = this.tets = this.coming = null;
    this.smooth?.dispose();
    this.smooth = null;
    this.latest = null;
    this.extremes = null;
    this.colors = null;
    this.positions = null;
    this.grabs.clear();
    this.pullsDue = true;
    this.tape.clear();
    this.spot.clear();
    chooseFace(null);
    this.painter.backdrop.ground.lay(box);
    this.rig.setReach(box.getSize(new Vector3()).length() || 0.1);
    // A body that has grown out of a picture that no hand has placed is taken in whole.
    const outgrown = !this.rig.steered && !this.rig.holds(box);
    if (this.fitNext || outgrown) this.rig.fit(box, true);
    this.fitted = this.fitNext ? id : 0;
    this.fitNext = false;
  }

  frame(frame: Frame): void {
    this.gate.offer(frame);
    this.request();
  }

  smoothSurface(smooth: Smooth): void {
    // A viewport that is made later is given the last shape, which may be that of a body before.
    if (smooth.topology !== (this.surface ?? this.tets)?.topology.id) return;
    this.smooth?.dispose();
    this.smooth = new SmoothMesh(smooth, { plane: this.section.plane, section: this.section.on });
    this.scene.add(this.smooth.group);
    this.request();
  }

  private exchange(mesh: BodyMesh): void {
    this.drop(this.surface);
    this.surface = mesh;
    this.coming = null;
    this.scene.add(mesh.group);
    this.coverSurface();
  }

  // Springs that pull on a body which comes anew: they were there before it was meshed again.
  private takePulls(stat: StatEvent | null): void {
    if (!this.pullsDue || !stat || stat.topology !== this.surface?.topology.id) return;
    this.pullsDue = false;
    this.grabs.adopt(stat.grabs);
  }

  private drop(mesh: BodyMesh | null): void {
    if (!mesh) return;
    mesh.group.removeFromParent();
    this.gone.push(mesh);
  }

  private bodyChanged(): void {
    const { body, hello } = useStudio.getState();
    if (body) this.symbols.build(body);
    else this.symbols.clear();
    const design = useStudio.getState().document?.design ?? null;
    this.contactMarks.build(body?.bonds ?? [], body?.bounds ?? null, design);
    this.attachments.build(body?.attachments ?? []);
    this.objects.build(body?.objects ?? []);
    // Only a body that may touch something has fields of contact.
    const shown = hello?.fields.find((one) => one.id === useView.getState().field);
    if (body && !body.touches && shown?.contact) setView({ field: 0, range: "auto" });
    this.takeIn();
    this.coverSurface();
    this.request();
  }

  // Bodies that are added stand beside those that were there, and objects come before the body's surface, with
  // it or later: a picture that no hand has turned takes them in.
  private takeIn(): void {
    const { body } = useStudio.getState();
    const mesh = this.shownMesh();
    if (!mesh || body?.topology !== mesh.topology.id) return;
    const alone = body.objects.length + body.bodies.length === 0;
    if (alone && body.floor === null) return;
    const box = this.objects.around(mesh.box(1).clone());
    this.painter.backdrop.ground.lay(box, body.floor);
    if (alone) return;
    this.rig.setReach(box.getSize(new Vector3()).length() || 0.1);
    const fitted = this.fitted === mesh.topology.id;
    if (this.rig.steered || (!fitted && this.rig.holds(box))) return;
    this.rig.fit(box, fitted);
    this.fitted = 0;
  }

  private ghostsChanged(): void {
    this.shaper.forget();
    this.ghosts.build(useStudio.getState().ghosts?.shapes ?? []);
    this.takeInShape();
    this.request();
  }

  // A chosen shape beside the body is brought into a picture that no hand has turned, whichever of the two comes first.
  private takeInShape(): void {
    const { shape } = useView.getState();
    const own = shape === null ? null : this.ghosts.boxOf(shape);
    const mesh = this.shownMesh();
    if (own && mesh && this.asBuilt && !this.rig.steered && !this.rig.holds(own))
      this.rig.fit(this.objects.around(mesh.box(1).clone()).union(own));
  }

  // The body's layers, whichever of its surface and its event comes first.
  private coverSurface(): void {
    const body = useStudio.getState().body;
    if (body && body.topology === this.surface?.topology.id) this.surface.cover(body.layers);
  }

  private viewChanged(now: View, before: View): void {
    if (now.field !== before.field || modeOf(now) !== modeOf(before)) this.tellView();
    if (!now.tape && before.tape) this.tape.clear();
    this.rig.flat = now.orthographic;
    this.stir(performance.now());
    this.request();
  }

  private tellView(): void {
    const view = useView.getState();
    const visible = this.attached && document.visibilityState === "visible";
    if (currentEngine()) {
      send({
        t: "view",
        field: view.field,
        mode: modeOf(view),
        visible,
      });
    }
  }

  // ---- where it is on the page ----

  attach(parent: HTMLElement): void {
    parent.prepend(this.element);
    this.panels.watch(parent, () => this.request());
    this.attached = true;
    this.resize();
    this.tellView();
  }

  detach(): void {
    this.element.remove();
    this.panels.watch(null, () => {});
    this.attached = false;
    this.tellView();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width < 2 || height < 2) return;
    this.painter.resize(width, height);
    this.rig.resize(width, height);
    this.request();
  }

  private recolor(): void {
    this.ink = themeColor("--ink");
    this.painter.backdrop.recolor();
    this.section.recolor();
    this.request();
  }

  // ---- drawing ----

  /** Draw at the next chance; while the tab is hidden or the view is away nothing is drawn. */
  request(): void {
    if (this.asked !== null || !this.attached || document.visibilityState === "hidden") return;
    this.asked = requestAnimationFrame((now) => {
      this.asked = null;
      this.draw(now);
    });
  }

  get renderer(): WebGLRenderer {
    return this.painter.renderer;
  }

  onDrawn(listener: () => void): () => void {
    this.drawnListeners.add(listener);
    return () => this.drawnListeners.delete(listener);
  }

  private draw(now: number): void {
    const frame = this.takeFrame(now);
    if (this.rig.advance(now)) this.request();
    if (frame || this.rig.places !== this.placedBefore) this.stir(now);
    this.placedBefore = this.rig.places;
    this.grabs.flush();
    const view = useView.getState();
    const mesh = this.shownMesh();
    const quality = this.qualityAt(now);
    this.painter.prepare(quality);
    this.style(view, mesh);
    this.seeFirst(view, mesh);
    const labels = this.words(view, mesh);
    this.painter.backdrop.ground.face(this.rig.toEye.z);
    this.painter.paint(this.scene, this.rig.camera, quality.smooth);
    this.drawnTopology = mesh?.topology.id ?? 0;
    for (const one of this.gone.splice(0)) one.dispose();
    if (quality !== WHOLE) this.settle();
    if (this.moving(now)) this.stopwatch.start();
    // Words must not catch clicks that are meant for the body.
    this.labels.element.classList.toggle("passive", view.tape || this.grabs.holding);
    this.labels.set(labels);
    const { clientWidth: width, clientHeight: height } = this.element;
    this.sectionHandle.place(width, height);
    const middle = this.middleToMove(view);
    this.mover.place(middle, width, height);
    const sized = this.objectToSize(view);
    this.shaper.place(this.shapeToEdit(view), width, height);
    this.sizer.place(sized ? middle : null, sized?.half ?? 0, width, height);
    const pressed = [
      ...this.sectionHandle.grips,
      ...this.mover.grips,
      ...this.sizer.grips,
      ...this.shaper.grips,
      ...this.panels.rects,
    ];
    this.labels.place(this.rig.camera, width, height, pressed);
    this.hover(now, view);
    this.tell(now, view);
    for (const listener of this.drawnListeners) listener();
  }

  // A coarse picture is drawn whole once nothing moves any more; one drawn too early asks again.
  private settle(): void {
    this.settleTimer ??= setTimeout(() => {
      this.settleTimer = null;
      if (useStudio.getState().stat?.state !== "playing") this.request();
    }, SETTLED);
  }

  private stir(now: number): void {
    if (now - this.lastMoved >= SETTLED) this.movingSince = now;
    this.lastMoved = now;
  }

  private qualityAt(now: number): Quality {
    if (!this.moving(now)) return WHOLE;
    const lasts = this.lastMoved - this.movingSince > LASTING;
    return lasts ? ladder.quality : { ...ladder.quality, share: this.painter.share };
  }

  // True if the design can be changed in the picture: while it is drawn as it was built.
  private get asBuilt(): boolean {
    const { stat, document } = useStudio.getState();
    if (usePage.getState().mode !== "design" || currentEngine()?.kind !== "server") return false;
    return (document?.valid ?? false) && isAsBuilt(stat);
  }

  // The middle of the entry chosen in the form, where it can be moved.
  private middleToMove(view: View): Vector3 | null {
    const { body } = useStudio.getState();
    if (!view.chosen || !body || !this.asBuilt) return null;
    if (body.bodies.length === 0 && view.chosen === BODY) return null;
    const room = roomOf(view.chosen, body);
    return room && new Vector3(...room.low).add(new Vector3(...room.high)).multiplyScalar(0.5);
  }

  // The chosen object, where its shape can be sized: its place in the design, its shape, half its size in m.
  private objectToSize(view: View): { index: number; shape: unknown; half: number } | null {
    const { body, document } = useStudio.getState();
    const objects = (document?.source?.objects ?? []) as readonly {
      name?: unknown;
      shape?: unknown;
    }[];
    const index = Array.isArray(objects)
      ? objects.findIndex((one) => one.name === view.chosen)
      : -1;
    const shape = objects[index]?.shape;
    if (!body || !view.chosen || !resized(shape, 1)) return null;
    const room = roomOf(view.chosen, body);
    if (!room) return null;
    return { index, shape, half: Math.max(...room.low.map((x, i) => room.high[i]! - x)) / 2 };
  }

  // The chosen shape with its grips, where it is drawn.
  private shapeToEdit(view: View): Edited | null {
    const frame = view.shape !== null && this.asBuilt ? this.ghosts.frameOf(view.shape) : null;
    if (!frame || view.shape === null) return null;
    const { document } = useStudio.getState();
    const key = [document, frame.box, view.shape];
    if (!this.shapeGrips || key.some((one, i) => one !== this.shapeGrips?.key[i])) {
      const { source, design, parameters } = document!;
      const grips = shapeGrips(view.shape, source ?? {}, design, parameters, frame.box);
      this.shapeGrips = { key, grips };
    }
    return { ...frame, grips: this.shapeGrips.grips };
  }

  // A recorded picture is whole, however long it takes.
  private moving(now: number): boolean {
    if (useShown.getState().recording) return false;
    return useStudio.getState().stat?.state === "playing" || now - this.lastMoved < SETTLED;
  }

  private takeFrame(now: number): boolean {
    const taken = this.gate.take((number) => currentEngine()?.acknowledge(number));
    if (!taken) return false;
    const fields = useStudio.getState().hello?.fields;
    const frame = withoutDust(taken, fields?.find((one) => one.id === taken.field)?.unit);
    if (this.coming?.suits(frame)) this.exchange(this.coming);
    const wanted = useView.getState().appearance === "tets";
    const meshes = wanted ? [this.tets, this.surface] : [this.surface, this.tets];
    const mesh = meshes.find((one) => one?.suits(frame));
    if (!mesh) return false; // a frame of a body that is gone
    mesh.setFrame(frame);
    // A frame may be sent again, as with the colors of another field: that is no other state.
    const settled = frame.atRest && !(this.latest?.atRest && this.latest.number === frame.number);
    if (settled) this.follow(mesh.box(useView.getState().exaggeration));
    this.unseen ||= this.latest === null;
    this.latest = frame;
    this.extremes = null;
    this.colors = null;
    this.times.push(now);
    if (frame.seq > this.lastSeq) {
      this.lastSeq = frame.seq;
      this.latency = sinceSent(frame.seq) ?? this.latency;
    }
    return true;
  }

  // A body that came to rest outside of the picture is brought into it, unless a hand chose that.
  private follow(box: Box3, atOnce = false): void {
    if (!this.rig.steered && !this.rig.holds(box)) this.rig.fit(box.clone(), atOnce);
  }

  // A body shown elsewhere first than unloaded is fitted too, with the things it holds.
  private seeFirst(view: View, mesh: BodyMesh | null): void {
    if (!this.unseen || !mesh) return;
    this.unseen = false;
    this.follow(this.objects.around(mesh.box(view.exaggeration)), true);
  }

  /** The mesh that is drawn: the tetrahedra where they are wanted and at hand. */
  shownMesh(): BodyMesh | null {
    const wanted = useView.getState().appearance === "tets";
    return wanted && this.tets?.frame ? this.tets : this.surface;
  }

  /** The smooth shape, where it is drawn in place of the voxels. */
  private get drawnSmooth(): SmoothMesh | null {
    const appearance = appearanceOf(useView.getState(), useStudio.getState().body);
    return appearance === "smooth" ? this.smooth : null;
  }

  private style(view: View, mesh: BodyMesh | null): void {
    const parts = partColors(useStudio.getState().body, view.chosen);
    const colors = { parts, ink: this.ink };
    const smooth = this.drawnSmooth !== null;
    const [low, high] = this.range(view);
    for (const one of [this.surface, this.tets]) {
      one?.setRange(low, high);
      one?.setPixels(this.renderer.domElement.height / 2);
      one?.style(view, colors, one === mesh, smooth);
    }
    if (this.surface) this.smooth?.style(view, colors, smooth, this.surface);
    if (smooth && this.surface) this.smooth?.follow(this.surface, view.exaggeration);
    const box = mesh?.box(view.exaggeration) ?? new Box3();
    this.section.update(
      view,
      box,
      view.appearance !== "wireframe" && !view.cavities && !mesh?.topology.tets,
    );
    const filled = modeOf(view) === "solid" ? this.surface : null;
    this.fill.update(filled, this.section.plane.value, view.exaggeration);
    this.painter.backdrop.ground.mesh.visible = view.grid && (this.bare || mesh !== null);
    const { body, moments } = useStudio.getState();
    this.objects.group.visible = body !== null && body.topology === mesh?.topology.id;
    const moment = moments.get(this.latest?.number ?? 0);
    const { factor } = this.sizer;
    this.objects.sized = view.chosen && factor !== 1 ? { name: view.chosen, factor } : null;
    this.objects.place(moment, view.exaggeration, view.chosen, this.ofContact);
    this.forces.group.visible = view.forces;
    if (view.forces)
      this.forces.place(body, moments, moment, this.surface, this.objects, view.exaggeration);
    const moved = this.mover.shift.some((one) => one !== 0);
    if (moved && body && view.chosen) this.several.placeMoved(body, view.chosen, this.mover.shift);
    else this.several.place(body, this.surface, view.chosen, view.exaggeration);
    this.ghosts.group.visible = this.asBuilt;
    this.ghosts.place(view.shape, this.shaper.preview, this.pixels);
    this.faceMark.place(useFace.getState().face, this.surface, view.exaggeration);
    this.symbols.group.visible = view.symbols;
    // They stay where the unloaded body has them.
    this.contactMarks.group.visible = view.symbols && isAsBuilt(useStudio.getState().stat);
    this.attachments.group.visible = view.symbols;
  }

  private get pixels(): { x: number; y: number; ratio: number } {
    const { width: x, height: y } = this.renderer.domElement;
    return { x, y, ratio: this.renderer.getPixelRatio() };
  }

  private range(view: View): [number, number] {
    if (view.range === "locked") return [view.low, view.high];
    const { low, high } = this.colorRange();
    if (view.range === "auto") return [low, high];
    const most = Math.max(Math.abs(low), Math.abs(high));
    return [-most, most];
  }

  private colorRange(): ColorRange {
    const frame = this.latest;
    const mesh = frame && [this.surface, this.tets].find((one) => one?.suits(frame));
    const whole = { low: frame?.min ?? 0, high: frame?.max ?? 1, clipped: [] };
    // Most of a body is pressed by nothing, so that 99 % of its area say little of contact.
    if (!frame || !mesh || this.ofContact) return whole;
    this.colors ??= colorRange(frame, mesh.topology);
    return this.colors;
  }

  // True if the coloring field is one of contact.
  private get ofContact(): boolean {
    const { field, coloring } = useView.getState();
    const about = useStudio.getState().hello?.fields.find((one) => one.id === field);
    return coloring === "field" && (about?.contact ?? false);
  }

  private words(view: View, mesh: BodyMesh | null): Label[] {
    if (!mesh) return [];
    const { body, stat, overlap } = useStudio.getState();
    const labels = overlapLabels(overlapOf(overlap, mesh.topology.id), view.exaggeration, (place) =>
      this.showOverlap(place),
    );
    // A shape comes before its words, which speak of vertices that another one may not have.
    if (body?.topology === mesh.topology.id && view.symbols) {
      labels.push(...this.symbols.labels(body, stat, mesh, view.exaggeration, view.cavities));
      labels.push(...this.attachments.update(mesh, view.exaggeration, body.loads, stat));
      labels.push(...this.objects.labels());
      if (this.contactMarks.group.visible) {
        const design = useStudio.getState().document?.design ?? null;
        labels.push(...this.contactMarks.labels(body, design, view.chosen));
      }
      if (view.forces) labels.push(...this.forces.labels());
      labels.push(...this.several.labels(body, this.surface, view.chosen, view.exaggeration));
    }
    if (this.ghosts.group.visible && view.symbols) labels.push(...this.ghosts.labels());
    // If all values are the same there is no least and no greatest.
    const varies = mesh.frame && mesh.frame.max > mesh.frame.min;
    if (view.extremes && varies && view.coloring === "field")
      labels.push(...this.extremeWords(mesh, view));
    const places = this.places;
    if (places) {
      const middleOf = (object: number) => this.objects.middleAt(object);
      labels.push(...this.grabs.update(places, middleOf));
    }
    if (places) labels.push(...this.spot.labels(places, view.exaggeration));
    const tape = places ? this.tape.update(places, view.exaggeration) : null;
    if (tape) labels.push(...tape.labels);
    if (tape && tape.length !== useShown.getState().tapeLength) {
      useShown.setState({ tapeLength: tape.length });
    }
    return labels;
  }

  private extremeWords(mesh: BodyMesh, view: View): Label[] {
    const frame = mesh.frame as Frame;
    if (!this.extremes) {
      let [low, high] = [0, 0];
      for (let i = 3; i < frame.packed.length; i += 4) {
        if (frame.packed[i]! < frame.packed[low + 3]!) low = i - 3;
        if (frame.packed[i]! > frame.packed[high + 3]!) high = i - 3;
      }
      this.extremes = { low: low / 4, high: high / 4 };
    }
    const word = (key: "low" | "high", text: string): Label => {
      const vertex = this.extremes![key];
      return {
        key: `extreme-${key}`,
        kind: "extreme",
        text,
        at: (out) => mesh.place(vertex, view.exaggeration, out),
      };
    };
    return [word("low", "min"), word("high", "max")];
  }

  private tell(now: number, view: View): void {
    const every = ladder.slow ? TELL_EVERY_WHERE_SLOW : TELL_EVERY;
    this.times = this.times.filter((time) => now - time < 1000);
    if (this.tellTimer === null && (this.times.length > 0 || now - this.lastTold < every)) {
      this.tellTimer = setTimeout(() => {
        this.tellTimer = null;
        this.tell(performance.now(), useView.getState());
      }, every);
    }
    if (now - this.lastTold < every) return;
    this.lastTold = now;
    const [low, high] = this.range(view);
    const pixels = this.rig.pixelsPerMeter;
    const barLength = roundLength(130 / pixels);
    const frame = this.latest;
    const next = {
      frame: frame?.number ?? 0,
      time: frame?.time ?? 0,
      fps: this.times.length,
      latency: this.latency,
      field: frame?.field ?? 0,
      low,
      high,
      min: frame?.min ?? 0,
      max: frame?.max ?? 0,
      clipped: view.range === "locked" ? [] : this.colorRange().clipped,
      forceScale: this.forces.scale,
      barLength,
      barPixels: barLength * pixels,
      diverged: frame?.diverged ?? false,
    };
    const shown = useShown.getState();
    const same = (Object.keys(next) as (keyof typeof next)[]).every(
      (key) => next[key] === shown[key],
    );
    if (!same) useShown.setState(next);
  }

  // ---- the pointer ----

  ray(x: number, y: number): Raycaster["ray"] {
    const rect = this.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(
      ((x - rect.left) / rect.width) * 2 - 1,
      1 - ((y - rect.top) / rect.height) * 2,
    );
    this.raycaster.setFromCamera(at, this.rig.camera);
    return this.raycaster.ray;
  }

  /** Choose the body that has a drawn vertex, where there are several. */
  choose(vertex: number): void {
    const entry = this.several.entryAt(useStudio.getState().body, vertex);
    if (entry) setView({ chosen: entry });
  }

  /** Mark the face of the body that was pressed, for the actions there. */
  chooseFace(hit: Target): void {
    const topology = this.surface?.topology;
    // A page of its own has no design that could be changed.
    if (!topology || currentEngine()?.kind !== "server") return;
    const { x, y, z } = this.rig.toEye;
    const triangle = triangleAt(topology, hit.triangle, [x, y, z]);
    const smooth = this.smooth?.vertices ?? null;
    chooseFace(triangle === null ? null : faceAt(topology, triangle, smooth));
    this.request();
  }

  /** Point of the body at a place of the page. */
  hit(x: number, y: number): Target | null {
    const view = useView.getState();
    const [surface, mesh] = [this.surface, this.shownMesh()];
    if (!surface || !mesh) return null;
    const keep = (point: Vector3) => this.section.keeps(point);
    const positions = this.drawnPositions(mesh, view);
    return targetOf(this.ray(x, y), surface, mesh, positions, this.drawnSmooth, keep);
  }

  /** Choose the ghost at a place of the page where no body is; none where there is none. */
  chooseGhost(x: number, y: number): void {
    if (this.ghosts.group.visible) setView({ shape: this.ghosts.hit(this.ray(x, y)) });
  }

  /** The free object under the pointer, in front of the body. */
  hitObject(x: number, y: number): ReturnType<RigidObjects["hit"]> {
    if (!this.objects.group.visible) return null;
    const found = this.objects.hit(this.ray(x, y));
    const body = found && this.hit(x, y);
    const far = (point: Vector3) => point.distanceToSquared(this.ray(x, y).origin);
    return found && body && far(body.point) < far(found.point) ? null : found;
  }

  /** Positions where the vertices of the surface are drawn, also where tetrahedra stand for it. */
  get places(): Places | null {
    const [surface, mesh] = [this.surface, this.shownMesh()];
    if (!surface || !mesh || mesh === surface) return surface;
    if (this.tetPlaces?.tets !== mesh) this.tetPlaces = new TetPlaces(surface, mesh);
    return this.tetPlaces;
  }

  private drawnPositions(mesh: BodyMesh, view: View): Float32Array {
    const key = `${mesh.topology.id} ${mesh.topology.tets} ${mesh.frame?.number} ${mesh.frame?.time} ${view.exaggeration}`;
    if (this.positions?.key === key) return this.positions.values;
    const n = mesh.topology.rest.length / 3;
    const values = new Float32Array(3 * n);
    const at = new Vector3();
    for (let i = 0; i < n; i++) mesh.place(i, view.exaggeration, at).toArray(values, 3 * i);
    this.positions = { key, values };
    return values;
  }

  hoverOver(at: { x: number; y: number } | null): void {
    this.hoverAt = at;
    if (at === null && useShown.getState().hover) useShown.setState({ hover: null });
    else if (at && this.hoverTimer === null) {
      // Looked up at leisure; nothing has to be drawn for it.
      this.hoverTimer = setTimeout(() => {
        this.hoverTimer = null;
        this.hover(performance.now(), useView.getState());
      }, HOVER_EVERY);
    }
  }

  private hover(now: number, view: View): void {
    if (!this.hoverAt || this.grabs.holding || now - this.lastHover < HOVER_EVERY) return;
    this.lastHover = now;
    const hit = this.hit(this.hoverAt.x, this.hoverAt.y);
    const frame = this.shownMesh()?.frame;
    const object = this.hitObject(this.hoverAt.x, this.hoverAt.y);
    const pulled = (hit || object) && !useStudio.getState().body?.not_live;
    this.renderer.domElement.style.cursor = view.tape ? "crosshair" : pulled ? "grab" : "";
    if (!hit || !frame || view.coloring !== "field") {
      if (useShown.getState().hover) useShown.setState({ hover: null });
      return;
    }
    const rect = this.element.getBoundingClientRect();
    useShown.setState({
      hover: {
        x: this.hoverAt.x - rect.left,
        y: this.hoverAt.y - rect.top,
        vertex: hit.vertex,
        value: valueIn(frame, hit.drawn),
      },
    });
  }

  // ---- requests of buttons and keys ----

  /** Take the body that comes next in whole: the requested change makes it larger. */
  fitSoon(): void {
    this.fitNext = true;
  }

  fit(): void {
    const mesh = this.shownMesh();
    const box = mesh?.box(useView.getState().exaggeration).clone();
    if (!box) return;
    const all = this.objects.around(box);
    for (const name of this.ghostNames) {
      const own = this.ghosts.boxOf(name);
      if (own) all.union(own);
    }
    this.rig.fit(all);
    this.request();
  }

  /** Fly to a point of the unloaded body, where it is now, and mark it with a word. */
  showPlace(at: readonly [number, number, number], text: string): void {
    const places = this.places;
    if (!places) return;
    const vertex = this.spot.mark(at, text, places);
    const box = this.shownMesh()?.box(useView.getState().exaggeration);
    const near = box ? box.getSize(new Vector3()).length() : 0;
    this.rig.closeTo(places.place(vertex, useView.getState().exaggeration), near);
    this.request();
  }

  /** Fly to a place where the body is in itself. */
  showOverlap(place: OverlapPlace): void {
    const { exaggeration } = useView.getState();
    const box = this.shownMesh()?.box(exaggeration);
    const near = box ? 0.5 * box.getSize(new Vector3()).length() : 0;
    this.rig.closeTo(drawnAt(place, exaggeration, new Vector3()), near);
    this.request();
  }

  look(view: StandardView): void {
    this.rig.look(view);
    const { section } = useView.getState();
    if (section !== "off" && section !== "free") this.cutAcross(section);
    this.request();
  }

  /** Cut the body across an axis, open on the side that faces the eye; edge on, as it is. */
  cutAcross(section: "x" | "y" | "z"): void {
    const along = this.rig.aimedEye[section];
    if (Math.abs(along) > EDGE_ON) setView({ section, sectionFlipped: along < 0 });
    else setView({ section });
  }

  /** Cut the body open on the side that faces the eye, or close it again. */
  toggleSection(): void {
    if (useView.getState().section !== "off") {
      setView({ section: "off" });
      return;
    }
    const eye = this.rig.aimedEye;
    setView({ sectionAt: 0.5 });
    this.cutAcross(Math.abs(eye.x) > Math.abs(eye.y) ? "x" : "y");
  }

  // ---- readings for tests and measurements ----

  get drawn(): {
    frame: number;
    time: number;
    seq: number;
    latency: number | null;
    triangles: number;
    topology: number;
    fps: number;
  } {
    const mesh = this.shownMesh();
    return {
      frame: this.latest?.number ?? 0,
      time: this.latest?.time ?? 0,
      seq: this.lastSeq,
      latency: this.latency,
      triangles: (mesh?.triangles ?? 0) + (this.smooth?.count ?? 0),
      topology: this.drawnTopology,
      fps: this.times.length,
    };
  }

  vertexPosition(vertex: number): [number, number, number] | null {
    const frame = this.surface?.frame;
    return frame && 4 * vertex < frame.packed.length ? positionIn(frame, vertex) : null;
  }

  /** Position where the middle of a rigid object is drawn, m. */
  objectPosition(name: string): [number, number, number] | null {
    return this.objects.middleOf(name);
  }

  /** Shapes that are drawn by themselves. */
  get ghostNames(): readonly string[] {
    return this.ghosts.group.visible ? this.ghosts.names : [];
  }

  /** Lowest and highest corner of one of them, m. */
  ghostBox(name: string): [number[], number[]] | null {
    const box = this.ghosts.boxOf(name);
    return box && [box.min.toArray(), box.max.toArray()];
  }

  /** Number of drawn triangles of a section through the field. */
  get cut(): number {
    return this.fill.triangles;
  }

  /** Position of a vertex on the page, in CSS pixels. */
  screenOf(vertex: number): [number, number] | null {
    if (!this.surface) return null;
    const at = this.surface.place(vertex, useView.getState().exaggeration).project(this.rig.camera);
    const rect = this.renderer.domElement.getBoundingClientRect();
    return [rect.left + ((at.x + 1) / 2) * rect.width, rect.top + ((1 - at.y) / 2) * rect.height];
  }

  /** Draw now and whole, at `scale` times the size of the page or as fine as the screen. */
  still<T>(scale: number | undefined, use: (canvas: HTMLCanvasElement) => T): T {
    this.painter.prepare(WHOLE, scale);
    this.surface?.setPixels(this.renderer.domElement.height / 2);
    this.painter.paint(this.scene, this.rig.camera, WHOLE.smooth);
    try {
      return use(this.renderer.domElement);
    } finally {
      this.request(); // at the size of the page again
    }
  }
}
