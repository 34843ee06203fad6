// Copying the content of a pane.
import { toast } from "../store/studio";

/** Put text on the clipboard, and say so or why not. */
export async function copy(text: string, what: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    toast({ level: "good", what: `Copied ${what}`, hint: "" });
  } catch {
    toast({
      level: "error",
      what: "The browser does not let this page copy",
      hint: "Allow it to use the clipboard, then try again.",
    });
  }
}
