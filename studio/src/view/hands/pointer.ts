// Actions of the mouse: turn, move, zoom, pull, pick, measure.
import { chooseFace, useFace } from "../../store/face";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { setView, useView } from "../../store/view";
import type { Viewport } from "../viewport";
import { type Motion, motionOf, steer } from "./schemes";
import type { Target } from "./target";

// A press that moves less than this, in pixels, is a click.
const STILL = 4;

type Gesture =
  | { kind: "steer"; motion: Motion }
  | { kind: "maybe-pull"; hit: Target }
  | { kind: "maybe-hold"; object: NonNullable<ReturnType<Viewport["hitObject"]>> }
  | { kind: "pull" };

export function listen(view: Viewport): void {
  const canvas = view.renderer.domElement;
  let gesture: Gesture | null = null;
  let start = { x: 0, y: 0 };
  let last = { x: 0, y: 0 };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    start = last = { x: event.clientX, y: event.clientY };
    const hit = event.button === 0 && !event.altKey ? view.hit(event.clientX, event.clientY) : null;
    const object =
      event.button === 0 && !event.altKey ? view.hitObject(event.clientX, event.clientY) : null;
    const motion = hit ? null : motionOf(useView.getState().scheme, event);
    if (object && mayPull()) gesture = { kind: "maybe-hold", object };
    else if (hit) gesture = { kind: "maybe-pull", hit };
    else gesture = motion && { kind: "steer", motion };
    event.preventDefault();
  });

  canvas.addEventListener("pointermove", (event) => {
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    last = { x: event.clientX, y: event.clientY };
    if (!gesture) {
      view.hoverOver({ x: event.clientX, y: event.clientY });
      return;
    }
    if (gesture.kind === "steer") steer(view.rig, gesture.motion, dx, dy);
    else if (gesture.kind === "maybe-pull") {
      const far = Math.hypot(event.clientX - start.x, event.clientY - start.y);
      if (far < STILL) return;
      if (mayPull()) {
        const { vertex } = gesture.hit;
        const at = view.places?.place(vertex, 1);
        if (at) view.grabs.begin(vertex, at, view.rig.toEye);
        view.grabs.move(view.ray(event.clientX, event.clientY));
        gesture = { kind: "pull" };
        view.hoverOver(null);
        canvas.style.cursor = "grabbing";
        if (useStudio.getState().stat?.state !== "playing") send({ t: "play" });
      } else gesture = { kind: "steer", motion: "turn" };
    } else if (gesture.kind === "maybe-hold") {
      const far = Math.hypot(event.clientX - start.x, event.clientY - start.y);
      if (far < STILL) return;
      const { index, point, middle } = gesture.object;
      view.grabs.beginObject(index, point, middle, view.rig.toEye);
      view.grabs.move(view.ray(event.clientX, event.clientY));
      gesture = { kind: "pull" };
      view.hoverOver(null);
      canvas.style.cursor = "grabbing";
      if (useStudio.getState().stat?.state !== "playing") send({ t: "play" });
    } else view.grabs.move(view.ray(event.clientX, event.clientY));
    view.request();
  });

  const finish = (event: PointerEvent) => {
    if (gesture?.kind === "pull") view.grabs.end(event.shiftKey);
    else if (gesture?.kind === "maybe-pull") clicked(view, gesture.hit);
    else if (gesture?.kind === "steer" && event.button === 0) {
      const far = Math.hypot(event.clientX - start.x, event.clientY - start.y);
      if (far < STILL) view.chooseGhost(event.clientX, event.clientY);
    }
    gesture = null;
    canvas.style.cursor = "";
    view.request();
  };
  canvas.addEventListener("pointerup", finish);
  canvas.addEventListener("pointercancel", finish);
  canvas.addEventListener("pointerleave", () => {
    if (!gesture) view.hoverOver(null);
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  // Without a mouse the middle of the picture is pressed.
  canvas.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const hit = view.hit(left + width / 2, top + height / 2);
    if (!hit) return;
    event.preventDefault();
    useFace.setState({ byKey: true });
    clicked(view, hit);
  });

  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const clicks = event.deltaMode === 1 ? event.deltaY / 3 : event.deltaY / 100;
      if (view.grabs.holding) {
        const depth = -clicks * 0.02 * (canvas.clientHeight / view.rig.pixelsPerMeter);
        view.grabs.deeper(depth, view.ray(event.clientX, event.clientY));
      } else {
        const rect = canvas.getBoundingClientRect();
        const x = ((event.clientX - rect.left) / rect.width) * 2 - 1;
        const y = 1 - ((event.clientY - rect.top) / rect.height) * 2;
        view.rig.zoom(1.12 ** clicks, x, y);
      }
      view.request();
    },
    { passive: false },
  );

  canvas.addEventListener("dblclick", (event) => {
    const hit = view.hit(event.clientX, event.clientY);
    if (hit) view.rig.turnAbout(hit.point);
    view.request();
  });

  addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    if (view.grabs.holding) {
      view.grabs.end(false);
      gesture = null;
    } else if (useView.getState().tape) setView({ tape: false });
    else if (useStudio.getState().picked || useFace.getState().face) {
      chooseFace(null);
      useStudio.setState({ picked: null });
    } else if (event.target instanceof HTMLInputElement) setView({ chosen: null });
    else setView({ chosen: null, shape: null });
    view.request();
  });
}

// Pulling needs a present to pull on, in the place where it is drawn.
function mayPull(): boolean {
  const state = useStudio.getState().stat?.state;
  const view = useView.getState();
  const moving = state === "playing" || state === "paused" || state === "at-rest";
  if (useStudio.getState().body?.not_live) return false;
  return moving && !view.tape && view.exaggeration === 1;
}

function clicked(view: Viewport, hit: Target): void {
  if (useView.getState().tape) view.tape.add(hit);
  else {
    send({ t: "pick", vertex: hit.vertex });
    view.choose(hit.vertex);
    view.chooseFace(hit);
  }
}
