import { useEffect, useState } from "react";
import { CAD_HINT, CAD_SUFFIXES, CAD_WHAT, LARGEST_UPLOAD, MESHES } from "../protocol";
import { toast } from "../store/studio";
import { openDocument } from "./actions";
import { TABLES, takeTable } from "./dropTable";
import { askImport } from "./importMesh";

/** Endings of files that can be opened. */
export const TAKEN: readonly string[] = [".toml", ...MESHES, ".zip"];

/** Open a file that was dropped or chosen; a table goes to the pane that its columns are for. */
export async function upload(file: File): Promise<void> {
  const kind = file.name.slice(file.name.lastIndexOf(".")).toLowerCase();
  if (TABLES.includes(kind)) return takeTable(file);
  if (!TAKEN.includes(kind)) {
    toast({ level: "warning", ...refusalOf(file.name) });
    return;
  }
  const sent = await sendFile(file);
  if (!sent) return;
  if (!MESHES.some((ending) => sent.name.endsWith(ending))) {
    openDocument({ t: "open", what: "upload", name: sent.name });
    return;
  }
  const read = await askImport(sent.name);
  if (read) openDocument({ t: "open", what: "upload", name: sent.name, mesh: read.how });
}

/** Reason why a file of this name is not opened, and a remedy. */
export function refusalOf(name: string): { readonly what: string; readonly hint: string } {
  if (CAD_SUFFIXES.some((suffix) => name.toLowerCase().endsWith(suffix)))
    return { what: `${name} ${CAD_WHAT}`, hint: `Try: ${CAD_HINT}.` };
  return {
    what: `${name} is nothing that can be opened`,
    hint: `Drop ${TAKEN.join(", ")}, or a table of measurements (${TABLES.join(", ")}).`,
  };
}

/** Send a file to the server; gives its name and path there, or null where it was not taken. */
export async function sendFile(file: File): Promise<{ name: string; path: string } | null> {
  if (file.size > LARGEST_UPLOAD) {
    toast({
      level: "error",
      what: `${file.name} has ${Math.round(file.size / 1e6)} MB; at most ${Math.round(LARGEST_UPLOAD / 2 ** 20)} MB can be sent`,
      hint: "Start the studio with it instead: voxsoft studio FILE.",
    });
    return null;
  }
  try {
    const reply = await fetch(`/upload?name=${encodeURIComponent(file.name)}`, {
      method: "POST",
      body: file,
    });
    const body: unknown = await reply.json().catch(() => null);
    if (reply.ok) return body as { name: string; path: string };
    const refused = body as { what?: string; hint?: string } | null;
    toast({
      level: "error",
      what: refused?.what ?? `${file.name} was not taken (${reply.status})`,
      hint: refused?.hint ?? "",
    });
  } catch {
    toast({
      level: "error",
      what: `${file.name} could not be sent`,
      hint: "VoxSoft does not answer; drop the file again when it does.",
    });
  }
  return null;
}

export function DropZone() {
  const [over, setOver] = useState(false);
  useEffect(() => {
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const onOver = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      setOver(true);
    };
    const onLeave = (event: DragEvent) => {
      if (event.relatedTarget === null) setOver(false);
    };
    const onDrop = (event: DragEvent) => {
      setOver(false);
      const { target } = event;
      // A place that takes files itself is marked.
      const own = target instanceof Element && target.closest("[data-takes-files]") !== null;
      if (!hasFiles(event) || own) return;
      event.preventDefault();
      for (const file of event.dataTransfer?.files ?? []) void upload(file);
    };
    addEventListener("dragover", onOver);
    addEventListener("dragleave", onLeave);
    // Groups of panes prevent the default of every drop, also of files: they are asked last.
    addEventListener("drop", onDrop, true);
    return () => {
      removeEventListener("dragover", onOver);
      removeEventListener("dragleave", onLeave);
      removeEventListener("drop", onDrop, true);
    };
  }, []);
  return over ? (
    <div className="drop-here">
      Drop a design, a mesh, voxels, a table of measurements (.csv) or a run folder (.zip)
    </div>
  ) : null;
}
