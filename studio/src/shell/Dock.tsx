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
import { Suspense, useCallback, useEffect, useRef } from "react";
import { PANES, paneById } from "../panes/registry";
import { keepAs, kept, MODES, type Mode, setMode, usePage } from "../store/page";
import { PaneFence } from "./Fence";
import { Icon } from "./icons";
import { add, build, holdsViews } from "./layouts";
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

/** Pane to show once the dock holds the panes of a mode. */
let wanted: string | null = null;

/** Bring a pane to the front, opening it where it is closed; in another mode if one is named. */
export function showPane(id: string, mode?: Mode): void {
  if (!dock) return;
  if (mode && mode !== usePage.getState().mode) {
    wanted = id;
    setMode(mode);
    return;
  }
  const panel = dock.getPanel(id);
  if (panel) panel.api.setActive();
  else {
    const anchor = dock.activePanel?.id;
    add(dock, id, anchor ? { referencePanel: anchor, direction: "within" } : undefined);
  }
}

/** Panes that are seen: the one in front of each group. */
export function frontPanes(): readonly string[] {
  return dock?.groups.flatMap((group) => group.activePanel?.id ?? []) ?? [];
}

/** Forget the kept layout of the current mode and build its default again. */
export function resetLayout(): void {
  const mode = usePage.getState().mode;
  keepAs(keyOf(mode), {});
  if (dock) fill(dock, mode);
}

/** Forget the kept layouts of all modes: the next load builds their defaults. */
export function forgetLayouts(): void {
  dock = null; // what is on the page must not be kept again as it goes
  for (const mode of MODES) keepAs(keyOf(mode), {});
}

let filling = false;

function fill(api: DockviewApi, mode: Mode): void {
  filling = true;
  const saved = kept<KeptLayout>(keyOf(mode));
  try {
    const current = saved.edition === EDITION && saved.panes === knownPanes();
    if (!current || !holdsViews(saved.layout)) throw new Error("no layout kept");
    api.fromJSON(saved.layout);
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
      <PaneFence title={pane.title}>
        <Suspense fallback={null}>
          <Content />
        </Suspense>
      </PaneFence>
    </section>
  );
}

function Tab(props: IDockviewPanelHeaderProps) {
  const closes = props.api.id !== STAYS;
  const close = () => props.api.close();
  return (
    <div className="tab">
      <DockviewDefaultTab
        {...props}
        hideClose
        onPointerUp={(event) => {
          if (closes && event.button === 1) close();
        }}
      />
      {/* A tab holds nothing else that takes the focus: the keyboard closes it with Delete. */}
      {closes && (
        <span
          className="tab-close"
          aria-hidden="true"
          title="Close (Delete)"
          onPointerDown={(event) => event.preventDefault()}
          onClick={close}
        >
          <Icon name="close" />
        </span>
      )}
    </div>
  );
}

/** The dock closes the pane of a tab by Delete and Backspace; the view has no way to be closed. */
function keepView(event: KeyboardEvent): void {
  if (event.key !== "Delete" && event.key !== "Backspace") return;
  const { target } = event;
  if (target instanceof HTMLElement && target.dataset.tabPanelId === STAYS) event.stopPropagation();
}

/** The pane that every layout has. */
const STAYS = "view";

const COMPONENTS = { pane: Pane };
const THEME = { name: "voxsoft", className: "dockview-theme-voxsoft", gap: 1 };

export function Dock() {
  const mode = usePage((page) => page.mode);
  const shown = useRef(mode);
  const save = useCallback(() => {
    if (!dock || filling) return;
    const layout = dock.toJSON();
    // While the page goes its groups are emptied one by one: that is nothing to come back to.
    if (!holdsViews(layout)) return;
    keepAs(keyOf(shown.current), { edition: EDITION, panes: knownPanes(), layout });
  }, []);
  useEffect(() => {
    addEventListener("keydown", keepView, true);
    return () => {
      removeEventListener("keydown", keepView, true);
      dock = null;
    };
  }, []);

  useEffect(() => {
    if (!dock || shown.current === mode) return;
    save();
    shown.current = mode;
    fill(dock, mode);
    if (wanted) showPane(wanted);
    wanted = null;
    document.documentElement.dataset.layout = mode;
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
