// Text being typed that was not sent yet. Any other command about the document hands it over
// first, so that nothing typed is lost by undo, by opening another document, or by leaving.

interface Typing {
  /** Send the typed text, if there is any. */
  flush(): void;
}

let editor: Typing | null = null;

/** The text editor registers itself while it is there. */
export function provideTyping(typing: Typing): () => void {
  editor = typing;
  return () => {
    if (editor === typing) editor = null;
  };
}

/** Send the text typed into the editor. */
export function flushText(): void {
  editor?.flush();
}

/** Let the field being typed into take its value, and send the text typed into the editor. */
export function finishTyping(): void {
  const field = globalThis.document?.activeElement;
  if (field?.matches("input")) (field as HTMLInputElement).blur();
  flushText();
}
