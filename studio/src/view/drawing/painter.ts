// Draws the scene in front of its backdrop, whole or without slow parts.
import {
  type Camera,
  LinearSRGBColorSpace,
  type Scene,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { Backdrop } from "./backdrop";
import { Copy } from "./copy";
import { type Quality, WHOLE } from "./quality";

const SAMPLES = 4;

export class Painter {
  readonly backdrop = new Backdrop();
  readonly renderer: WebGLRenderer;
  // The canvas itself cannot change its samples, so smoothed pictures come from here.
  private readonly smoothed = new WebGLRenderTarget(1, 1, {
    samples: SAMPLES,
    stencilBuffer: true,
  });
  private readonly copy = new Copy(this.smoothed.texture);
  /** Pixels along a side as a share of those of the screen, in the latest picture. */
  share = WHOLE.share;
  private width = 1;
  private height = 1;

  constructor() {
    this.renderer = new WebGLRenderer({ antialias: false, stencil: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  /** Set the size on the page, in CSS pixels; it counts from the next picture on. */
  resize(width: number, height: number): void {
    [this.width, this.height] = [width, height];
    const { style } = this.canvas;
    style.width = `${width}px`;
    style.height = `${height}px`;
  }

  /** Set the pixels of the canvas; `ratio` is how many there are to a CSS pixel when whole. */
  prepare(quality: Quality, ratio = Math.min(2, devicePixelRatio)): void {
    const { renderer } = this;
    const wanted = ratio * quality.share;
    this.share = quality.share;
    const { width, height } = this.canvas;
    const fits =
      Math.floor(this.width * wanted) === width && Math.floor(this.height * wanted) === height;
    if (fits && renderer.getPixelRatio() === wanted) return;
    renderer.setPixelRatio(wanted);
    renderer.setSize(this.width, this.height, false);
  }

  /** Draw a picture of the prepared size. */
  paint(scene: Scene, camera: Camera, smooth: boolean): void {
    const { renderer, smoothed, canvas } = this;
    if (smooth) smoothed.setSize(canvas.width, canvas.height);
    renderer.setRenderTarget(smooth ? smoothed : null);
    renderer.clear(false, true, true); // the backdrop covers all colors
    this.backdrop.paint(renderer, camera);
    renderer.render(scene, camera);
    if (!smooth) return;
    renderer.setRenderTarget(null);
    renderer.render(this.copy.scene, camera);
  }
}
