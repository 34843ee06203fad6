// The form of the design: one document with the text beside it.
import { Button, Empty, Section } from "../../controls/Choice";
import { useStudio } from "../../store/studio";
import { browseMaterials } from "../materials/browse";
import { Bodies } from "./bodies/Bodies";
import { ContactSection, Objects } from "./bodies/Objects";
import { edit } from "./edits";
import { fitted, obstacleTo } from "./fields/begun";
import { Adder, EntryList, EntryMap, type Table } from "./fields/Entries";
import { Glyph } from "./fields/Glyph";
import { SchemaField, TableFields } from "./fields/SchemaField";
import {
  helpOfKeys,
  labelOf,
  listSections,
  resolve,
  type Schema,
  single,
  summary,
} from "./fields/schema";
import { materialName } from "./fields/starters";
import { type Form, FormContext } from "./form";
import { Gallery } from "./Gallery";
import { Goals } from "./Goals";
import { Parameters } from "./parameters/Parameters";
import { Shapes } from "./shapes/Shapes";
import { NO_DIAGNOSTICS, useFormOfDocument } from "./useForm";
import "./design.css";

export default function DesignPane() {
  const form = useFormOfDocument();
  const connected = useStudio((state) => state.hello !== null);
  const document = useStudio((state) => state.document);
  const several = Array.isArray(form?.source.bodies) && form.source.bodies.length > 0;
  if (!connected) {
    return (
      <Empty title="Waiting for VoxSoft">
        <p>The form appears when the server has answered.</p>
      </Empty>
    );
  }
  return (
    <div className="pane design" data-testid="design-form">
      <Gallery />
      {document && !document.valid && !document.empty && <Faults />}
      {form && (
        <FormContext value={form}>
          <Parameters />
          <General form={form} />
          <Bodies />
          <Shapes />
          <EntryMap
            section="materials"
            title="Materials"
            what="a material"
            first={materialName}
            action={
              <Button
                kind="quiet"
                title="All materials with their curves, to choose from"
                onClick={() => browseMaterials()}
              >
                Browse…
              </Button>
            }
            empty="None of its own: parts name cards such as ecoflex-00-30."
          />
          <EntryList
            section="parts"
            title="Parts"
            what="a part"
            empty={
              several
                ? "None of its own: the bodies have theirs."
                : "None yet. A part is a shape made of a material."
            }
            note="Where parts overlap, the upper one wins."
          />
          <EntryList
            section="layers"
            title="Layers"
            what="a layer"
            empty="None. A layer is a thin sheet that resists stretch, such as fabric."
          />
          <OtherLists root={form.root} />
          <Objects />
          <ContactSection />
          <EntryList
            section="clamps"
            title="Clamps"
            what="a clamp"
            begin={atTheFoot}
            empty={
              several
                ? "None of its own: the bodies have theirs."
                : "None yet. Without one the body floats away."
            }
          />
          <EntryList
            section="loads"
            title="Loads"
            what="a load"
            empty="None yet. Add pressure, gravity, a force or a traction."
          />
          <EntryMap
            section="histories"
            title="Histories"
            what="a history"
            first="history"
            empty="None. A history is a factor over time, by which loads, motions and tendons come and go."
          />
          <Floor form={form} />
          <EntryMap
            section="chambers"
            title="Chambers"
            what="a chamber"
            first="chamber"
            empty="None has a name. A chamber is named by a place in it; loads and metrics then call it by that name."
          />
          <EntryMap
            section="probes"
            title="Probes"
            what="a probe"
            first="probe"
            empty="None yet. A probe is a place where displacements are measured."
          />
          <Goals />
          <Solver form={form} />
        </FormContext>
      )}
      {document && !form && (
        <p className="section muted">
          The text cannot be read as a table of values; the form comes back when it can.
        </p>
      )}
    </div>
  );
}

