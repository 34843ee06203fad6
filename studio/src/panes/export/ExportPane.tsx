import { useState } from "react";
import { Button, Select } from "../../controls/Choice";
import type { ErrorEvent, ExportedEvent } from "../../protocol";
import { ask } from "../../store/session";
import { toast, useStudio } from "../../store/studio";
import { Glyph } from "../design/fields/Glyph";
import { FORMATS, type Format, type Options, obstacle, request, UNITS, type Unit } from "./formats";
import "./export.css";

async function fetchFile(format: Format, options: Options): Promise<void> {
  const reply = await ask("/export", request(format, options));
  const said: unknown = await reply.json().catch(() => null);
  if (!reply.ok) {
    const problem = said as Partial<ErrorEvent> | null;
    toast({
      level: "error",
      what: problem?.what ?? `${format.title} could not be written (${reply.status})`,
      hint: problem?.hint ?? "",
    });
    return;
  }
  const file = said as ExportedEvent;
  const link = document.createElement("a");
  link.href = file.url;
  link.download = file.name;
  link.click();
  toast({ level: "good", what: `${file.name} is in your downloads`, hint: "" });
}

async function savePicture(scale: number): Promise<void> {
  // Loaded only now: the view brings three.js with it.
  const [{ viewport }, recorder] = await Promise.all([
    import("../../view/instance"),
    import("../../view/recorder"),
  ]);
  await recorder.savePicture(viewport(), scale);
}

/** Each way to take the result away, with its purpose. */
export default function ExportPane() {
  const open = useStudio((state) => state.document !== null);
  const refused = useStudio((state) => state.body?.refused);
  const [options, setOptions] = useState<Options>({ unit: null, shape: "rest", scale: 2 });
  const [busy, setBusy] = useState<string | null>(null);
  const start = async (format: Format) => {
    setBusy(format.id);
    try {
      if (format.here) await savePicture(options.scale);
      else await fetchFile(format, options);
    } catch {
      toast({
        level: "error",
        what: `${format.title} could not be fetched`,
        hint: "VoxSoft does not answer; try again when it does.",
      });
    } finally {
      setBusy(null);
    }
  };
  return (
    <div className="pane export" data-testid="export-list">
      {FORMATS.map((format) => {
        const trouble = obstacle(format, options, open, refused);
        return (
          <section key={format.id} className="export-row" data-testid={`export-${format.id}`}>
            <div>
              <h3>
                {format.title} <span className="muted">{format.ending}</span>
              </h3>
              <p className="muted">{format.purpose}</p>
              {(format.asksUnit || format.asksShape || format.here) && (
                <div className="export-options">
                  {format.asksUnit && (
                    <Select
                      bare
                      label="Unit of the surface"
                      value={options.unit ?? ""}
                      options={[
                        { value: "", label: "unit?", disabled: true },
                        ...UNITS.map((unit) => ({ value: unit, label: unit })),
                      ]}
                      onChange={(unit) => setOptions({ ...options, unit: unit as Unit })}
                    />
                  )}
                  {format.asksShape && (
                    <Select
                      bare
                      label="Shape of the surface"
                      value={options.shape}
                      options={[
                        { value: "rest", label: "as built" },
                        { value: "now", label: "as deformed now" },
                      ]}
                      onChange={(shape) =>
                        setOptions({ ...options, shape: shape === "now" ? "now" : "rest" })
                      }
                    />
                  )}
                  {format.here && (
                    <Select
                      bare
                      label="Size of the picture"
                      value={String(options.scale)}
                      options={[
                        { value: "1", label: "as on screen" },
                        { value: "2", label: "twice" },
                        { value: "4", label: "four times" },
                      ]}
                      onChange={(scale) => setOptions({ ...options, scale: Number(scale) })}
                    />
                  )}
                </div>
              )}
              {trouble && open && <p className="export-note">{trouble}</p>}
            </div>
            <Button
              icon
              label={`Export ${format.title.toLowerCase()} (${format.ending})`}
              disabled={trouble !== null || busy !== null}
              onClick={() => void start(format)}
            >
              {busy === format.id ? "…" : <Glyph name="download" />}
            </Button>
          </section>
        );
      })}
    </div>
  );
}
