// Tables that were dropped to be laid over a path. Kept while the page is there.
import { create } from "zustand";
import type { DocumentEvent } from "../../protocol";
import { useStudio } from "../../store/studio";

export interface PathTable {
  readonly name: string;
  readonly text: string;
  /** Document that was open: a curve says nothing about another one. */
  readonly of: string;
  /** Number that it was laid over first, which holds for a table without units alone. */
  readonly column: string | null;
}

interface PathTables {
  /** The newest first. */
  readonly tables: readonly PathTable[];
  /** Chosen number along the path; empty for the one that suits. */
  readonly column: string;
}

export const usePathTables = create<PathTables>(() => ({ tables: [], column: "" }));

/** Mark of a document among tables. */
export function markOf(document: DocumentEvent | null): string {
  return document?.id ?? "";
}

/** Lay a table over the path that is there, or over the next one. */
export function addCurve(name: string, text: string): void {
  const of = markOf(useStudio.getState().document);
  usePathTables.setState(({ tables }) => ({
    tables: [{ name, text, of, column: null }, ...tables.filter((one) => one.name !== name)],
    column: "",
  }));
}

export function removeCurve(name: string): void {
  usePathTables.setState(({ tables }) => ({ tables: tables.filter((one) => one.name !== name) }));
}

/** Show another number; tables without units stay with the one that was shown. */
export function showColumn(column: string, shown: string): void {
  usePathTables.setState(({ tables }) => ({
    tables: tables.map((one) => ({ ...one, column: one.column ?? shown })),
    column,
  }));
}
