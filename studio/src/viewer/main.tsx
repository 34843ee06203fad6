// One file that is alive without any server: the view and the run pane over the core in a worker.
import core from "virtual:voxsoft-core";
import { createRoot } from "react-dom/client";
import { bytesOf } from "../engine/base64";
import { WasmEngine } from "../engine/wasm";
import CoreWorker from "../engine/wasm.worker?worker&inline";
import { PageFence } from "../shell/Fence";
import { usePage, watchTheme } from "../store/page";
import { connect } from "../store/session";
import { Viewer } from "./Viewer";
import "../theme.css";
import "../controls/controls.css";

watchTheme();
usePage.setState({ mode: "simulate" });
const root = createRoot(document.getElementById("root") as HTMLElement);
const packed = document.getElementById("voxsoft-scene")?.textContent?.trim() ?? "";
if (packed) connect(new WasmEngine(new CoreWorker(), bytesOf(core), bytesOf(packed)));
root.render(
  <PageFence comfort="The body is in this file and stays as it was exported; motion since then is lost.">
    <Viewer empty={!packed} />
  </PageFence>,
);
