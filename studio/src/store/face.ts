// The face of the body that was pressed, until another is or the body is another; and where a tendon begins.
import { create } from "zustand";
import type { Face } from "../view/face";

/** A place as it is written. */
export type WrittenPlace = readonly (string | number)[];

/** Where a tendon begins that has no other place yet, and of which design. */
interface TendonBegun {
  readonly place: WrittenPlace;
  readonly design: string;
}

export const useFace = create<{ face: Face | null; tendon: TendonBegun | null }>(() => ({
  face: null,
  tendon: null,
}));

export function chooseFace(face: Face | null): void {
  useFace.setState({ face });
}

export function beginTendon(tendon: TendonBegun | null): void {
  useFace.setState({ tendon });
}
