// Context of the document that every field of the form needs.
import { createContext, useContext } from "react";
import type { Amounts } from "../../controls/formula";
import type { Diagnostic } from "../../protocol";
import type { Schema } from "./fields/schema";
import type { Names } from "./fields/starters";

export interface Form {
  readonly root: Schema;
  /** The document as it is written. */
  readonly source: Readonly<Record<string, unknown>>;
  /** The last good design with its formulas worked out, in SI. */
  readonly design: Readonly<Record<string, unknown>> | null;
  readonly diagnostics: readonly Diagnostic[];
  readonly names: Names;
  /** Parameters for formulas. */
  readonly amounts: Amounts;
  readonly materialTitles: Readonly<Record<string, string>>;
}

export const FormContext = createContext<Form | null>(null);

export function useForm(): Form {
  const form = useContext(FormContext);
  if (!form) throw new Error("a field of the form stands outside of it");
  return form;
}
