import { Section } from "../../controls/Choice";
import { Adder, Entry, NameField, type Table } from "./Entries";
import { edit, problemsAt } from "./edits";
import { useForm } from "./form";
import { TableFields } from "./SchemaField";
import { resolve } from "./schema";
import { shapeTree } from "./shapeTree";
import { freeName } from "./starters";

export function Shapes() {
  const { root, source, diagnostics } = useForm();
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
          onAdd={(value) => {
            const kind = String((value as Table).kind ?? "shape");
            edit(["shapes", freeName(kind, Object.keys(shapes))], value);
          }}
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
            about={String(shapes[node.name]?.kind ?? "")}
            depth={node.depth}
            wrong={problemsAt(diagnostics, ["shapes", node.name]).length > 0}
            testId={`shapes-${node.name}`}
            actions={[
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
    </Section>
  );
}
