// Pictures and films of the view.

import { factorOf, formatNumber, shownUnit, unitText } from "../controls/units";
import { toast, useStudio } from "../store/studio";
import { useShown, useView } from "../store/view";
import { colorAt } from "./body/colormaps";
import type { Viewport } from "./viewport";

const GIF_WIDTH = 640;
const GIF_EVERY = 80; // ms; browsers slow down GIFs that are faster
const GIF_LONGEST = 250;

export function download(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function nameFor(extension: string): string {
  const name = useStudio.getState().document?.name.replace(/\.toml$/, "") || "voxsoft";
  const time = useShown.getState().time;
  return `${name}-${time.toFixed(3)}s.${extension}`;
}

/** The view as drawn with its legend, at `scale` times the size of the page. */
export async function picture(view: Viewport, scale: number): Promise<Blob> {
  const canvas = view.still(scale, (drawn) => {
    const copy = document.createElement("canvas");
    copy.width = drawn.width;
    copy.height = drawn.height;
    const context = copy.getContext("2d") as CanvasRenderingContext2D;
    context.drawImage(drawn, 0, 0);
    drawLegend(context, scale);
    return copy;
  });
  return new Promise((resolve, reject) =>
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error("the picture is too large"))),
      "image/png",
    ),
  );
}

export async function savePicture(view: Viewport, scale: number): Promise<void> {
  try {
    download(await picture(view, scale), nameFor("png"));
  } catch (error) {
    toast({ level: "error", what: "No picture was made", hint: String(error) });
  }
}

function drawLegend(context: CanvasRenderingContext2D, scale: number): void {
  const { coloring, colormap, field } = useView.getState();
  const about = useStudio.getState().hello?.fields.find((one) => one.id === field);
  if (coloring !== "field" || !about) return;
  const { low, high } = useShown.getState();
  const unit = shownUnit(about.unit);
  const style = getComputedStyle(document.documentElement);
  context.save();
  context.scale(scale, scale);
  const [x, y, w, h] = [context.canvas.width / scale - 96, 44, 12, 180];
  for (let i = 0; i < h; i++) {
    context.fillStyle = `rgb(${colorAt(colormap, 1 - i / h).join(" ")})`;
    context.fillRect(x, y + i, w, 1.5);
  }
  context.fillStyle = style.getPropertyValue("--text");
  context.font = `12px ${style.getPropertyValue("--font")}`;
  context.textBaseline = "middle";
  const text = (share: number) => formatNumber((low + (high - low) * share) / factorOf(unit), 3);
  for (const share of [0, 0.25, 0.5, 0.75, 1])
    context.fillText(text(share), x + w + 8, y + h * (1 - share));
  context.textAlign = "right";
  context.fillText(`${about.title} ${unitText(unit) && `[${unitText(unit)}]`}`, x + w + 60, y - 18);
  context.restore();
}

/** Record until the function that is given back is called. */
export function recordWebm(view: Viewport): () => void {
  const stream = view.still(undefined, (canvas) => canvas.captureStream(30));
  const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((one) =>
    MediaRecorder.isTypeSupported(one),
  );
  if (!type) {
    toast({ level: "error", what: "This browser records no WebM", hint: "Record a GIF instead." });
    return () => {};
  }
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 12_000_000 });
  const chunks: Blob[] = [];
  recorder.ondataavailable = (event) => chunks.push(event.data);
  recorder.onstop = () => {
    for (const track of stream.getTracks()) track.stop();
    download(new Blob(chunks, { type: "video/webm" }), nameFor("webm"));
    useShown.setState({ recording: null });
  };
  recorder.start(500);
  useShown.setState({ recording: "webm" });
  return () => recorder.state !== "inactive" && recorder.stop();
}

/** Record a GIF of at most 20 s until the function that is given back is called. */
export async function recordGif(view: Viewport): Promise<() => void> {
  const { GIFEncoder, quantize, applyPalette } = await import("gifenc");
  const source = view.renderer.domElement;
  const width = Math.min(GIF_WIDTH, Math.round(source.clientWidth * devicePixelRatio));
  const height = Math.round((source.clientHeight * width) / source.clientWidth);
  const small = document.createElement("canvas");
  small.width = width;
  small.height = height;
  const context = small.getContext("2d", { willReadFrequently: true }) as CanvasRenderingContext2D;
  const gif = GIFEncoder();
  let frames = 0;
  let last = 0;
  const add = () => {
    const now = performance.now();
    if (now - last < GIF_EVERY) return;
    const delay = last === 0 ? GIF_EVERY : Math.min(500, now - last);
    last = now;
    context.drawImage(source, 0, 0, width, height);
    const { data } = context.getImageData(0, 0, width, height);
    const palette = quantize(data, 128);
    gif.writeFrame(applyPalette(data, palette), width, height, { palette, delay });
    frames += 1;
    if (frames >= GIF_LONGEST) stop();
  };
  const off = view.onDrawn(add);
  let stopped = false;
  const stop = () => {
    if (stopped) return;
    stopped = true;
    off();
    if (frames === 0) add();
    gif.finish();
    download(
      new Blob([gif.bytes() as Uint8Array<ArrayBuffer>], { type: "image/gif" }),
      nameFor("gif"),
    );
    useShown.setState({ recording: null });
  };
  useShown.setState({ recording: "gif" });
  view.request();
  return stop;
}
