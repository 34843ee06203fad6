// Relation of a job to the open document: of its design, of an earlier state of it, or of another one.
import type { DocumentEvent, SubjectEvent } from "../../protocol";

export type Standing = "present" | "earlier" | "other";

/** Standing of a job whose design is not known is "present": nothing can be said against it. */
export function standing(
  subject: SubjectEvent | undefined,
  document: Pick<DocumentEvent, "id" | "hash" | "design"> | null,
): Standing {
  if (!subject || !document) return "present";
  if (subject.hash === document.hash) return "present";
  // A job of an earlier studio knows no document: the name of its design stands for that.
  const own = subject.document
    ? subject.document === document.id
    : subject.design === document.design?.name;
  return own ? "earlier" : "other";
}
