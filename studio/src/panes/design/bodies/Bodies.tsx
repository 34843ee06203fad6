// Bodies of a design: other design files, each placed, copied, mirrored and arranged.

import { useEffect, useRef, useState } from "react";
import { Button, Section, Select } from "../../../controls/Choice";
import { describeValue } from "../../../controls/kinds";
import { TextField } from "../../../controls/TextField";
import type { DesignFile, MeshImport } from "../../../protocol";
import { MESHES } from "../../../protocol";
import { sendFile } from "../../../shell/DropZone";
import { askImport } from "../../../shell/importMesh";
import { send } from "../../../store/session";
import { useStudio } from "../../../store/studio";
import { edit, openHere, problemsAt, problemText } from "../edits";
import { NameField, type Table, ThingEntry } from "../fields/Entries";
import { SchemaField, TableFields } from "../fields/SchemaField";
import { helpOfKeys, resolve, type Schema } from "../fields/schema";
import { useForm } from "../form";
import { CopyTools } from "./CopyTools";
import { BODY, beyondOf } from "./several";

/** Keys that have a place of their own among the fields of a body. */
const PLACED = ["name", "design", "set", "position", "rotation", "mirror"];

export function Bodies() {
  const { root, source } = useForm();
  const files = useDesignFiles();
  const given = root.properties?.bodies?.items;
  if (!given) return null;
  const schema = resolve(root, given);
  const values = (source.bodies as Table[] | undefined) ?? [];
  return (
    <Section title="Bodies" action={<AddBody files={files} />}>
      {values.length === 0 && (
        <>
          <p className="muted">
            One, of the parts below. A copy, or a body that is added, makes a new design of several,
            in which this one is a file.
          </p>
          <CopyTools name={BODY} />
        </>
      )}
      {values.map((value, i) => (
        <ThingEntry
          // biome-ignore lint/suspicious/noArrayIndexKey: entries may have no other name
          key={i}
          section="bodies"
          index={i}
          value={value}
          about={aboutBody(value)}
        >
          <BodyFields index={i} value={value} schema={schema} files={files} all={values} />
        </ThingEntry>
      ))}
    </Section>
  );
}

/** The design files beside the document, asked for whenever another document is shown. */
function useDesignFiles(): readonly DesignFile[] {
  const folder = useStudio((state) => state.document?.folder);
  const name = useStudio((state) => state.document?.path ?? state.document?.name);
  const connected = useStudio((state) => state.link.state === "open");
  useEffect(() => {
    if (connected && folder && name) send({ t: "designs" });
  }, [folder, name, connected]);
  return useStudio((state) => state.designs)?.files ?? NO_FILES;
}

const NO_FILES: readonly DesignFile[] = [];

function aboutBody(value: Table): string {
  const { design, mirror } = value;
  const what = typeof design === "string" ? design : design ? "a design of its own" : "own parts";
  const image = mirror ? ", mirrored" : "";
  const angle = (value.rotation as Table | undefined)?.angle;
  const turned = angle ? `, turned ${describeValue(angle)}` : "";
  const moved = Array.isArray(value.position) && value.position.some((one) => one !== 0);
  const place = moved ? ` at ${describeValue(value.position)}` : "";
  return `${what}${image}${turned}${place}`;
}

function AddBody(props: { files: readonly DesignFile[] }) {
  const templates = useStudio((state) => state.hello?.templates) ?? [];
  const picker = useRef<HTMLInputElement>(null);
  const add = (what: "file" | "template" | "upload", name: string, mesh?: MeshImport) => {
    const beyond = beyondOf(useStudio.getState().body);
    send({ t: "add_body", what, name, beyond, ...(mesh ? { mesh } : {}) });
  };
  const addFile = async (file: File) => {
    const sent = await sendFile(file);
    if (!sent) return;
    if (sent.name.endsWith(".toml")) return add("upload", sent.name);
    const read = await askImport(sent.name);
    if (read) add("upload", sent.name, read.how);
  };
  return (
    <>
      <select
        className="select add-kind"
        aria-label="Add a body"
        title="Add a body"
        data-testid="add-body"
        value=""
        onPointerDown={() => send({ t: "designs" })}
        onChange={(event) => {
          const [what, ...name] = event.target.value.split(":");
          if (what === "upload") picker.current?.click();
          else if (what === "file" || what === "template") add(what, name.join(":"));
        }}
      >
        <option value="">+</option>
        {props.files.length > 0 && (
          <optgroup label="Designs of this folder">
            {props.files.map(({ file, title }) => (
              <option key={file} value={`file:${file}`}>
                {title === file.replace(/\.toml$/, "") ? file : `${file} (${title})`}
              </option>
            ))}
          </optgroup>
        )}
        <optgroup label="Templates">
          {templates.map(({ name }) => (
            <option key={name} value={`template:${name}`}>
              {name}
            </option>
          ))}
        </optgroup>
        <option value="upload">From a file…</option>
      </select>
      <input
        ref={picker}
        type="file"
        accept={[".toml", ...MESHES].join(",")}
        hidden
        aria-label="Design of a body"
        data-testid="body-file"
        onChange={(event) => {
          const chosen = event.target.files?.[0];
          event.target.value = "";
          if (chosen) void addFile(chosen);
        }}
      />
    </>
  );
}

