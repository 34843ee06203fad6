// The mouse and the keys on bodies at rest: buttons steer as the chosen scheme has it, the wheel
// zooms to the pointer. Nothing is pulled or picked here.
import { useView } from "../../store/view";
import type { StandardView } from "../drawing/camera";
import { type Motion, motionOf, steer } from "../hands/schemes";
import type { StillStage } from "./stage";

const TURN = 24;
const ZOOM = 1.12;
const STANDARD: Readonly<Record<string, StandardView>> = {
  1: "front",
  2: "back",
  3: "left",
  4: "right",
  5: "top",
  6: "bottom",
  7: "corner",
};
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-TURN, 0],
  ArrowRight: [TURN, 0],
  ArrowUp: [0, -TURN],
  ArrowDown: [0, TURN],
};

export function listen(stage: StillStage): void {
  const canvas = stage.renderer.domElement;
  let drag: { motion: Motion; x: number; y: number } | null = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    const motion = motionOf(useView.getState().scheme, event);
    drag = motion && { motion, x: event.clientX, y: event.clientY };
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const [dx, dy] = [event.clientX - drag.x, event.clientY - drag.y];
    const { motion } = drag;
    drag = { motion, x: event.clientX, y: event.clientY };
    stage.steer((rig) => steer(rig, motion, dx, dy));
  });
  const finish = () => {
    drag = null;
  };
  canvas.addEventListener("pointerup", finish);
  canvas.addEventListener("pointercancel", finish);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const clicks = event.deltaMode === 1 ? event.deltaY / 3 : event.deltaY / 100;
      const [x, y] = stage.within(event.clientX, event.clientY);
      stage.steer((rig) => rig.zoom(ZOOM ** clicks, x, y));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    const standard = STANDARD[event.key];
    if (arrow) stage.steer((rig) => rig.turn(...arrow));
    else if (standard) stage.look(standard);
    else if (event.key === "+") stage.steer((rig) => rig.zoom(1 / ZOOM, 0, 0));
    else if (event.key === "-") stage.steer((rig) => rig.zoom(ZOOM, 0, 0));
    else if (event.key === "f") stage.fit();
    else return;
    // These keys steer the main view too, which is not meant here.
    event.stopPropagation();
    event.preventDefault();
  });
}
