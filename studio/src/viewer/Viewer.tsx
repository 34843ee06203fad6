import { useEffect, useState } from "react";
import { Button, Empty } from "../controls/Choice";
import ProbesPane from "../run/ProbesPane";
import RunPane from "../run/RunPane";
import { listenForKeys, setTheme } from "../shell/actions";
import { Icon } from "../shell/icons";
import { Sheets } from "../shell/Sheets";
import { openSheet, themeInForce, usePage } from "../store/page";
import { useStudio } from "../store/studio";
import ViewPane from "../view/ViewPane";
import "../shell/shell.css";
import "./viewer.css";

/** A result that anyone can open: turn it, pull on it, change its loads. */
export function Viewer(props: { empty: boolean }) {
  const theme = usePage((page) => page.theme);
  const document = useStudio((state) => state.document);
  const link = useStudio((state) => state.link);
  const version = useStudio((state) => state.hello?.version);
  const origin = useStudio((state) => state.log[0]?.text);
  const [wide, setWide] = useState(innerWidth > 760);
  useEffect(listenForKeys, []);
  useEffect(() => {
    const measure = () => setWide(innerWidth > 760);
    addEventListener("resize", measure);
    return () => removeEventListener("resize", measure);
  }, []);
  useEffect(() => {
    if (document) window.document.title = `${document.name} · VoxSoft`;
  }, [document]);
  if (props.empty || link.state === "refused") {
    return (
      <Empty title={props.empty ? "No result in this file" : "This result cannot be shown"}>
        <p>{props.empty ? "Write one with: voxsoft export RUN --html FILE" : link.reason}</p>
      </Empty>
    );
  }
  return (
    <div className="app" data-testid="viewer">
      <header className="top-bar">
        <strong className="brand">{document?.name ?? "…"}</strong>
        <span className="document-name" data-testid="origin" title={origin}>
          <span className="muted">{origin}</span>
        </span>
        <Button
          icon
          kind="quiet"
          label="Turn light or dark"
          onClick={() => setTheme(themeInForce(theme) === "dark" ? "light" : "dark")}
        >
          <Icon name="theme" />
        </Button>
        <Button
          icon
          kind="quiet"
          label="Keyboard shortcuts (?)"
          onClick={() => openSheet("shortcuts")}
        >
          <Icon name="help" />
        </Button>
        <span className="muted">made with VoxSoft {version}</span>
      </header>
      <main className="viewer-main">
        <ViewPane />
        <aside className="viewer-side">
          <RunPane />
          {wide && <ProbesPane />}
        </aside>
      </main>
      <Sheets />
    </div>
  );
}
