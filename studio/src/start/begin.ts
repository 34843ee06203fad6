// Opens the choice made on the start screen, and lets it move where it can.
import { openDocument } from "../shell/actions";
import { openSheet, type Pending, usePage } from "../store/page";
import { send } from "../store/session";
import { useStudio } from "../store/studio";
import { setView, useView } from "../store/view";

/** Open a design from the start screen, which then goes away. */
export function openFromStart(what: Pending["what"], name: string): void {
  const pending: Pending = { t: "open", what, name };
  openSheet(null);
  openDocument(pending);
}

/**
 * Open a finished robot: smooth unless a hand chose otherwise, and moving to where its loads take
 * it. Where edited work stands in the way that is asked about first, and nothing moves by itself.
 */
export function openRobot(what: "robot" | "start", name: string): void {
  const rev = useStudio.getState().document?.rev ?? 0;
  openFromStart(what, name);
  if (usePage.getState().sheet === "discard") return;
  if (useView.getState().appearance === "auto") setView({ appearance: "smooth" });
  const stop = useStudio.subscribe(({ body, document, stat }) => {
    if (!document || document.rev <= rev || body?.rev !== document.rev || !stat) return;
    if (stat.topology !== body.topology) return; // of the body before
    stop();
    // A body with contact does not move by itself: it has its equilibrium once that is asked for.
    if (!body.not_live) send({ t: "play" });
  });
  setTimeout(stop, LONGEST);
}

/** After so long nobody waits for a robot any more, ms. */
const LONGEST = 20_000;
