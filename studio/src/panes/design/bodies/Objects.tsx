// Objects that the body touches: added beside it, with the few things that matter first.

import { useRef } from "react";
import { Button, Section, Select } from "../../../controls/Choice";
import { bytesOf } from "../../../engine/base64";
import { MESHES } from "../../../protocol";
import { sendFile } from "../../../shell/DropZone";
import { askImport, boxOfImport, shapeOfImport } from "../../../shell/importMesh";
import { toast, useStudio } from "../../../store/studio";
import { setView } from "../../../store/view";
import { edit, editAll } from "../edits";
import { NameField, ThingEntry } from "../fields/Entries";
import { TableFields } from "../fields/SchemaField";
import { resolve, type Schema } from "../fields/schema";
import { freeName } from "../fields/starters";
import { useForm } from "../form";
import { CopyTools } from "./CopyTools";
import { FrictionField } from "./FrictionField";
import {
  type Motion,
  meshShape,
  motionOf,
  newShape,
  PRIMITIVES,
  type Primitive,
  type Table,
  withMotion,
} from "./gripped";
import { lifting, liftOf } from "./lifting";
import { boxOf, type Surroundings, surroundingsOf, written } from "./placing";

const MOTIONS: readonly { value: Motion; label: string }[] = [
  { value: "fixed", label: "fixed" },
  { value: "moved", label: "moved along a way" },
  { value: "free", label: "free, with a mass" },
];

export function Objects() {
  const { root, source } = useForm();
  const schema = root.properties?.objects?.items;
  if (!schema) return null;
  const values = (source.objects as Table[] | undefined) ?? [];
  return (
    <Section title="Objects" action={<AddObject values={values} />}>
      {values.length === 0 && (
        <p className="muted">None. Add an object to grip: a rigid thing that the body touches.</p>
      )}
      {values.map((value, i) => (
        <ThingEntry
          // biome-ignore lint/suspicious/noArrayIndexKey: entries may have no other name
          key={i}
          section="objects"
          index={i}
          value={value}
          about={`${motionOf(value)}, ${describeShape(value.shape)}`}
        >
          <ObjectFields index={i} value={value} all={values} schema={schema} />
        </ThingEntry>
      ))}
    </Section>
  );
}

function describeShape(shape: unknown): string {
  if (typeof shape !== "object" || shape === null) return String(shape ?? "");
  const { kind, of } = shape as Table;
  const inner = typeof of === "object" && of !== null ? (of as Table).kind : undefined;
  return String(inner === "mesh" ? inner : (kind ?? ""));
}

function AddObject(props: { values: readonly Table[] }) {
  const { values } = props;
  const { source, design } = useForm();
  const body = useStudio((state) => state.body);
  const file = useRef<HTMLInputElement>(null);
  const floor = (design?.floor as { z?: unknown } | undefined)?.z;
  const around = () => surroundingsOf(body, source.floor === undefined ? null : floor);
  const add = (wanted: string, shape: Table) => {
    const name = freeName(
      wanted,
      values.map((value) => String(value.name)),
    );
    edit(["objects", values.length], { name, shape, motion: "fixed" });
    setView({ chosen: name });
  };
  return (
    <>
      <select
        className="select add-kind"
        aria-label="Add an object to grip"
        title="Add an object to grip"
        data-testid="add-object"
        value=""
        onChange={(event) => {
          const kind = event.target.value;
          if (kind === "stl") file.current?.click();
          else add(kind === "sphere" ? "ball" : kind, newShape(kind as Primitive, around()));
        }}
      >
        <option value="">+</option>
        {PRIMITIVES.map((kind) => (
          <option key={kind} value={kind}>
            {kind}
          </option>
        ))}
        <option value="stl">From a file…</option>
      </select>
      <input
        ref={file}
        type="file"
        accept={MESHES.join(",")}
        hidden
        aria-label="Mesh file of an object"
        data-testid="object-file"
        onChange={(event) => {
          const chosen = event.target.files?.[0];
          event.target.value = "";
          if (chosen) void readObject(chosen, around, add);
        }}
      />
    </>
  );
}

async function readObject(
  file: File,
  around: () => Surroundings | null,
  add: (name: string, shape: Table) => void,
): Promise<void> {
  const sent = await sendFile(file);
  const read = sent && (await askImport(sent.name));
  if (!sent || !read) return;
  const { low, high } = boxOfImport(read);
  const name = sent.name.replace(/\.[^.]+$/, "");
  add(name, meshShape(shapeOfImport(read.how, sent.path), low, high, around()));
}

function ObjectFields(props: {
  index: number;
  value: Table;
  all: readonly Table[];
  schema: Schema;
}) {
  const { index, value, all } = props;
  const { root } = useForm();
  const path = ["objects", index];
  const motion = motionOf(value);
  const name = String(value.name);
  return (
    <>
      <NameField section="objects" name={name} taken={all.map((one) => String(one.name))} />
      <Select
        label="Motion"
        title="Whether it stays, goes a way as a clamp does, or falls and is pushed, over time."
        value={motion}
        options={MOTIONS}
        onChange={(next) =>
          edit(path, withMotion(value, next as Motion, useStudio.getState().body))
        }
      />
      {motion === "free" && <Lifting name={name} />}
      {motion === "moved" && (
        <TableFields
          path={[...path, "motion"]}
          schema={wayOf(root, props.schema)}
          value={value.motion}
        />
      )}
      <FrictionField name={name} objects={all.length} />
      <CopyTools name={name} />
      <TableFields path={path} schema={props.schema} value={value} without={["motion", "name"]} />
    </>
  );
}

/** Grips and lifts an object by all that the design has, as entries of the text that can be changed. */
function Lifting({ name }: { name: string }) {
  const { source } = useForm();
  const body = useStudio((state) => state.body);
  const object = body?.objects.find((one) => one.name === name);
  if (!body || !object || (source.solver as Table | undefined)?.end_time !== undefined) return null;
  const room = boxOf(new Float32Array(bytesOf(object.vertices)));
  const [low, high] = body.bounds;
  const changes = lifting(source, room, { low, high }, body.voxel_size);
  if (changes.length === 0) {
    return <p className="muted">Clamp what is to grip it; then it can be lifted here.</p>;
  }
  return (
    <Button
      kind="primary"
      testId="grip-and-lift"
      title="Over time: pressures come on, then all clamps go up, with what is gripped"
      onClick={() => {
        editAll(changes);
        toast({
          level: "good",
          what: `Grips ${name}, then lifts it by ${written(liftOf(room))}`,
          hint: "Histories close, lift and weight of the design say when. Ctrl+Z takes it back.",
          about: "design",
        });
      }}
    >
      Grip and lift it by {written(liftOf(room))}
    </Button>
  );
}

/** The schema of a motion that is a way, among those that an object may have. */
function wayOf(root: Schema, object: Schema): Schema {
  const options = resolve(root, object).properties?.motion?.anyOf ?? [];
  return options.map((option) => resolve(root, option)).find((one) => one.properties) ?? {};
}

/** Entries of contact that are not of one object. */
export function ContactSection() {
  const { root, source } = useForm();
  const given = root.properties?.contact;
  const table = given?.anyOf?.map((one) => resolve(root, one)).find((one) => one.properties);
  const schema = table ?? resolve(root, given ?? {});
  if (!schema.properties || !("contact" in source)) return null;
  return (
    <Section title="Contact">
      <TableFields path={["contact"]} schema={schema} value={source.contact} />
    </Section>
  );
}
