// Pictures of trials: asked for while they are seen, few at a time, and kept until another study.
import { create } from "zustand";

export interface Picture {
  /** Address of a blob; empty where there is none. */
  readonly url: string;
  readonly atRest: boolean;
  /** Width and height of the pictured body, m; 0 where they are not known. */
  readonly width: number;
  readonly height: number;
  /** Why there is none, as a sentence. */
  readonly failure: string;
}

interface Refusal {
  readonly where: string;
  readonly what: string;
}

/** Pictures that are drawn at the same time: the server draws one after the other. */
const AT_ONCE = 2;

export const usePictures = create<Readonly<Record<string, Picture>>>(() => ({}));

let study: string | null = null;
let asking = 0;
const wanted = new Set<string>();

/** The name of a trial's picture. */
export function nameOf(job: string, trial: number): string {
  return `${job}/${trial}`;
}

/** Forget the pictures of another study. */
export function attendPictures(job: string): void {
  if (study === job) return;
  study = job;
  wanted.clear();
  for (const { url } of Object.values(usePictures.getState())) if (url) URL.revokeObjectURL(url);
  usePictures.setState({}, true);
}

/** Ask for a picture once those before it are there. */
export function want(name: string): void {
  if (usePictures.getState()[name]?.url) return;
  wanted.add(name);
  next();
}

/** Ask no more for a picture that is out of sight; one that is being drawn comes. */
export function unwant(name: string): void {
  wanted.delete(name);
}

function next(): void {
  while (asking < AT_ONCE) {
    const name = wanted.values().next().value;
    if (name === undefined) return;
    wanted.delete(name);
    asking++;
    const job = study;
    void fetchPicture(name).then((picture) => {
      asking--;
      if (study === job) usePictures.setState({ [name]: picture });
      else if (picture.url) URL.revokeObjectURL(picture.url);
      next();
    });
  }
}

async function fetchPicture(name: string): Promise<Picture> {
  const none = { url: "", atRest: false, width: 0, height: 0 };
  try {
    const answer = await fetch(`/picture?${new URLSearchParams({ of: `trial/${name}` })}`);
    if (!answer.ok) {
      const { where, what } = (await answer.json()) as Refusal;
      return { ...none, failure: `${where}: ${what}.` };
    }
    const perMeter = Number(answer.headers.get("x-voxsoft-pixels-per-meter"));
    const blob = await answer.blob();
    const { width, height } = await createImageBitmap(blob);
    return {
      url: URL.createObjectURL(blob),
      atRest: answer.headers.get("x-voxsoft-state") === "rest",
      width: perMeter > 0 ? width / perMeter : 0,
      height: perMeter > 0 ? height / perMeter : 0,
      failure: "",
    };
  } catch {
    return { ...none, failure: "VoxSoft does not answer." };
  }
}

/** The longest side of all pictured bodies, m; 0 where none is known. */
export function longestSide(pictures: readonly Picture[]): number {
  return Math.max(0, ...pictures.map(({ width, height }) => Math.max(width, height)));
}

/** Width and height of a picture in a square room, pixels; of one scale where `longest` is known. */
export function sizeIn(
  room: number,
  { width, height }: Pick<Picture, "width" | "height">,
  longest: number,
): { width: number; height: number } {
  const side = Math.max(width, height);
  if (!(side > 0)) return { width: room, height: room };
  const unit = room / (longest > 0 ? longest : side);
  return { width: width * unit, height: height * unit };
}
