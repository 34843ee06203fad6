// The modes are layouts of the same panes around the same view; the model stays loaded.
import type { DockviewApi, SerializedDockview } from "dockview-react";
import { paneById } from "../panes/registry";
import type { Mode } from "../store/page";

/** Panes that share one group, as tabs. */
type Tabs = readonly string[];

export interface Layout {
  readonly left: readonly Tabs[];
  readonly main: Tabs;
  readonly bottom: readonly Tabs[];
  readonly right: readonly Tabs[];
  /** Share of the width that the left column takes. */
  readonly leftShare: number;
}

const LAYOUTS: Readonly<Record<Mode, Layout>> = {
  design: {
    left: [["design"], ["text"]],
    main: ["view"],
    bottom: [],
    right: [["body", "materials", "export", "log"]],
    leftShare: 0.25,
  },
  simulate: {
    left: [["run", "path", "timeline", "design"]],
    main: ["view"],
    bottom: [
      ["probes", "chambers"],
      ["energy", "log"],
    ],
    right: [["body", "export"]],
    leftShare: 0.21,
  },
  calibrate: {
    left: [["calibrate", "coupon"]],
    main: ["view", "overlay"],
    bottom: [["generations"], ["errors", "log"]],
    right: [],
    leftShare: 0.26,
  },
  optimize: {
    left: [["study"]],
    main: ["view", "atlas", "compare"],
    bottom: [["trials", "log"]],
    right: [["history"], ["scatter", "pareto"], ["parallel"]],
    leftShare: 0.22,
  },
  make: {
    left: [["make"]],
    main: ["view", "sheet"],
    bottom: [],
    right: [["body", "export", "log"]],
    leftShare: 0.27,
  },
  runs: {
    left: [],
    main: ["runs"],
    bottom: [],
    right: [["view"], ["compare", "export", "log"]],
    leftShare: 0.2,
  },
};

// Below this width there is no column at the right.
const NARROW = 1400;

/** A node of a kept layout: a group with its panes, or nodes beside each other. */
type KeptNode = SerializedDockview["grid"]["root"];

/** Check if a kept layout has panes in its groups: one without would show an empty page. */
export function holdsViews(layout: SerializedDockview | undefined): layout is SerializedDockview {
  const shown = (node: KeptNode | undefined): string[] => {
    if (!node) return [];
    const { data } = node;
    return Array.isArray(data) ? data.flatMap(shown) : (data?.views ?? []);
  };
  try {
    return shown(layout?.grid?.root).some((id) => layout?.panels?.[id] !== undefined);
  } catch {
    return false; // what is kept is no layout at all
  }
}

/** Leave out panes that are not there, and groups that are then empty. */
export function present(groups: readonly Tabs[]): string[][] {
  return groups
    .map((tabs) => tabs.filter((id) => paneById(id)))
    .filter((tabs) => tabs.length > 0) as string[][];
}

/** Add tabs to the last of some groups. */
function withTabs(groups: string[][], tabs: string[]): string[][] {
  const last = groups.at(-1);
  return last ? [...groups.slice(0, -1), [...last, ...tabs]] : [tabs];
}

/** Build the default layout of a mode in an empty dock. */
export function build(api: DockviewApi, mode: Mode, width: number, height: number): void {
  const layout = LAYOUTS[mode];
  let left = present(layout.left);
  let bottom = present(layout.bottom);
  let right = present(layout.right);
  const main = present([layout.main])[0] ?? ["log"];
  // A narrow window keeps its width for the view: the right column becomes tabs elsewhere.
  if (width < NARROW && right.length > 0 && mode !== "runs") {
    const others = right.flat();
    if (bottom.length > 0) bottom = withTabs(bottom, others);
    else left = withTabs(left, others);
    right = [];
  }
  addTabs(api, main, undefined);
  const anchor = main[0] as string;
  const leftWidth = Math.round(Math.max(280, width * layout.leftShare));
  const rightWidth = Math.round(mode === "runs" ? width * 0.45 : Math.max(260, width * 0.23));
  const bottomHeight = Math.round(Math.max(170, height * 0.27));
  column(api, right, anchor, "right", rightWidth);
  column(api, left, anchor, "left", leftWidth);
  for (const [i, tabs] of bottom.entries()) {
    const first = bottom[0]?.[0] as string;
    const previous = bottom[i - 1]?.[0];
    addTabs(
      api,
      tabs,
      i === 0
        ? { referencePanel: anchor, direction: "below" }
        : { referencePanel: previous ?? first, direction: "right" },
      i === 0 ? { initialHeight: bottomHeight } : {},
    );
  }
  // Each split has taken from all columns: give them their widths again.
  const set = (groups: string[][], size: { width?: number; height?: number }) => {
    const id = groups[0]?.[0];
    if (id) api.getPanel(id)?.api.setSize(size);
  };
  set(left, { width: leftWidth });
  set(right, { width: rightWidth });
  set(bottom, { height: bottomHeight });
  api.getPanel(anchor)?.api.setActive();
}

interface Position {
  readonly referencePanel: string;
  readonly direction: "left" | "right" | "above" | "below" | "within";
}

function column(
  api: DockviewApi,
  groups: string[][],
  anchor: string,
  direction: "left" | "right",
  width: number,
): void {
  for (const [i, tabs] of groups.entries()) {
    const above = groups[i - 1]?.[0];
    addTabs(
      api,
      tabs,
      above ? { referencePanel: above, direction: "below" } : { referencePanel: anchor, direction },
      above ? {} : { initialWidth: width },
    );
  }
}

function addTabs(
  api: DockviewApi,
  tabs: readonly string[],
  position: Position | undefined,
  size: { initialWidth?: number; initialHeight?: number } = {},
): void {
  const [first, ...others] = tabs;
  if (!first) return;
  add(api, first, position, size);
  for (const id of others) add(api, id, { referencePanel: first, direction: "within" }, {}, true);
}

export function add(
  api: DockviewApi,
  id: string,
  position: Position | undefined,
  size: { initialWidth?: number; initialHeight?: number } = {},
  inactive = false,
): void {
  const pane = paneById(id);
  if (!pane || api.getPanel(id)) return;
  api.addPanel({
    id,
    component: "pane",
    title: pane.title,
    ...(position ? { position } : {}),
    ...size,
    inactive,
  });
}
