// Grips of shapes that turn, scale, mirror or repeat another one: an angle on a ring about its axis, a factor,
// the place of a plane, how far apart copies are and how many.
import type { Triple } from "../../../protocol";
import type { Room } from "../bodies/placing";
import { AXES, directionOf, ORIGIN, type Reader, type ShapeGrip, unit } from "./shapeReader";

/** The least factor of a shape that is scaled by hand. */
const LEAST_FACTOR = 0.01;
/** Distance of a factor's grip from the center, where nothing is drawn yet, m. */
const REACH = 0.02;
/** Margin of a plane beyond the mirrored shape, as a part of its size. */
const BEYOND = 0.1;
/** The most copies that a shape may have, and that are outlined. */
const MOST_COPIES = 4096;
const OUTLINED = 64;
/** Copies around an axis: one more for each such part of the size of the shape. */
const COPY_PART = 0.1;

/** The direction along an axis, up or down. */
const toward = (axis: number, sign: 1 | -1): Triple =>
  unit(axis).map((x) => sign * x + 0) as Triple;
const IDENTITY: readonly Triple[] = [unit(0), unit(1), unit(2)];

export function operatorGrips(shape: Reader, box: Room | null): ShapeGrip[] {
  switch (shape.kind) {
    case "rotate":
      return [angle(shape, "Angle", "turn"), ...centers(shape, turnedAway(shape))];
    case "twist":
      return [angle(shape, "Angle of the twist", "none")];
    case "scale":
      return [...factors(shape, box), ...centers(shape, scaledAway(shape))];
    case "mirror":
      return plane(shape, box);
    case "array":
      return box ? AXES.flatMap((_, i) => copiesAlong(shape, i, box)) : [];
    case "polar-array":
      return [...copiesAround(shape, box), ...centers(shape, null)];
    default:
      return [];
  }
}

/** An angle on a ring about the axis of a shape. */
function angle(shape: Reader, label: string, stretch: "turn" | "none"): ShapeGrip {
  const written = shape.solved.angle;
  return {
    ...{ id: "angle", label, sign: "", moves: false, kind: "angle", stretch, rate: 1, reach: 0 },
    ...{ way: { about: directionOf(shape.solved.axis) }, from: shape.point("center") },
    value: typeof written === "number" ? written : 2 * Math.PI,
    number: shape.number("angle", "angle"),
  };
}

/** The rotation of a shape by its angle about its axis: its rows. */
function rotationOf(shape: Reader): readonly Triple[] {
  const [x, y, z] = directionOf(shape.solved.axis);
  const [cos, sin] = [Math.cos(shape.value("angle")), Math.sin(shape.value("angle"))];
  const rest = 1 - cos;
  return [
    [cos + x * x * rest, x * y * rest - z * sin, x * z * rest + y * sin],
    [y * x * rest + z * sin, cos + y * y * rest, y * z * rest - x * sin],
    [z * x * rest - y * sin, z * y * rest + x * sin, cos + z * z * rest],
  ];
}

/** Motion of a turned shape with its center: by the center, less the image of it under the rotation. */
function turnedAway(shape: Reader): readonly Triple[] {
  const rows = rotationOf(shape);
  return [0, 1, 2].map((k) => rows.map((row, i) => unit(k)[i]! - row[k]!) as Triple);
}

/** Motion of a scaled shape with its center. */
function scaledAway(shape: Reader): readonly Triple[] {
  const all = factorsOf(shape);
  return IDENTITY.map((own, k) => own.map((x) => x * (1 - all[k]!)) as Triple);
}

/** Grips that move the center of a shape; `shifts` are how the shape moves with it along each axis. */
function centers(shape: Reader, shifts: readonly Triple[] | null): ShapeGrip[] {
  const at = shape.point("center");
  return AXES.map((axis, i) => ({
    ...{ id: `center-${axis}`, label: `Center along ${axis}`, sign: axis, moves: true, at },
    ...{ way: { along: unit(i) }, from: ORIGIN, reach: 0, kind: "length", stretch: "none" },
    ...{ value: at[i]!, rate: 1, number: shape.numberOf("center", i) },
    shift: shifts?.[i] ?? ORIGIN,
  }));
}

