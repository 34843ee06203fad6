// The one file that knows dockview: panes in groups that can be dragged, tabbed and maximized.
import {
  type DockviewApi,
  DockviewDefaultTab,
  DockviewReact,
  type IDockviewPanelHeaderProps,
  type IDockviewPanelProps,
  type SerializedDockview,
} from "dockview-react";
import "dockview-react/dist/styles/dockview.css";
import { Component, type ReactNode, Suspense, useCallback, useEffect, useRef } from "react";
import { Empty } from "../controls/Choice";
import { PANES, paneById } from "../panes/registry";
import { keepAs, kept, type Mode, usePage } from "../store/page";
import { add, build } from "./layouts";
import "./dock.css";

// Grows when the default layouts change, so that a kept layout of old does not hide new panes.
const EDITION = 3;

interface KeptLayout {
  edition: number;
  panes: string;
  layout: SerializedDockview;
}

const keyOf = (mode: Mode) => `voxsoft.layout.${mode}`;
const knownPanes = () => PANES.map((pane) => pane.id).join(" ");

let dock: DockviewApi | null = null;

/** Bring a pane to the front, opening it where it is closed. */
export function showPane(id: string): void {
  if (!dock) return;
  const panel = dock.getPanel(id);
  if (panel) panel.api.setActive();
  else {
    const anchor = dock.activePanel?.id;
    add(dock, id, anchor ? { referencePanel: anchor, direction: "within" } : undefined);
  }
}

/** Forget the kept layout of the current mode and build its default again. */
export function resetLayout(): void {
  const mode = usePage.getState().mode;
  keepAs(keyOf(mode), {});
  if (dock) fill(dock, mode);
}

export function maximizePane(id: string): void {
  const panel = dock?.getPanel(id);
  if (!panel) return;
  if (panel.api.isMaximized()) panel.api.exitMaximized();
  else panel.api.maximize();
}

let filling = false;

function fill(api: DockviewApi, mode: Mode): void {
  filling = true;
  const saved = kept<KeptLayout>(keyOf(mode));
  try {
    if (saved.layout && saved.edition === EDITION && saved.panes === knownPanes()) {
      api.fromJSON(saved.layout);
      return;
    }
    throw new Error("no layout kept");
  } catch {
    api.clear();
    build(api, mode, api.width, api.height);
  } finally {
    filling = false;
  }
}

function Pane(props: IDockviewPanelProps) {
  const pane = paneById(props.api.id);
  if (!pane) return null;
  const Content = pane.component;
  return (
    <section className="pane-host" data-testid={`pane-${pane.id}`} aria-label={pane.title}>
      <Fence title={pane.title}>
        <Suspense fallback={null}>
          <Content />
        </Suspense>
      </Fence>
    </section>
  );
}

/** A pane that fails says so and leaves the others alone. */
class Fence extends Component<{ title: string; children: ReactNode }, { error: Error | null }> {
  override state = { error: null as Error | null };

  static getDerivedStateFromError(error: Error) {
    return { error };
  }

  override render() {
    if (!this.state.error) return this.props.children;
    return (
      <Empty title={`${this.props.title} stopped working`}>
        <p>{this.state.error.message}</p>
        <button type="button" className="button" onClick={() => this.setState({ error: null })}>
          Try again
        </button>
      </Empty>
    );
  }
}

function Tab(props: IDockviewPanelHeaderProps) {
  return <DockviewDefaultTab {...props} hideClose={props.api.id === "view"} />;
}

const COMPONENTS = { pane: Pane };
const THEME = { name: "voxsoft", className: "dockview-theme-voxsoft", gap: 1 };

export function Dock() {
  const mode = usePage((page) => page.mode);
  const shown = useRef(mode);
  const save = useCallback(() => {
    if (!dock || filling || dock.totalPanels === 0) return;
    keepAs(keyOf(shown.current), { edition: EDITION, panes: knownPanes(), layout: dock.toJSON() });
  }, []);

  useEffect(() => {
    if (!dock || shown.current === mode) return;
    save();
    shown.current = mode;
    fill(dock, mode);
  }, [mode, save]);

  return (
    <DockviewReact
      className="dock"
      theme={THEME}
      components={COMPONENTS}
      defaultTabComponent={Tab}
      onReady={({ api }) => {
        dock = api;
        fill(api, shown.current);
        let timer: ReturnType<typeof setTimeout> | undefined;
        api.onDidLayoutChange(() => {
          clearTimeout(timer);
          timer = setTimeout(save, 300);
        });
      }}
    />
  );
}
