import { useEffect } from "react";
import { PANES } from "../panes/registry";
import { openSheet } from "../store/page";
import { useStudio } from "../store/studio";
import { finishTyping } from "../store/typing";
import { listenForKeys, provideDock } from "./actions";
import { Dock, resetLayout, showPane } from "./Dock";
import { DropZone } from "./DropZone";
import { LinkBand } from "./LinkLamp";
import { Sheets } from "./Sheets";
import { StatusLine } from "./StatusLine";
import { TopBar } from "./TopBar";
import { wantsTour } from "./tour";
import "./shell.css";

provideDock({ panes: PANES, show: showPane, reset: resetLayout });

export function App() {
  useEffect(listenForKeys, []);
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
      <TopBar />
      <LinkBand />
      <Dock />
      <StatusLine />
      <Sheets />
      <DropZone />
    </div>
  );
}
