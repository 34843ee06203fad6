import { useState } from "react";
import { Section } from "../../controls/Choice";
import { useStudio } from "../../store/studio";
import { Adder, Entry, NameField, type Table } from "./Entries";
import { edit, editAll, problemsAt } from "./edits";
import { useForm } from "./form";
import { Menu, type MenuPlace } from "./Menu";
import { TableFields } from "./SchemaField";
import { resolve } from "./schema";
import { shapeTree } from "./shapeTree";
import { isUsed, shapeVerbs, withShape } from "./shapeVerbs";

export function Shapes() {
  const { root, source, diagnostics } = useForm();
  const [menu, setMenu] = useState<{ name: string; at: MenuPlace } | null>(null);
  const body = useStudio((state) => state.body);
  const room = body && { low: body.bounds[0], high: body.bounds[1] };
  const voxel = body?.voxel_size || 0.005;
  const schema = resolve(root, root.properties?.shapes ?? {}).additionalProperties;
  if (typeof schema !== "object") return null;
  const shapes = (source.shapes as Record<string, Table> | undefined) ?? {};
  return (
    <Section
      title="Shapes"
      action={
        <Adder
          what="a shape"
          schema={schema}
          onAdd={(value) => editAll(withShape(value as Table, source))}
        />
      }
    >
      {Object.keys(shapes).length === 0 && (
        <p className="muted">None yet. Add a box or a cylinder, then cut, join or repeat it.</p>
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
