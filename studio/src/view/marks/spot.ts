// The place of a finding, marked in the picture until it is dismissed or the body is another.
import type { Vector3 } from "three";
import { nearest, type Places } from "../hands/target";
import type { Label } from "./labels";

export class Spot {
  private marked: { vertex: number; text: string } | null = null;

  constructor(private readonly changed: () => void) {}

  /** Mark a point of the unloaded body; the nearest vertex of its surface carries the mark. */
  mark(at: readonly [number, number, number], text: string, places: Places): number {
    const vertex = nearest(places.topology.rest, ...at);
    this.marked = { vertex, text };
    this.changed();
    return vertex;
  }

  clear(): void {
    this.marked = null;
    this.changed();
  }

  labels(places: Places, exaggeration: number): Label[] {
    const { marked } = this;
    if (!marked) return [];
    return [
      {
        key: "spot",
        kind: "spot",
        text: marked.text,
        title: "Take this mark away",
        at: (out: Vector3) => places.place(marked.vertex, exaggeration, out),
        onClick: () => this.clear(),
      },
    ];
  }
}
