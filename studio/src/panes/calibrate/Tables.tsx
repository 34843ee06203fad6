// The measured tables: dropped or chosen, with the content of each column and its unit.
import { useRef, useState } from "react";
import { Button, Section, Select } from "../../controls/Choice";
import type { MeasuredColumn, MeasuredEvent } from "../../protocol";
import { TABLES, takeTable } from "../../shell/dropTable";
import { useStudio } from "../../store/studio";
import { Glyph } from "../design/fields/Glyph";
import { changeFile, type MeasuredFile, removeFile, useCalibrateDraft } from "./draft";

const QUANTITIES: Readonly<Record<string, string>> = {
  "": "not used",
  arc: "distance along the beam",
  probe: "name of a probe",
  x: "position x",
  y: "position y",
  z: "position z",
  dx: "displacement x",
  dy: "displacement y",
  dz: "displacement z",
  material: "material",
  note: "note",
};
const LABELS = new Set(["", "probe", "material", "note"]);
const UNITS = ["mm", "cm", "m"];

function take(files: FileList | null): void {
  for (const file of files ?? []) void takeTable(file, "stations");
}

export function Tables() {
  const files = useCalibrateDraft((draft) => draft.files);
  const picker = useRef<HTMLInputElement>(null);
  const [over, setOver] = useState(false);
  return (
    <Section
      title="Measured data"
      action={
        <Button kind="quiet" onClick={() => picker.current?.click()}>
          Choose a file…
        </Button>
      }
    >
      <input
        ref={picker}
        className="visually-hidden"
        type="file"
        tabIndex={-1}
        multiple
        accept={[...TABLES, ".toml"].join(",")}
        aria-label="Choose a table of measurements"
        data-testid="measurement-file"
        onChange={(event) => {
          take(event.target.files);
          event.target.value = "";
        }}
      />
      {/* biome-ignore lint/a11y/noStaticElementInteractions: the button above does the same */}
      <div
        className={`drop-table${over ? " is-over" : ""}`}
        data-takes-files
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={(event) => {
          event.preventDefault();
          setOver(false);
          take(event.dataTransfer.files);
        }}
      >
        {files.length === 0 ? (
          <p className="muted">
            Drop a table (.csv) of points measured on the body at rest: a distance along it or the
            name of a probe in each row, and positions or displacements. Or a test (.toml) of
            instruments, whose files are beside the design.
          </p>
        ) : (
          files.map((file) => <OneTable key={file.name} file={file} />)
        )}
      </div>
    </Section>
  );
}

function OneTable(props: { file: MeasuredFile }) {
  const { file } = props;
  const measured = useStudio((state) => state.measured[file.name]);
  return (
    <div className="measured" data-testid="measured">
      <div className="measured-head">
        <strong>{file.name}</strong>
        {measured && measured.problems.length === 0 && (
          <span className="badge good">{measured.stations} stations</span>
        )}
        <Button
          icon
          kind="quiet"
          label={`Remove ${file.name}`}
          onClick={() => removeFile(file.name)}
        >
          <Glyph name="trash" />
        </Button>
      </div>
      {measured ? <Columns file={file} measured={measured} /> : <p className="muted">Reading…</p>}
    </div>
  );
}

function Columns(props: { file: MeasuredFile; measured: MeasuredEvent }) {
  const { file, measured } = props;
  const change = (column: MeasuredColumn, next: { quantity?: string; unit?: string }) => {
    const columns = measured.columns.map(({ column: name, quantity, unit }) => {
      if (name !== column.column) return { column: name, quantity, unit };
      const chosen = next.quantity ?? quantity;
      const needs = !LABELS.has(chosen);
      return { column: name, quantity: chosen, unit: needs ? (next.unit ?? unit) || "mm" : "" };
    });
    changeFile(file.name, { columns });
  };
  return (
    <>
      <table className="measured-table" aria-label={`Columns of ${file.name}`}>
        <tbody>
          {measured.columns.map((column) => (
            <tr key={column.column}>
              <th scope="row" title={column.sample.join(", ")}>
                {column.column}
                <span className="muted">{column.sample.slice(0, 2).join(", ")}</span>
              </th>
              <td>
                <Select
                  bare
                  label={`Meaning of ${column.column}`}
                  value={column.quantity}
                  options={measured.quantities.map((name) => ({
                    value: name,
                    label: QUANTITIES[name] ?? name,
                  }))}
                  onChange={(quantity) => change(column, { quantity })}
                />
              </td>
              <td>
                {!LABELS.has(column.quantity) && (
                  <Select
                    bare
                    label={`Unit of ${column.column}`}
                    value={column.unit}
                    options={column.unit ? UNITS : [{ value: "", label: "unit?" }, ...UNITS]}
                    onChange={(unit) => change(column, { unit })}
                  />
                )}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      {measured.materials.length > 1 && (
        <Select
          label="Material"
          value={file.select ?? ""}
          options={[{ value: "", label: "choose…" }, ...measured.materials]}
          onChange={(select) => changeFile(file.name, { select: select || null })}
        />
      )}
      {measured.problems.map((problem) => (
        <p key={problem.where + problem.what} className="bad">
          {problem.where && <b>{problem.where}: </b>}
          {problem.what}
          {problem.hint && <span className="muted"> Try: {problem.hint}.</span>}
        </p>
      ))}
    </>
  );
}
