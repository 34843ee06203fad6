import { createRoot } from "react-dom/client";
import { ServerEngine } from "./engine/server";
import { tellFits } from "./panes/calibrate/tell";
import { watchJob } from "./panes/jobs/watch";
import { App } from "./shell/App";
import { forgetLayouts } from "./shell/Dock";
import { PageFence } from "./shell/Fence";
import { watchAddress, watchTheme } from "./store/page";
import { connect } from "./store/session";
import { watchStrokes } from "./store/stroke";
import "./theme.css";
import "./controls/controls.css";

watchTheme();
watchAddress();
watchJob();
watchStrokes();
tellFits();
const scheme = location.protocol === "https:" ? "wss:" : "ws:";
connect(new ServerEngine(`${scheme}//${location.host}/ws`));
createRoot(document.getElementById("root") as HTMLElement).render(
  <PageFence
    comfort="The design and all runs are safe: VoxSoft keeps each change as it is made."
    resetLayout={forgetLayouts}
  >
    <App />
  </PageFence>,
);
