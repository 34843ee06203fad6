import { useState } from "react";
import { Section } from "../../controls/Choice";
import { useStudio } from "../../store/studio";
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
  const body = useStudio((state) => state.body);
  const room = body && { low: body.bounds[0], high: body.bounds[1] };
  const voxel = body?.voxel_size || 0.005;
  const schema = resolve(root, root.properties?.shapes ?? {}).additionalProperties;
  if (typeof schema !== "object") return null;
  const control = controlOf(root, schema);
  if (control.is !== "variant") return null;
  const shapes = (source.shapes as Record<string, Table> | undefined) ?? {};
  const add = (kind: ShapeKind) => {
    const value = variantStarter(root, control.tag, kind, control.variants[kind] ?? {}, names);
    editAll(withShape(value, source));
  };
  return (
    <Section title="Shapes" action={<ShapePicker variants={control.variants} onChoose={add} />}>
      {Object.keys(shapes).length === 0 && (
        <>
          <p className="muted">None yet. Add a box or a cylinder, then cut, join or repeat it.</p>
          <div className="shape-starts">
            {STARTS.map((kind) => (
              <button
                key={kind}
                type="button"
                className="shape-tile"
                data-testid={`start-${kind}`}
                onClick={() => add(kind)}
              >
                <ShapeIcon kind={kind} />
                <span>{kind}</span>
              </button>
            ))}
          </div>
        </>
      )}
      {shapeTree(shapes).map((node) =>
        node.again ? (
          <p
            key={`${node.name} in ${node.within}`}
            className="muted entry-again"
            style={{ marginLeft: node.depth * 14 }}
          >
            {node.name} (above)
          </p>
        ) : (
          <Entry
            key={node.name}
            title={node.name}
            about={`${shapes[node.name]?.kind ?? ""}${isUsed(node.name, source) ? "" : ", not used yet"}`}
            depth={node.depth}
            wrong={problemsAt(diagnostics, ["shapes", node.name]).length > 0}
            testId={`shapes-${node.name}`}
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
            <NameField section="shapes" name={node.name} taken={Object.keys(shapes)} />
            <TableFields path={["shapes", node.name]} schema={schema} value={shapes[node.name]} />
          </Entry>
        ),
      )}
      {menu && (
        <Menu
          label={`What to do with ${menu.name}`}
          at={menu.at}
          items={shapeVerbs(menu.name, source, room, voxel).map(({ label, changes }) => ({
            label,
            run: () => editAll(changes),
          }))}
          onClose={() => setMenu(null)}
        />
      )}
    </Section>
  );
}
