import { useRef, useState } from "react";
import { Button, Section } from "../../controls/Choice";
import type { Template } from "../../protocol";
import { TAKEN, upload } from "../../shell/DropZone";
import { TABLES } from "../../shell/dropTable";
import { useStudio } from "../../store/studio";
import { openHere } from "./edits";
import { EMPTY } from "./empty";

// A sign for each shipped family: its deformation under load, from the side.
const SKETCHES: Readonly<Record<string, string>> = {
  empty: "M28 14v20M18 24h20M8 8h6M8 8v6M48 8h-6m6 0v6M8 40h6m-6 0v-6m40 6h-6m6 0v-6",
  beam: "M6 8v32M6 14h20c12 0 20 6 24 16M6 22h18c9 0 15 5 18 13",
  cylinder: "M14 12c0-6 28-6 28 0v26c0 6-28 6-28 0zm0 0c0 6 28 6 28 0M28 30v-9m-4 4 4-4 4 4",
  finger: "M20 42V16c0-10 16-10 16 0v26zM24 20h8M24 27h8M24 34h8M8 16h8m-3-3 3 3-3 3",
  pneunet: "M6 34h44M8 34V16h8v18m3 0V16h8v18m3 0V16h8v18m3 0V16h8v18M6 38h44",
  sphere: "M28 8a16 16 0 1 0 0 32 16 16 0 0 0 0-32m0 9a7 7 0 1 1 0 14 7 7 0 0 1 0-14",
};
const OTHER = "M10 16l18-8 18 8v18l-18 8-18-8zM10 16l18 8 18-8M28 24v18";

/** Designs to start from, and the way to open one's own. */
export function Gallery() {
  const templates = useStudio((state) => state.hello?.templates);
  const open = useStudio((state) => state.document !== null);
  const [unfolded, unfold] = useState(false);
  const picker = useRef<HTMLInputElement>(null);
  const shown = unfolded || !open;
  return (
    <Section
      title="Start from"
      action={
        <span className="row">
          <Button kind="quiet" onClick={() => picker.current?.click()}>
            Open a file…
          </Button>
          {open && (
            <Button
              kind="quiet"
              pressed={unfolded}
              testId="templates"
              onClick={() => unfold(!unfolded)}
            >
              Templates
            </Button>
          )}
          <input
            ref={picker}
            className="visually-hidden"
            type="file"
            tabIndex={-1}
            aria-label="Open a design, a mesh, voxels or a run folder"
            accept={[...TAKEN, ...TABLES].join(",")}
            onChange={(event) => {
              for (const file of event.target.files ?? []) void upload(file);
              event.target.value = "";
            }}
          />
        </span>
      }
    >
      {shown && (
        <div className="gallery" data-testid="gallery">
          <Card template={EMPTY} onOpened={() => unfold(false)} />
          {(templates ?? []).map((template) => (
            <Card key={template.name} template={template} onOpened={() => unfold(false)} />
          ))}
        </div>
      )}
      {!open && (
        <p className="muted">
          Or drop a <code>.toml</code>, a mesh such as <code>.stl</code>, <code>.vtu</code> or{" "}
          <code>.inp</code>, a <code>.npy</code> or a zipped run folder anywhere on the page.
        </p>
      )}
    </Section>
  );
}

function Card(props: { template: Template; onOpened(): void }) {
  const { template } = props;
  return (
    <button
      type="button"
      className="template"
      data-testid={`template-${template.name}`}
      onClick={() => {
        openHere("template", template.name);
        props.onOpened();
      }}
    >
      <svg viewBox="0 0 56 48" aria-hidden="true">
        <path d={SKETCHES[template.name] ?? OTHER} />
      </svg>
      <strong>{template.name}</strong>
      <span className="muted">{template.title}</span>
    </button>
  );
}
