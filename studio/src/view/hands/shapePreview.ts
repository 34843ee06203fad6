// Preview of a shape while a number of it is changed by hand.
import { Matrix4, Vector3 } from "three";
import type { ShapeGrip } from "../../panes/design/shapes/shapeReader";

/** From a shape as it is to how it is drawn while a number of it is another, in its own frame. */
export function previewOf(grip: ShapeGrip, value: number, out = new Matrix4()): Matrix4 {
  out.identity();
  const by = value - grip.value;
  const moves = grip.shift ?? (grip.moves && "along" in grip.way ? grip.way.along : null);
  if (moves) return out.makeTranslation(new Vector3(...moves).multiplyScalar(by));
  if ("about" in grip.way) {
    if (grip.stretch !== "turn") return out;
    const center = new Vector3(...grip.from);
    out.makeRotationAxis(new Vector3(...grip.way.about), by);
    return out.setPosition(center.clone().sub(center.clone().applyMatrix4(out)));
  }
  if (grip.stretch === "none" || grip.value <= 0) return out;
  const more = value / grip.value - 1;
  const axis = "along" in grip.way ? grip.way.along : (grip.way.around ?? [0, 0, 0]);
  const entry = (i: number, k: number) => {
    const same = i === k ? 1 : 0;
    const part = axis[i]! * axis[k]!;
    const stretched = { along: part, across: same - part, all: same }[
      grip.stretch as "along" | "across" | "all"
    ];
    return same + more * stretched;
  };
  const rows = [0, 1, 2].map((i) => [0, 1, 2].map((k) => entry(i, k)));
  const shift = rows.map((row, i) => {
    const moved = row.reduce((sum, x, k) => sum + x * grip.from[k]!, 0);
    return grip.from[i]! - moved;
  });
  const [x, y, z] = rows as [number[], number[], number[]];
  return out.set(
    ...([x[0]!, x[1]!, x[2]!, shift[0]!, y[0]!, y[1]!, y[2]!, shift[1]!] as const),
    ...([z[0]!, z[1]!, z[2]!, shift[2]!, 0, 0, 0, 1] as const),
  );
}
