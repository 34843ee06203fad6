import { Button } from "../controls/Choice";
import icon from "../icon.svg";
import { MODE_TITLES, MODES, openSheet, setMode, themeInForce, usePage } from "../store/page";
import { send } from "../store/session";
import { useStudio } from "../store/studio";
import { save, setTheme, showPane } from "./actions";
import { Icon } from "./icons";
import { LinkLamp } from "./LinkLamp";

export function TopBar() {
  const mode = usePage((page) => page.mode);
  const theme = usePage((page) => page.theme);
  const document = useStudio((state) => state.document);
  return (
    <header className="top-bar" data-testid="top-bar">
      <button
        type="button"
        className="brand"
        title="Start screen (Ctrl+O)"
        data-testid="brand"
        onClick={() => openSheet("start")}
      >
        <img src={icon} alt="" width="18" height="18" />
        VoxSoft
      </button>
      <nav className="modes" aria-label="Modes">
        {MODES.map((one) => (
          <button
            key={one}
            type="button"
            className="mode"
            data-testid={`mode-${one}`}
            aria-current={one === mode ? "page" : undefined}
            onClick={() => setMode(one)}
          >
            {MODE_TITLES[one]}
          </button>
        ))}
      </nav>
      <button
        type="button"
        className="document-name"
        data-testid="document-name"
        disabled={!document}
        title={
          document
            ? `${document.path ?? `would be saved in ${document.folder}`} (click for its versions)`
            : undefined
        }
        onClick={() => openSheet("versions")}
      >
        {document ? (
          <>
            <strong>{document.name || "untitled"}</strong>
            {document.dirty && <span className="muted">edited</span>}
            {!document.dirty && !document.path && <span className="muted">not saved yet</span>}
            {!document.valid && !document.empty && <span className="badge bad">has errors</span>}
          </>
        ) : (
          <span className="muted">no design open</span>
        )}
      </button>
      <Button
        icon
        kind="quiet"
        label="Undo (Ctrl+Z)"
        disabled={!document?.can_undo && !document?.before}
        onClick={() => send({ t: "undo" })}
      >
        <Icon name="undo" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Redo (Ctrl+Shift+Z)"
        disabled={!document?.can_redo && !document?.after}
        onClick={() => send({ t: "redo" })}
      >
        <Icon name="redo" />
      </Button>
      <Button icon kind="quiet" label="Save (Ctrl+S)" disabled={!document} onClick={save}>
        <Icon name="save" />
      </Button>
      <button
        type="button"
        className="find"
        data-testid="find"
        onClick={() => openSheet("palette")}
      >
        <Icon name="search" />
        <span>Find an action</span>
        <kbd>Ctrl K</kbd>
      </button>
      <Button
        disabled={!document}
        testId="export"
        title="Export"
        onClick={() => showPane("export")}
      >
        <Icon name="export" /> <span className="export-word">Export</span>
      </Button>
      <Button
        icon
        kind="quiet"
        label={themeInForce(theme) === "dark" ? "Light theme" : "Dark theme"}
        testId="theme"
        onClick={() => setTheme(themeInForce(theme) === "dark" ? "light" : "dark")}
      >
        <Icon name="theme" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Keyboard shortcuts (?)"
        testId="help"
        onClick={() => openSheet("shortcuts")}
      >
        <Icon name="help" />
      </Button>
      <LinkLamp />
    </header>
  );
}
