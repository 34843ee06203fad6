// The ways to a new shape: the picker of all kinds, a file, and the first shapes of most robots.

import { useRef } from "react";
import { MESHES } from "../../../protocol";
import { sendFile } from "../../../shell/DropZone";
import { askImport, shapeOfImport } from "../../../shell/importMesh";
import { send } from "../../../store/session";
import type { Schema } from "../fields/schema";
import { ShapeIcon } from "./ShapeIcon";
import { ShapePicker } from "./ShapePicker";
import { type Addable, FIRST_KINDS, isFeature } from "./shapeKinds";
import { type Spot, shapeStarter } from "./shapeStarters";

type Table = Readonly<Record<string, unknown>>;

interface Props {
  /** Place of the new shape. */
  readonly spot: Spot;
  onAdd(shape: Table): void;
}

export function AddShape(props: Props & { variants: Readonly<Record<string, Schema>> }) {
  const file = useRef<HTMLInputElement>(null);
  const addFile = async (mesh: File) => {
    const sent = await sendFile(mesh);
    const read = sent && (await askImport(sent.name));
    if (read) props.onAdd(shapeOfImport(read.how, sent.path));
  };
  return (
    <>
      <ShapePicker
        variants={props.variants}
        onChoose={(kind) => {
          if (kind === "mesh") file.current?.click();
          else begin(kind, props);
        }}
      />
      <input
        ref={file}
        type="file"
        accept={MESHES.join(",")}
        hidden
        aria-label="Mesh file of a shape"
        data-testid="shape-file"
        onChange={(event) => {
          const [mesh] = event.target.files ?? [];
          if (mesh) void addFile(mesh);
          event.target.value = "";
        }}
      />
    </>
  );
}

/** Add a shape, or a ready feature, at the place of new shapes. */
function begin(kind: Addable, { spot, onAdd }: Props): void {
  if (isFeature(kind)) send({ t: "add_feature", name: kind, at: spot.middle });
  else onAdd(shapeStarter(kind, spot));
}

/** First shapes of most robots, one press away, where there is no shape yet. */
export function FirstShapes(props: Props) {
  return (
    <>
      <p className="muted">
        None yet. Add a box or a cylinder, then cut, join or repeat it; or begin with a finished
        feature and change its numbers.
      </p>
      <div className="shape-starts">
        {FIRST_KINDS.map((kind) => (
          <button
            key={kind}
            type="button"
            className="shape-tile"
            data-testid={`start-${kind}`}
            onClick={() => begin(kind, props)}
          >
            <ShapeIcon kind={kind} />
            <span>{kind}</span>
          </button>
        ))}
      </div>
    </>
  );
}
