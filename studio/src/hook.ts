// State of the page for tests and measurements; nothing can be changed through it.
import { useStudio } from "./store/studio";
import { viewport } from "./view/instance";

declare global {
  interface Window {
    readonly voxsoft?: {
      readonly frame: number;
      readonly time: number;
      /** Last command that the picture knows of. */
      readonly seq: number;
      /** Milliseconds from a command to the first picture that knows of it. */
      readonly latency: number | null;
      /** Number of drawn triangles of the body: of its voxels, tetrahedra or smooth shape. */
      readonly triangles: number;
      readonly topology: number;
      readonly fps: number;
      readonly state: string;
      readonly rev: number;
      vertexPosition(vertex: number): [number, number, number] | null;
      objectPosition(name: string): [number, number, number] | null;
      /** Shapes that are drawn by themselves, and the corners of each. */
      readonly ghosts: readonly string[];
      ghostBox(name: string): [number[], number[]] | null;
      screenOf(vertex: number): [number, number] | null;
      /** Number of triangles of a section through the field. */
      cut(): number;
    };
  }
}

export function provideHook(): void {
  const drawn = () => viewport().drawn;
  Object.defineProperty(window, "voxsoft", {
    value: Object.freeze({
      get frame() {
        return drawn().frame;
      },
      get time() {
        return drawn().time;
      },
      get seq() {
        return drawn().seq;
      },
      get latency() {
        return drawn().latency;
      },
      get triangles() {
        return drawn().triangles;
      },
      get topology() {
        return drawn().topology;
      },
      get fps() {
        return drawn().fps;
      },
      get state() {
        return useStudio.getState().stat?.state ?? "empty";
      },
      get rev() {
        return useStudio.getState().document?.rev ?? 0;
      },
      get ghosts() {
        return viewport().ghostNames;
      },
      ghostBox: (name: string) => viewport().ghostBox(name),
      vertexPosition: (vertex: number) => viewport().vertexPosition(vertex),
      objectPosition: (name: string) => viewport().objectPosition(name),
      screenOf: (vertex: number) => viewport().screenOf(vertex),
      cut: () => viewport().cut,
    }),
  });
}
