// The face of the body that was pressed, until another is or the body is another; and where a tendon begins.
import { create } from "zustand";
import type { Face } from "../view/hands/face";

/** A place as it is written. */
export type WrittenPlace = readonly (string | number)[];

/** First place of a tendon that has no other yet, and its design. */
interface TendonBegun {
  readonly place: WrittenPlace;
  readonly design: string;
}

interface Pressed {
  readonly face: Face | null;
  readonly tendon: TendonBegun | null;
  /** True if it was pressed by a key: then the keyboard goes on in the card of the place. */
  readonly byKey: boolean;
}

export const useFace = create<Pressed>(() => ({ face: null, tendon: null, byKey: false }));

export function chooseFace(face: Face | null): void {
  useFace.setState({ face });
}

export function beginTendon(tendon: TendonBegun | null): void {
  useFace.setState({ tendon });
}
