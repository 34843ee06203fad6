// The shapes of a design as a tree: shapes of parts and regions stand at the top, operands of a shape
// below it.

export interface ShapeNode {
  readonly name: string;
  readonly depth: number;
  /** Names and places on the way to it, no two of which are the same. */
  readonly within: string;
  /** It stands with its fields at another place of the tree. */
  readonly again: boolean;
}

type Table = Readonly<Record<string, unknown>>;

/** Names that a shape refers to, in the order in which it does. */
function operandsOf(shape: unknown): string[] {
  if (typeof shape === "string") return [shape];
  if (Array.isArray(shape)) return shape.flatMap(operandsOf);
  if (typeof shape !== "object" || shape === null) return [];
  const table = shape as Table;
  return [...operandsOf(table.of ?? []), ...(typeof table.by === "string" ? [table.by] : [])];
}

/** All shapes, each once with its fields, below the first shape that uses it. */
export function shapeTree(shapes: Readonly<Record<string, unknown>>): ShapeNode[] {
  const uses = new Map(
    Object.entries(shapes).map(([name, shape]) => {
      const inner = (shape as Table | null)?.of ?? [];
      return [name, operandsOf(inner).filter((one) => one in shapes)] as const;
    }),
  );
  const used = new Set([...uses.values()].flat());
  const found: ShapeNode[] = [];
  const seen = new Set<string>();
  const visit = (name: string, depth: number, within: string): void => {
    const again = seen.has(name);
    seen.add(name);
    found.push({ name, depth, within, again });
    if (again) return;
    for (const [i, inner] of (uses.get(name) ?? []).entries()) {
      visit(inner, depth + 1, `${within}/${name} ${i}`);
    }
  };
  for (const name of Object.keys(shapes)) if (!used.has(name)) visit(name, 0, "");
  // The rest refers to itself in a circle, which the diagnostics report.
  for (const name of Object.keys(shapes)) if (!seen.has(name)) visit(name, 0, "");
  return found;
}
