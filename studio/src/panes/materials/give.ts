// Gives a part of the open design a material, by a button or by a drop.
import type { MaterialFacts } from "../../protocol";
import { toast, useStudio } from "../../store/studio";
import { editAll } from "../design/edits";
import { given, partsOf, refusal } from "./use";

/** Make a part of a material, and say so; a failure is reported instead. */
export function giveMaterial(one: MaterialFacts, index: number): void {
  const document = useStudio.getState().document;
  const source = document?.source ?? {};
  const part = partsOf(source)[index];
  if (!document || !part) return;
  const refused = refusal(one, part);
  if (refused) {
    toast({ level: "warning", what: refused, hint: "", about: "material" });
    return;
  }
  editAll([given(one, part, document.folder)]);
  toast({
    level: "good",
    what: `${part.name} is made of ${one.name}`,
    hint: "Ctrl+Z takes it back.",
    about: "material",
  });
}

/** Take a material that was dropped on a part. */
export function takeDropped(name: string, index: number): void {
  const known = useStudio.getState().materials?.materials ?? [];
  const one = known.find((each) => each.name === name);
  if (one) giveMaterial(one, index);
}
