// Why nothing can be computed of a document yet.
import type { DocumentEvent } from "../../protocol";

/** In words with a remedy; null for a document that is a design. */
export function troubleOf(document: Pick<DocumentEvent, "valid" | "empty">): string | null {
  if (document.empty) return "Give the design a shape first.";
  return document.valid ? null : "Fix the errors of the design first.";
}
