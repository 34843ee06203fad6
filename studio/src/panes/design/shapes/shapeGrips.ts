// Grips that move and size a shape by hand in the picture: for each kind its numbers, and where the
// grips for them stand. Those of shapes that change others are in operatorGrips.ts.
import type { Parameter, Triple } from "../../../protocol";
import type { Room } from "../bodies/placing";
import { operatorGrips } from "./operatorGrips";
import {
  AXES,
  directionOf,
  ORIGIN,
  Reader,
  type ShapeGrip,
  type Stretch,
  unit,
} from "./shapeReader";
import { together } from "./writtenNumber";

type Table = Readonly<Record<string, unknown>>;

/** The shortest length of a shape that is sized by hand, m. */
const SHORTEST = 1e-4;

/** Points that place each kind, the first of those that are written. */
const PLACES: Readonly<Record<string, readonly string[]>> = {
  ...{ box: ["center", "corner"], "rounded-box": ["center", "corner"] },
  ...{ sphere: ["center"], ellipsoid: ["center"], torus: ["center"] },
  ...{ cylinder: ["base"], tube: ["base"], cone: ["base"], prism: ["base"], revolve: ["base"] },
  ...{ "half-space": ["point"], translate: ["by"] },
};
/** Kinds of which both ends move. */
const ENDS: Readonly<Record<string, readonly string[]>> = { capsule: ["start", "end"] };

const plus = (a: Triple, b: Triple, by: number): Triple =>
  a.map((x, i) => x + by * b[i]!) as Triple;

/**
 * The grips of a named shape.
 *
 * `source` is the document as it is written, `design` its values in SI, and `box` that of the shape where it
 * is drawn, m; none where the shape has neither a place nor a size of its own.
 */
export function shapeGrips(
  name: string,
  source: Table,
  design: Table | null,
  parameters: readonly Parameter[],
  box: Room | null = null,
): ShapeGrip[] {
  const text = (source.shapes as Table | undefined)?.[name] as Table | undefined;
  const solved = (design?.shapes as Table | undefined)?.[name] as Table | undefined;
  if (!text || !solved || text.kind !== solved.kind) return [];
  const reader = new Reader(["shapes", name], text, solved, source, parameters);
  return [...moves(reader), ...sizes(reader), ...operatorGrips(reader, box)];
}

function moves(shape: Reader): ShapeGrip[] {
  const places = PLACES[shape.kind];
  const key = places && (places.find((one) => shape.has(one)) ?? places.at(-1));
  const keys = ENDS[shape.kind] ?? (key === undefined ? [] : [key]);
  const first = keys[0];
  if (first === undefined) return [];
  return AXES.map((axis, i) => {
    const all = keys.map((one) => ({
      number: shape.numberOf(one, i),
      value: shape.point(one)[i]!,
    }));
    return {
      ...{ id: `move-${axis}`, label: `Move along ${axis}`, sign: axis, moves: true },
      ...{ way: { along: unit(i) }, from: ORIGIN, reach: 0, kind: "length" },
      ...{ value: shape.point(first)[i]!, rate: 1, stretch: "none" },
      number: together(all),
    };
  });
}

/** A grip for one length of a shape, which does not become less than nothing. */
function sized(
  shape: Reader,
  key: string,
  own: Pick<ShapeGrip, "label" | "way" | "from" | "reach"> & {
    sign?: string;
    /** The shortest that makes sense, m. */
    least?: number;
    axis?: number;
    rate?: number;
    stretch?: Stretch;
  },
): ShapeGrip {
  const { axis, label, way, from, reach } = own;
  const { sign = "", least = SHORTEST, rate = 1, stretch = "along" } = own;
  const number = axis === undefined ? shape.number(key) : shape.numberOf(key, axis);
  const value = axis === undefined ? shape.value(key) : shape.point(key)[axis]!;
  return {
    ...{ id: axis === undefined ? key : `${key}-${AXES[axis]}`, moves: false },
    ...{ label, sign, way, from, reach, value, rate, stretch, kind: "length" },
    number: { ...number, least: Math.max(number.least, least) },
  };
}

function sizes(shape: Reader): ShapeGrip[] {
  switch (shape.kind) {
    case "box":
    case "rounded-box":
      return AXES.map((axis, i) => {
        const size = shape.point("size");
        const centered = shape.has("center");
        const low = centered ? plus(shape.point("center"), size, -0.5) : shape.point("corner");
        const middle = plus(low, size, 0.5);
        // One that has a center grows to both sides, another one away from its corner.
        const from = middle.map((x, k) => (k === i && !centered ? low[k]! : x)) as Triple;
        // Its edges are rounded by half of it at most.
        const least = shape.kind === "box" ? SHORTEST : 2 * shape.value("radius");
        return sized(shape, "size", {
          least,
          ...{ axis: i, label: `Size along ${axis}`, way: { along: unit(i) }, from },
          ...{ reach: centered ? size[i]! / 2 : size[i]!, rate: centered ? 2 : 1 },
        });
      });
    case "sphere":
      return [
        sized(shape, "radius", {
          ...{ label: "Radius", sign: "R", way: { around: null }, stretch: "all" },
          ...{ from: shape.point("center"), reach: shape.value("radius") },
        }),
      ];
    case "ellipsoid":
      return AXES.map((axis, i) =>
        sized(shape, "radii", {
          ...{ axis: i, label: `Half axis along ${axis}`, sign: "R", way: { along: unit(i) } },
          ...{ from: shape.point("center"), reach: shape.point("radii")[i]! },
        }),
      );
    case "torus":
      return [
        sized(shape, "radius", {
          ...{ label: "Radius of the ring", sign: "R", stretch: "across" },
          way: { around: directionOf(shape.solved.axis) },
          ...{ from: shape.point("center"), reach: shape.value("radius") },
        }),
      ];
    case "cylinder":
    case "tube":
    case "cone":
      return upright(shape, true);
    case "prism":
      return upright(shape, false);
    case "capsule": {
      const [start, end] = [shape.point("start"), shape.point("end")];
      const along = directionOf(end.map((x, i) => x - start[i]!));
      return [
        sized(shape, "radius", {
          ...{ label: "Radius", sign: "R", way: { around: along }, stretch: "across" },
          ...{ from: plus(start, plus(end, start, -1), 0.5), reach: shape.value("radius") },
        }),
      ];
    }
    default:
      return [];
  }
}

/** Height, and the radius that the base has. */
function upright(shape: Reader, round: boolean): ShapeGrip[] {
  const base = shape.point("base");
  const along = directionOf(shape.solved.axis);
  const height = sized(shape, "height", {
    ...{ label: "Height", sign: "H", way: { along }, from: base, reach: shape.value("height") },
  });
  if (!round) return [height];
  // A cone is as wide as its radius at its base alone.
  const from = shape.kind === "cone" ? base : plus(base, along, shape.value("height") / 2);
  const radius = sized(shape, "radius", {
    least: shape.kind === "tube" ? shape.value("wall") + SHORTEST : SHORTEST,
    ...{ label: "Radius", sign: "R", way: { around: along }, stretch: "across", from },
    reach: shape.value("radius"),
  });
  return [height, radius];
}

/** Value of a number after a drag: on whole steps, and within its bounds. */
export function snappedValue(grip: ShapeGrip, value: number, step: number): number {
  const { least, most } = grip.number;
  const snapped = Math.min(Math.max(Math.round(value / step) * step, least), most);
  return Number(snapped.toFixed(14)) + 0;
}
