// What is being typed and was not sent yet. Whatever else is asked of the document hands it over
// first, so that nothing typed is lost by undo, by opening another document, or by leaving.
import { useStudio } from "./studio";

interface Typing {
  /** Send what was typed, if anything was. */
  flush(): void;
  /** What was typed and not sent yet. */
  text(): string | null;
}

let editor: Typing | null = null;

/** The text editor registers itself while it is there. */
export function provideTyping(typing: Typing): () => void {
  editor = typing;
  return () => {
    if (editor === typing) editor = null;
  };
}

/** Send what was typed into the text. */
export function flushText(): void {
  editor?.flush();
}

/** The text as it stands in the editor, sent or not. */
export function textNow(): string {
  return editor?.text() ?? useStudio.getState().document?.text ?? "";
}

/** Let the field that is being typed into take its value, and send what was typed into the text. */
export function finishTyping(): void {
  const field = globalThis.document?.activeElement;
  if (field?.matches("input")) (field as HTMLInputElement).blur();
  flushText();
}
