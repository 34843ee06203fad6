// Tells when another document takes the place of the open one: things typed for that one go with it.
import { useStudio } from "./studio";

/** Call back each time that another document is open; not for the first, nor for a changed one. */
export function onAnotherDocument(callback: () => void): () => void {
  return useStudio.subscribe((now, before) => {
    if (now.document && before.document && now.document.id !== before.document.id) callback();
  });
}