function BodyFields(props: {
  index: number;
  value: Table;
  schema: Schema;
  files: readonly DesignFile[];
  all: readonly Table[];
}) {
  const { index, value, schema } = props;
  const path = ["bodies", index];
  const help = helpOfKeys(schema);
  const field = (key: string, label: string) => (
    <SchemaField
      path={[...path, key]}
      schema={schema.properties?.[key] ?? {}}
      value={value[key]}
      label={label}
      help={help[key]}
      onRemove={() => edit([...path, key], null)}
    />
  );
  const name = String(value.name ?? "");
  return (
    <>
      <NameField section="bodies" name={name} taken={props.all.map((one) => String(one.name))} />
      <DesignOfBody {...props} />
      {value.position !== undefined && field("position", "Position")}
      {value.rotation !== undefined && field("rotation", "Rotation")}
      <div className="row">
        {value.position === undefined && (
          <Button
            kind="quiet"
            testId="move-body"
            onClick={() => edit([...path, "position"], ["0 mm", "0 mm", "0 mm"])}
          >
            Move…
          </Button>
        )}
        {value.rotation === undefined && (
          <Button
            kind="quiet"
            testId="turn-body"
            onClick={() => edit([...path, "rotation"], { axis: [0, 0, 1], angle: "0 deg" })}
          >
            Turn…
          </Button>
        )}
      </div>
      {value.design !== undefined && (
        <Select
          label="Mirror image"
          title="The mirror image of the design, before it is turned and moved"
          value={String(value.mirror ?? "")}
          options={[
            { value: "", label: "no" },
            ...["x", "y", "z"].map((axis) => ({ value: axis, label: `across its own ${axis}` })),
          ]}
          onChange={(axis) => edit([...path, "mirror"], axis || null)}
        />
      )}
      <CopyTools name={name} mirrors={value.design !== undefined} />
      <TableFields path={path} schema={schema} value={value} without={PLACED} />
    </>
  );
}

/** Which file a body is made of, and the values that it gives to the parameters there. */
function DesignOfBody(props: { index: number; value: Table; files: readonly DesignFile[] }) {
  const { diagnostics } = useForm();
  const folder = useStudio((state) => state.document?.folder ?? "");
  const [all, showAll] = useState(false);
  const { value, files } = props;
  const path = ["bodies", props.index];
  const { design } = value;
  if (typeof design !== "string") {
    return (
      <p className="muted">
        {design ? "Its design stands in the text." : "It has parts of its own."}
      </p>
    );
  }
  const known = files.find((one) => one.file === design);
  const set = (value.set as Table | undefined) ?? {};
  const names = [...new Set([...Object.keys(set), ...Object.keys(known?.parameters ?? {})])];
  const shown = all ? names : names.filter((name) => name in set);
  const options = files.map((one) => one.file);
  const problem = problemText(problemsAt(diagnostics, [...path, "design"]));
  return (
    <>
      <Select
        label="Design"
        title="The design file that it is made of"
        value={design}
        options={options.includes(design) ? options : [design, ...options]}
        onChange={(file) => edit([...path, "design"], file)}
      />
      {problem && <span className="field-note">{problem}</span>}
      {shown.map((name) => (
        <TextField
          key={name}
          label={name}
          title="A parameter of its design: a value, or a formula of the parameters of this one"
          right
          value={String(set[name] ?? known?.parameters[name] ?? "")}
          problem={problemText(problemsAt(diagnostics, [...path, "set", name]))}
          changed={name in set}
          onDefault={name in set ? () => edit([...path, "set", name], null) : undefined}
          onCommit={(text) => {
            edit([...path, "set", name], text.trim() === "" ? null : text.trim());
            return null;
          }}
        />
      ))}
      <div className="row">
        {names.length > shown.length && (
          <Button kind="quiet" onClick={() => showAll(true)}>
            Its parameters…
          </Button>
        )}
        <Button
          kind="quiet"
          label={`Open ${design} itself`}
          onClick={() => openHere("file", `${folder}/${design}`)}
        >
          Open its design
        </Button>
      </div>
    </>
  );
}