/** Errors of the text, in words; the fields below show them at their places. */
function Faults() {
  const diagnostics = useStudio((state) => state.document?.diagnostics ?? NO_DIAGNOSTICS);
  const wasGood = useStudio((state) => (state.document?.design ?? null) !== null);
  return (
    <div className="faults" role="alert" data-testid="faults">
      {diagnostics.slice(0, 3).map((one) => (
        <p key={`${one.where} ${one.what}`}>
          <b>{one.where || `line ${one.line}`}</b> {one.what}
          {one.hint && <span className="muted"> Try: {one.hint}.</span>}
        </p>
      ))}
      {wasGood && <p className="muted">The view shows the last design that was good.</p>}
    </div>
  );
}

/** A new clamp at the lowest layer of the body, which is where most stand. */
function atTheFoot(clamp: Table): Table {
  const low = useStudio.getState().body?.bounds[0][2];
  if (low === undefined) return clamp;
  const level = low === 0 ? 0 : `${Number((1000 * low).toFixed(6))} mm`;
  return { ...clamp, region: { z: [level, level] } };
}

/** Lists that have their own place and words in the form. */
const PLACED = ["bodies", "parts", "layers", "objects", "clamps", "loads"];

/** All other lists of the schema, in its words. */
function OtherLists(props: { root: Schema }) {
  const { root } = props;
  const body = useStudio((state) => state.body);
  return listSections(root)
    .filter((section) => !PLACED.includes(section))
    .map((section) => {
      const word = single(section).toLowerCase();
      const what = `${/^[aeiou]/.test(word) ? "an" : "a"} ${word}`;
      const schema = resolve(root, root.properties?.[section]?.items ?? {});
      return (
        <EntryList
          key={section}
          section={section}
          title={labelOf(section)}
          what={what}
          empty={`None. ${summary(schema)}`}
          obstacle={obstacleTo(section, body)}
          begin={(value) => fitted(section, value, body)}
        />
      );
    });
}

const GENERAL = ["name", "description", "voxel_size", "fill"];

function General(props: { form: Form }) {
  const { root, source } = props.form;
  const help: Readonly<Record<string, string>> = {
    ...helpOfKeys(root),
    voxel_size: "Edge of a voxel. Halving it makes eight times as many.",
    fill: "binary: a voxel is full or empty; fraction: cut voxels count by their share. Unset: fraction for rubber, binary with a spring lattice.",
  };
  return (
    <Section title="Design">
      {GENERAL.filter((key) => key in source || key === "voxel_size" || key === "name").map(
        (key) => (
          <SchemaField
            key={key}
            path={[key]}
            schema={root.properties?.[key] ?? {}}
            value={source[key]}
            label={{ voxel_size: "Voxel size", name: "Name", fill: "Fill" }[key] ?? "Description"}
            help={help[key]}
          />
        ),
      )}
    </Section>
  );
}

function Floor(props: { form: Form }) {
  const { root, source } = props.form;
  const schema = root.properties?.floor?.anyOf?.[0];
  if (!schema) return null;
  const there = "floor" in source;
  return (
    <Section
      title="Floor"
      empty={!there && "None. A floor is a plane that nothing sinks through."}
      action={
        there ? (
          <Button icon kind="quiet" label="Remove the floor" onClick={() => edit(["floor"], null)}>
            <Glyph name="trash" />
          </Button>
        ) : (
          <Adder what="a floor" schema={schema} onAdd={() => edit(["floor"], { z: 0 })} />
        )
      }
    >
      {there && <TableFields path={["floor"]} schema={schema} value={source.floor} />}
    </Section>
  );
}

function Solver(props: { form: Form }) {
  const { root, source } = props.form;
  const schema = root.properties?.solver;
  if (!schema) return null;
  return (
    <Section title="Solver">
      {!("solver" in source) && (
        <p className="muted">Chosen from the design: statics for rubber, XPBD for lattices.</p>
      )}
      <TableFields path={["solver"]} schema={schema} value={source.solver} />
    </Section>
  );
}
