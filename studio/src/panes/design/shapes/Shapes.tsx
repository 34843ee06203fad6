import { useState } from "react";
import { Section } from "../../../controls/Choice";
import { useStudio } from "../../../store/studio";
import { setView, useView } from "../../../store/view";
import { editAll, problemsAt } from "../edits";
import { Entry, NameField, type Table } from "../fields/Entries";
import { Menu, type MenuPlace } from "../fields/Menu";
import { TableFields } from "../fields/SchemaField";
import { controlOf, resolve } from "../fields/schema";
import { useForm } from "../form";
import { remove } from "../removing/remove";
import { AddShape, FirstShapes } from "./AddShape";
import { spotOn } from "./shapeStarters";
import { shapeTree } from "./shapeTree";
import { FIRST_SPOT, isMadeOf, isUsed, joined, shapeVerbs, withShape } from "./shapeVerbs";

export function Shapes() {
  const { root, source, diagnostics } = useForm();
  const [menu, setMenu] = useState<{ name: string; onto?: string; at: MenuPlace } | null>(null);
  const [dragged, drag] = useState<string | null>(null);
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
  // A shape that moves or combines others begins with the chosen one.
  const all = Object.keys(shapes);
  const operands = [...all.filter((one) => one === chosen), ...all.filter((one) => one !== chosen)];
  const spot = room && all.length > 0 ? spotOn(room, voxel, operands) : { ...FIRST_SPOT, operands };
  const add = (value: Table) => {
    const { name, changes } = withShape(value, source);
    editAll(changes);
    choose(name);
  };
  return (
    <Section
      title="Shapes"
      action={<AddShape variants={control.variants} spot={spot} onAdd={add} />}
    >
      {all.length === 0 && <FirstShapes spot={spot} onAdd={add} />}
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
            drag={{
              takes: dragged !== null && !isMadeOf(dragged, node.name, shapes),
              begin: () => drag(node.name),
              end: () => drag(null),
              drop: (at) => dragged !== null && setMenu({ name: dragged, onto: node.name, at }),
            }}
            actions={[
              {
                glyph: "more",
                label: `What to do with ${node.name}`,
                run: (at) => setMenu({ name: node.name, at }),
              },
              {
                glyph: "trash",
                label: `Remove ${node.name}`,
                run: () => remove(["shapes", node.name], node.name),
              },
            ]}
          >
            <NameField
              section="shapes"
              name={node.name}
              taken={all}
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
          label={
            menu.onto
              ? `What to do with ${menu.name} and ${menu.onto}`
              : `What to do with ${menu.name}`
          }
          at={menu.at}
          items={(menu.onto
            ? joined(menu.name, menu.onto, shapes)
            : shapeVerbs(menu.name, source, room, voxel)
          ).map(({ label, changes, adds }) => ({
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

/** Why a chosen shape is not seen in the picture. */
function NotDrawn(props: { name: string }) {
  const ghost = useStudio((state) => state.ghosts?.shapes.find((one) => one.name === props.name));
  if (!ghost?.trouble) return null;
  return <p className="muted">Not drawn by itself: {ghost.trouble}.</p>;
}
