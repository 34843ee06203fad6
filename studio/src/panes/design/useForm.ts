// The form of the document that is open.
import { useMemo } from "react";
import type { Amounts } from "../../controls/formula";
import { dimensionOf } from "../../controls/kinds";
import type { DocumentEvent } from "../../protocol";
import { useStudio } from "../../store/studio";
import type { Schema } from "./fields/schema";
import type { Form } from "./form";
import { wellFormed } from "./sections";

export const NO_DIAGNOSTICS: Form["diagnostics"] = [];

/** Content of the form, or null while no text can be read as a table of values. */
export function useFormOfDocument(): Form | null {
  const hello = useStudio((state) => state.hello);
  const document = useStudio((state) => state.document);
  return useMemo(() => {
    if (!hello || !document?.source) return null;
    const root = hello.design_schema as Schema;
    const source = wellFormed(document.source, root);
    const keys = (section: string) => Object.keys((source[section] as object | undefined) ?? {});
    return {
      root,
      source,
      design: document.design,
      diagnostics: document.diagnostics.length ? document.diagnostics : NO_DIAGNOSTICS,
      names: {
        shapes: keys("shapes"),
        materials: [...keys("materials"), ...hello.materials.map((card) => card.name)],
      },
      amounts: amountsOf(keys("parameters"), document),
      materialTitles: Object.fromEntries(
        hello.materials.map((card) => [card.name, `${card.name} (${card.model})`]),
      ),
    };
  }, [hello, document]);
}

/** Parameters with their values; without them while the text is not good, as they may have changed. */
export function amountsOf(names: readonly string[], document: DocumentEvent): Amounts {
  const known = new Map(document.valid ? document.parameters.map((one) => [one.name, one]) : []);
  return Object.fromEntries(
    names.map((name) => {
      const found = known.get(name);
      return [name, found ? { value: found.value, dimension: dimensionOf(found.kind) } : null];
    }),
  );
}
