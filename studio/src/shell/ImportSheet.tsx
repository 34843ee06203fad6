// Card of a mesh that does not say its unit: sizes in each unit side by side, scale and orientation.
import { useState } from "react";
import { Button, Select } from "../controls/Choice";
import { NumberField } from "../controls/NumberField";
import { TextField } from "../controls/TextField";
import { formatNumber, formatQuantity, parseQuantity } from "../controls/units";
import type { MeshFactsEvent, MeshImport } from "../protocol";
import { openSheet } from "../store/page";
import { boxOfImport, useImporting } from "./importMesh";

const UNITS = ["mm", "cm", "m", "inch"] as const;

const UPWARD: readonly { value: NonNullable<MeshImport["up"]>; label: string }[] = [
  { value: "z", label: "z, as it is" },
  { value: "y", label: "y" },
  { value: "x", label: "x" },
  { value: "-z", label: "−z, upside down" },
  { value: "-y", label: "−y" },
  { value: "-x", label: "−x" },
];

export function ImportSheet() {
  const { facts } = useImporting();
  return facts && <Card key={facts.name} facts={facts} />;
}

function Card(props: { facts: MeshFactsEvent }) {
  const { facts } = props;
  const [how, setHow] = useState<Required<MeshImport>>({ unit: facts.unit, scale: 1, up: "z" });
  const change = (next: Partial<MeshImport>) => setHow({ ...how, ...next });
  const { low, high } = boxOfImport({ facts, how });
  const sides = high.map((end, axis) => end - (low[axis] ?? 0));
  const longest = Math.max(...sides);
  const voxel = facts.voxels ? how.unit : lengthText(longest / facts.cells, 2);
  return (
    <form
      className="save-sheet import-sheet"
      onSubmit={(event) => {
        event.preventDefault();
        useImporting.getState().confirm(how);
        openSheet(null);
      }}
    >
      <h2>Import {facts.name}</h2>
      {facts.voxels ? (
        <TextField
          label="Width of a voxel"
          value={how.unit}
          right
          onCommit={(text) => {
            const read = parseQuantity(text, "mm");
            if ("problem" in read) return read.problem;
            if (read.value <= 0) return "a width is positive";
            change({ unit: lengthText(read.value, 6) });
            return null;
          }}
        />
      ) : (
        <fieldset className="import-units">
          <legend>The file does not say its unit. Its body is</legend>
          {UNITS.map((unit) => (
            <label key={unit} className={how.unit === unit ? "is-chosen" : undefined}>
              <input
                type="radio"
                name="import-unit"
                value={unit}
                checked={how.unit === unit}
                onChange={() => change({ unit })}
              />
              <strong>{unit}</strong>
              <span>{sizesText({ facts, how: { ...how, unit } })}</span>
              {facts.unit === unit && <span className="badge good">likely</span>}
            </label>
          ))}
        </fieldset>
      )}
      <NumberField
        label="Scale"
        title="Factor on all lengths"
        value={how.scale}
        min={1e-6}
        step={0.1}
        onChange={(scale) => change({ scale })}
      />
      <Select
        label="Up in the file"
        title="The axis of the file that points up in the design"
        value={how.up}
        options={UPWARD}
        onChange={(up) => change({ up: up as MeshImport["up"] & string })}
      />
      {facts.parts.length > 1 && (
        <p className="muted">
          {facts.parts.length} parts: {facts.parts.join(", ")}
        </p>
      )}
      <p data-testid="import-result">
        {sizesText({ facts, how })}, in voxels of {shownLength(voxel)}
      </p>
      <div className="sheet-buttons">
        <Button kind="quiet" onClick={() => openSheet(null)}>
          Cancel
        </Button>
        <button type="submit" className="button primary" data-testid="import-now">
          Import
        </button>
      </div>
    </form>
  );
}

/** A length with the unit that suits it best. */
function lengthText(meter: number, digits: number): string {
  if (meter >= 1) return `${formatNumber(meter, digits)} m`;
  if (meter >= 1e-4) return formatQuantity(meter, "m", digits);
  return `${formatNumber(meter * 1e6, digits)} um`;
}

/** A length as it is set in type. */
function shownLength(text: string): string {
  return text.replace(/\bum$/, "µm");
}

/** Sides of the box, in the unit that suits the longest. */
function sizesText(read: Parameters<typeof boxOfImport>[0]): string {
  const { low, high } = boxOfImport(read);
  const sides = high.map((end, axis) => end - (low[axis] ?? 0));
  const unit =
    lengthText(Math.max(...sides), 3)
      .split(" ")
      .at(-1) ?? "mm";
  const factor = { m: 1, mm: 1e-3, um: 1e-6 }[unit] ?? 1;
  const numbers = sides.map((side) => formatNumber(side / factor, 3));
  return shownLength(`${numbers.join(" × ")} ${unit}`);
}
