// The face of the body that was pressed, until another is or the body is another.
import { create } from "zustand";
import type { Face } from "../view/face";

export const useFace = create<{ face: Face | null }>(() => ({ face: null }));

export function chooseFace(face: Face | null): void {
  useFace.setState({ face });
}
