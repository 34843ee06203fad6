import { createRoot } from "react-dom/client";
import { ServerEngine } from "./engine/server";
import { watchJob } from "./panes/jobs/watch";
import { App } from "./shell/App";
import { watchAddress, watchTheme } from "./store/page";
import { connect } from "./store/session";
import "./theme.css";
import "./controls/controls.css";

watchTheme();
watchAddress();
watchJob();
const scheme = location.protocol === "https:" ? "wss:" : "ws:";
connect(new ServerEngine(`${scheme}//${location.host}/ws`));
createRoot(document.getElementById("root") as HTMLElement).render(<App />);
