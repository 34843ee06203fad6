// Which shapes are drawn as ghosts: the one that is chosen, and those that nothing uses yet.
import { isUsed } from "../../panes/design/shapes/shapeVerbs";
import { onAnotherDocument } from "../../store/another";
import { usePage } from "../../store/page";
import { currentEngine, onReady, send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { useView } from "../../store/view";

/** Largest number of drawn shapes that nothing uses. */
const MOST_UNUSED = 8;

type Table = Readonly<Record<string, unknown>>;

/** Names of the shapes to be drawn, the chosen one first. */
export function wantedGhosts(source: Table, chosen: string | null): string[] {
  const names = Object.keys((source.shapes as Table | undefined) ?? {});
  const unused = names.filter((name) => name !== chosen && !isUsed(name, source));
  return [...names.filter((name) => name === chosen), ...unused.slice(0, MOST_UNUSED)];
}

/** Ask for them whenever there are others, or another revision of them. */
export function askGhosts(): void {
  let asked = "";
  const ask = () => {
    const { document } = useStudio.getState();
    // While the text is not good the shapes stay as they were.
    const faulty = document && !document.valid && !document.empty;
    if (currentEngine()?.kind !== "server" || faulty) return;
    const shown = usePage.getState().mode === "design" && document?.source;
    const names = shown ? wantedGhosts(shown, useView.getState().shape) : [];
    const wanted = names.length > 0 ? JSON.stringify([document?.rev, names]) : "";
    if (wanted === asked) return;
    asked = wanted;
    if (names.length > 0) send({ t: "ghosts", names });
    else useStudio.setState({ ghosts: null });
  };
  useStudio.subscribe((now, before) => now.document !== before.document && ask());
  useView.subscribe((now, before) => now.shape !== before.shape && ask());
  usePage.subscribe((now, before) => now.mode !== before.mode && ask());
  onAnotherDocument(() => {
    asked = "";
    useStudio.setState({ ghosts: null });
    ask();
  });
  onReady(() => {
    asked = "";
    ask();
  });
}