function factorsOf(shape: Reader): Triple {
  const { factor } = shape.solved;
  return Array.isArray(factor)
    ? (factor as unknown as Triple)
    : ([0, 1, 2].map(() => Number(factor)) as Triple);
}

function factors(shape: Reader, box: Room | null): ShapeGrip[] {
  const from = shape.point("center");
  const all = factorsOf(shape);
  const own = { sign: "", moves: false, kind: "number", from } as const;
  const bounded = (number: ShapeGrip["number"]) => ({
    ...number,
    least: Math.max(number.least, LEAST_FACTOR),
  });
  if (!Array.isArray(shape.solved.factor)) {
    // Within the shape, which is seen whole.
    const reach = box ? farthest(from, box) / 2 : REACH;
    return [
      {
        ...{ ...own, id: "factor", label: "Factor", way: { around: null }, stretch: "all" },
        ...{ reach, value: all[0], rate: all[0] / reach },
        number: bounded(shape.number("factor", "number")),
      },
    ];
  }
  return AXES.map((axis, i) => {
    const [above, below] = box ? [box.high[i]! - from[i]!, from[i]! - box.low[i]!] : [REACH, 0];
    const reach = Math.max(above, below, 1e-4);
    const along = toward(i, above >= below ? 1 : -1);
    return {
      ...{ ...own, id: `factor-${axis}`, label: `Factor along ${axis}`, way: { along } },
      ...{ stretch: "along", reach, value: all[i]!, rate: all[i]! / reach },
      number: bounded(shape.numberOf("factor", i, "number")),
    };
  });
}

/** Reach of a box from a point along the axes, m. */
function farthest(from: Triple, { low, high }: Room): number {
  const sides = [0, 1, 2].map((i) => Math.max(high[i]! - from[i]!, from[i]! - low[i]!));
  return Math.max(...sides, 1e-4);
}

/** The place of a mirror that lies across an axis. */
function plane(shape: Reader, box: Room | null): ShapeGrip[] {
  const normal = directionOf(shape.solved.normal);
  const axis = normal.findIndex((x) => Math.abs(x) > 1 - 1e-9);
  if (axis < 0) return [];
  const value = shape.point("point")[axis]!;
  const middle = box
    ? (box.low.map((x, i) => (x + box.high[i]!) / 2) as Triple)
    : shape.point("point");
  const from = middle.map((x, i) => (i === axis ? 0 : x)) as Triple;
  const way = unit(axis);
  // One of the two copies stays, and the picture of both is no other place of one.
  const shift = shape.solved.keep === true ? ORIGIN : (way.map((x) => 2 * x) as Triple);
  return [
    {
      ...{ id: `plane-${AXES[axis]}`, label: `Mirror at ${AXES[axis]}`, sign: "", moves: false },
      ...{ way: { along: way }, from, reach: value, kind: "length", value, rate: 1, shift },
      ...{ stretch: "none", number: shape.numberOf("point", axis) },
      outline: (at) => (box ? [rectangle(axis, at, box)] : []),
    },
  ];
}

/** A plane across an axis, a little beyond a box. */
function rectangle(axis: number, at: number, { low, high }: Room): Triple[] {
  const [a, b] = [0, 1, 2].filter((i) => i !== axis) as [number, number];
  const more = BEYOND * Math.max(high[a]! - low[a]!, high[b]! - low[b]!);
  const corner = (i: number, k: number) => {
    const point: [number, number, number] = [0, 0, 0];
    point[axis] = at;
    point[a] = i ? high[a]! + more : low[a]! - more;
    point[b] = k ? high[b]! + more : low[b]! - more;
    return point;
  };
  return [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1), corner(0, 0)];
}

