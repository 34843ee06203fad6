import { useEffect } from "react";
import { PANES } from "../panes/registry";
import { Start } from "../start/Start";
import { openSheet, usePage } from "../store/page";
import { useStudio } from "../store/studio";
import { finishTyping } from "../store/typing";
import { listenForKeys, provideDock } from "./actions";
import { Dock, frontPanes, resetLayout, showPane } from "./Dock";
import { DropZone } from "./DropZone";
import { LinkBand } from "./LinkLamp";
import { Sheets } from "./Sheets";
import { StatusLine } from "./StatusLine";
import { TopBar } from "./TopBar";
import { wantsTour } from "./tour";
import "./shell.css";

provideDock({ panes: PANES, show: showPane, front: frontPanes, reset: resetLayout });

export function App() {
  const starting = usePage((page) => page.sheet === "start");
  const fresh = useStudio((state) => state.start?.fresh);
  useEffect(listenForKeys, []);
  // With nothing to go on with the page begins with the start screen.
  useEffect(() => {
    if (fresh) openSheet("start");
  }, [fresh]);
  useEffect(() => {
    if (wantsTour()) openSheet("tour");
    const warn = (event: BeforeUnloadEvent) => {
      finishTyping();
      const { document, link } = useStudio.getState();
      // The server keeps a draft of each edit; without a connection nobody does.
      if (document?.dirty && link.state !== "open") event.preventDefault();
    };
    addEventListener("beforeunload", warn);
    addEventListener("pagehide", finishTyping);
    return () => {
      removeEventListener("beforeunload", warn);
      removeEventListener("pagehide", finishTyping);
    };
  }, []);
  return (
    <div className="app">
      <div className="app" inert={starting}>
        <TopBar />
        <LinkBand />
        <Dock />
        <StatusLine />
      </div>
      {starting && <Start />}
      <Sheets />
      <DropZone />
    </div>
  );
}
