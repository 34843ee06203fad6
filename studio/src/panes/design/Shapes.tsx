import { useState } from "react";
import { Section } from "../../controls/Choice";
import { useStudio } from "../../store/studio";
import { setView, useView } from "../../store/view";
import { Entry, NameField, type Table } from "./Entries";
import { edit, editAll, problemsAt } from "./edits";
import { useForm } from "./form";
import { Menu, type MenuPlace } from "./Menu";
import { TableFields } from "./SchemaField";
import { ShapeIcon } from "./ShapeIcon";
import { ShapePicker } from "./ShapePicker";
import { controlOf, resolve } from "./schema";
import type { ShapeKind } from "./shapeKinds";
import { shapeTree } from "./shapeTree";
import { isUsed, shapeVerbs, withShape } from "./shapeVerbs";
import { variantStarter } from "./starters";

/** What most robots begin with. */
const STARTS: readonly ShapeKind[] = ["box", "cylinder", "sphere"];

export function Shapes() {
  const { root, source, diagnostics, names } = useForm();
  const [menu, setMenu] = useState<{ name: string; at: MenuPlace } | null>(null);
  const [open, setOpen] = useState<ReadonlySet<string>>(new Set());
  const chosen = useView((view) => view.shape);
  const body = useStudio((state) => state.body);
  const room = body && { low: body.bounds[0], high: body.bounds[1] };
  const voxel = body?.voxel_size || 0.005;
  const schema = resolve(root, root.properties?.shapes ?? {}).additionalProperties;
  if (typeof schema !== "object") return null;
  const control = controlOf(root, schema);
  if (control.is !== "variant") return null;
  const shapes = (source.shapes as Record<string, Table> | undefined) ?? {};
  const unfold = (name: string, is: boolean) =>
    setOpen(
      (before) => new Set(is ? [...before, name] : [...before].filter((one) => one !== name)),
    );
  const choose = (name: string) => {
    setView({ shape: name });
    unfold(name, true);
  };
  // A press chooses a shape and opens its fields; another one closes them again.
  const press = (name: string, opens: boolean) => {
    if (opens || chosen !== name) choose(name);
    else {
      setView({ shape: null });
      unfold(name, false);
    }
  };
  const add = (kind: ShapeKind) => {
    const variant = control.variants[kind] ?? {};
    // What moves or combines begins with the shape that is chosen.
    const first = chosen !== null && chosen in shapes ? [chosen] : [];
    const own = { ...names, shapes: [...first, ...names.shapes.filter((one) => one !== chosen)] };
    const { name, changes } = withShape(
      variantStarter(root, control.tag, kind, variant, own),
      source,
    );
    editAll(changes);
    choose(name);
  };
  return (
    <Section title="Shapes" action={<ShapePicker variants={control.variants} onChoose={add} />}>
      {Object.keys(shapes).length === 0 && <Starts onChoose={add} />}
      {shapeTree(shapes).map((node) =>
        node.again ? (
          <button
            key={`${node.name} in ${node.within}`}
            type="button"
            className={`muted entry-again${node.name === chosen ? " is-chosen" : ""}`}
            style={{ marginLeft: node.depth * 14 }}
            onClick={() => choose(node.name)}
          >
            {node.name} (above)
          </button>
        ) : (
          <Entry
            key={node.name}
            title={node.name}
            about={`${shapes[node.name]?.kind ?? ""}${isUsed(node.name, source) ? "" : ", not used yet"}`}
            depth={node.depth}
            wrong={problemsAt(diagnostics, ["shapes", node.name]).length > 0}
            testId={`shapes-${node.name}`}
            chosen={node.name === chosen}
            open={{ is: open.has(node.name), set: (is) => press(node.name, is) }}
            actions={[
              {
                glyph: "more",
                label: `What to do with ${node.name}`,
                run: (at) => setMenu({ name: node.name, at }),
              },
              {
                glyph: "trash",
                label: `Remove ${node.name}`,
                run: () => edit(["shapes", node.name], null),
              },
            ]}
          >
            <NameField
              section="shapes"
              name={node.name}
              taken={Object.keys(shapes)}
              onRenamed={(name) => {
                unfold(name, true);
                if (chosen === node.name) setView({ shape: name });
              }}
            />
            <TableFields path={["shapes", node.name]} schema={schema} value={shapes[node.name]} />
            {node.name === chosen && <NotDrawn name={node.name} />}
          </Entry>
        ),
      )}
      {menu && (
        <Menu
          label={`What to do with ${menu.name}`}
          at={menu.at}
          items={shapeVerbs(menu.name, source, room, voxel).map(({ label, changes, adds }) => ({
            label,
            run: () => {
              editAll(changes);
              if (adds) choose(adds);
            },
          }))}
          onClose={() => setMenu(null)}
        />
      )}
    </Section>
  );
}

/** Where there is no shape yet: what most robots begin with, one press away. */
function Starts(props: { onChoose(kind: ShapeKind): void }) {
  return (
    <>
      <p className="muted">None yet. Add a box or a cylinder, then cut, join or repeat it.</p>
      <div className="shape-starts">
        {STARTS.map((kind) => (
          <button
            key={kind}
            type="button"
            className="shape-tile"
            data-testid={`start-${kind}`}
            onClick={() => props.onChoose(kind)}
          >
            <ShapeIcon kind={kind} />
            <span>{kind}</span>
          </button>
        ))}
      </div>
    </>
  );
}

/** Why a chosen shape is not seen in the picture. */
function NotDrawn(props: { name: string }) {
  const ghost = useStudio((state) => state.ghosts?.shapes.find((one) => one.name === props.name));
  if (!ghost?.trouble) return null;
  return <p className="muted">Not drawn by itself: {ghost.trouble}.</p>;
}