/** Distance between copies along an axis, and their number. */
function copiesAlong(shape: Reader, axis: number, box: Room): ShapeGrip[] {
  const count = shape.point("count")[axis]!;
  const spacing = shape.point("spacing")[axis]!;
  if (count < 2 && spacing === 0) return [];
  const sign = spacing < 0 ? -1 : 1;
  const along = toward(axis, sign);
  const { low, high } = box;
  const from = low.map((x, i) => {
    if (i !== axis) return (x + high[i]!) / 2;
    return sign > 0 ? x : high[i]!;
  }) as Triple;
  const reach = high[axis]! - low[axis]!;
  const one = reach - (count - 1) * Math.abs(spacing);
  const own = { sign: "", moves: false, way: { along }, stretch: "none" } as const;
  const name = AXES[axis]!;
  const copies = (many: number, apart: number) =>
    Array.from({ length: Math.min(many, OUTLINED) }, (_, i) =>
      copyBox(box, axis, sign, one, i * apart),
    ).flat();
  const grips: ShapeGrip[] = [];
  if (count > 1) {
    grips.push({
      ...{ ...own, id: `spacing-${name}`, label: `Spacing along ${name}`, kind: "length" },
      ...{ from, reach, value: spacing, rate: sign / (count - 1) },
      number: shape.numberOf("spacing", axis),
      outline: (value) => (value === spacing ? [] : copies(count, value)),
    });
  }
  if (spacing !== 0) {
    const number = shape.numberOf("count", axis, "count");
    grips.push({
      ...{ ...own, id: `count-${name}`, label: `Copies along ${name}`, kind: "count" },
      ...{ from, reach, value: count, rate: 1 / Math.abs(spacing) },
      number: {
        ...number,
        least: Math.max(number.least, 1),
        most: Math.min(number.most, MOST_COPIES),
      },
      outline: (value) => (value === count ? [] : copies(value, spacing)),
    });
  }
  return grips;
}

/** The edges of the box of one copy, some way along an axis from the first. */
function copyBox(
  { low, high }: Room,
  axis: number,
  sign: number,
  one: number,
  by: number,
): Triple[][] {
  const begin = low.map((x, i) =>
    i === axis ? (sign > 0 ? x : high[i]! - one) + by : x,
  ) as Triple;
  const end = high.map((x, i) => (i === axis ? begin[i]! + one : x)) as Triple;
  const corner = (i: number, k: number, z: Triple): Triple => [
    (i ? end : begin)[0],
    (k ? end : begin)[1],
    z[2],
  ];
  const loop = (z: Triple) => [
    corner(0, 0, z),
    corner(1, 0, z),
    corner(1, 1, z),
    corner(0, 1, z),
    corner(0, 0, z),
  ];
  const upright = [0, 1].flatMap((i) =>
    [0, 1].map((k) => [corner(i, k, begin), corner(i, k, end)]),
  );
  return [loop(begin), loop(end), ...upright];
}

/** Over which angle copies around an axis are spread, and how many there are. */
function copiesAround(shape: Reader, box: Room | null): ShapeGrip[] {
  const spread = angle(shape, "Angle over which copies spread", "none");
  const center = shape.point("center");
  const reach = box ? farthest(center, box) : REACH;
  const number = shape.number("count", "count");
  return [
    {
      ...spread,
      number: {
        ...spread.number,
        least: Math.max(spread.number.least, -2 * Math.PI),
        most: Math.min(spread.number.most, 2 * Math.PI),
      },
    },
    {
      ...{ id: "count", label: "Copies around the axis", sign: "", moves: false, kind: "count" },
      ...{ way: { around: directionOf(shape.solved.axis) }, from: center, reach },
      ...{ value: shape.value("count"), rate: 1 / (COPY_PART * 2 * reach), stretch: "none" },
      number: {
        ...number,
        least: Math.max(number.least, 1),
        most: Math.min(number.most, MOST_COPIES),
      },
    },
  ];
}
