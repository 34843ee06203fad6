// All panes of the studio. A pane is a React component in a file of its own, loaded when it is
// first shown; the layouts (shell/layouts.ts) name panes by id.
import { type ComponentType, type LazyExoticComponent, lazy } from "react";

export interface PaneDefinition {
  readonly id: string;
  readonly title: string;
  readonly component: LazyExoticComponent<ComponentType>;
}

function pane(
  id: string,
  title: string,
  load: () => Promise<{ default: ComponentType }>,
): PaneDefinition {
  return { id, title, component: lazy(load) };
}

export const PANES: readonly PaneDefinition[] = [
  pane("view", "View", () => import("../view/ViewPane")),
  pane("run", "Run", () => import("../run/RunPane")),
  pane("probes", "Probes", () => import("../run/ProbesPane")),
  pane("chambers", "Chambers", () => import("../run/ChambersPane")),
  pane("energy", "Energy and residual", () => import("../run/EnergyPane")),
  pane("design", "Design", () => import("./design/DesignPane")),
  pane("text", "Text", () => import("./design/text/TextPane")),
  pane("path", "Path", () => import("./path/PathPane")),
  pane("timeline", "Timeline", () => import("./timeline/TimelinePane")),
  pane("calibrate", "Calibrate", () => import("./calibrate/CalibratePane")),
  pane("coupon", "Tensile tests", () => import("./coupon/CouponPane")),
  pane("overlay", "Measured and simulated", () => import("./calibrate/OverlayPane")),
  pane("generations", "Generations", () => import("./calibrate/GenerationsPane")),
  pane("errors", "Errors", () => import("./calibrate/ErrorsPane")),
  pane("study", "Study", () => import("./study/StudyPane")),
  pane("atlas", "Atlas", () => import("./study/atlas/AtlasPane")),
  pane("history", "History", () => import("./study/HistoryPane")),
  pane("scatter", "Design space", () => import("./study/ScatterPane")),
  pane("pareto", "Trade-offs", () => import("./study/ParetoPane")),
  pane("parallel", "Parallel axes", () => import("./study/ParallelPane")),
  pane("trials", "Designs", () => import("./study/TrialsPane")),
  pane("make", "Make", () => import("./make/MakePane")),
  pane("sheet", "Sheet", () => import("./make/SheetPane")),
  pane("runs", "Runs", () => import("./runs/RunsPane")),
  pane("compare", "Compare", () => import("./runs/ComparePane")),
  pane("export", "Export", () => import("./export/ExportPane")),
  pane("materials", "Materials", () => import("./materials/MaterialsPane")),
  pane("body", "Body", () => import("./body/BodyPane")),
  pane("log", "Log", () => import("./log/LogPane")),
];

export function paneById(id: string): PaneDefinition | undefined {
  return PANES.find((one) => one.id === id);
}
