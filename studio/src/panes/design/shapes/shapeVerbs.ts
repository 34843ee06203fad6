// Actions with a shape: cut, join, hollow, mirror, repeat, make a part; and their text in the design.
import type { Triple } from "../../../protocol";
import { type Room, written, writtenPlace } from "../bodies/placing";
import type { Change } from "../edits";
import { freeName } from "../fields/starters";
import type { Spot } from "./shapeStarters";

type Table = Readonly<Record<string, unknown>>;

export interface ShapeVerb {
  readonly label: string;
  readonly changes: readonly Change[];
  /** The shape that is added, which is placed next. */
  readonly adds?: string;
}

/** Shapes that cut or are joined, as they are asked for. */
const TOOLS = ["box", "cylinder", "sphere"] as const;
type Tool = (typeof TOOLS)[number];

/** The material of a first part: soft, and its card is measured. */
export const FIRST_MATERIAL = "ecoflex-00-30";
/** Side of the first shape, m: some voxels of the usual 5 mm. */
export const FIRST_SIDE = 0.04;
/** Place of the first shape. */
export const FIRST_SPOT: Spot = { side: FIRST_SIDE, middle: null, operands: [] };
/** A new shape as a part of the body that it cuts or joins. */
const SHARE = 0.6;
/** Walls that are left when a shape is hollowed, in voxels: bending wants two or more. */
const WALL = 2;

const tableOf = (source: Table, section: string) => (source[section] as Table | undefined) ?? {};
const listOf = (source: Table, section: string) =>
  (source[section] as readonly Table[] | undefined) ?? [];

/** The name and the changes of a shape that is added; the first one is made a part. */
export function withShape(value: Table, source: Table): { name: string; changes: Change[] } {
  const shapes = Object.keys(tableOf(source, "shapes"));
  const name = freeName(String(value.kind ?? "shape"), shapes);
  const parts = listOf(source, "parts");
  const several = listOf(source, "bodies").length > 0;
  const isFirst = shapes.length === 0 && parts.length === 0 && !several;
  if (!isFirst) return { name, changes: [{ path: ["shapes", name], value }] };
  const part = { shape: name, material: FIRST_MATERIAL };
  return {
    name,
    changes: [
      { path: ["shapes", name], value },
      { path: ["parts", 0], value: part },
    ],
  };
}

/** Names that a shape refers to, of all depths. */
function namesIn(value: unknown): string[] {
  if (typeof value === "string") return [value];
  if (Array.isArray(value)) return value.flatMap(namesIn);
  if (typeof value !== "object" || value === null) return [];
  return Object.entries(value).flatMap(([key, inner]) => (key === "kind" ? [] : namesIn(inner)));
}

/** Check if a part, an object, a region or a shape uses a shape. */
export function isUsed(name: string, source: Table): boolean {
  const { shapes, parameters: _, materials: __, ...rest } = source;
  const others = Object.entries((shapes as Table | undefined) ?? {}).filter(
    ([one]) => one !== name,
  );
  return namesIn([rest, others.map(([, shape]) => shape)]).includes(name);
}

/** All that can be done with a shape. */
export function shapeVerbs(
  name: string,
  source: Table,
  body: Room | null,
  voxel: number,
): ShapeVerb[] {
  const shapes = tableOf(source, "shapes");
  const own = shapes[name];
  if (typeof own !== "object" || own === null) return [];
  const names = Object.keys(shapes);
  const parts = listOf(source, "parts");
  // The shape keeps its name, so that all its users go on with the new one.
  const whole = freeName(`${name}-whole`, names);
  const become = (value: Table): Change[] => [
    { path: ["shapes", whole], value: own },
    { path: ["shapes", name], value },
  ];
  const unused: ShapeVerb[] = isUsed(name, source)
    ? []
    : [
        {
          label: "Make it a part",
          changes: [
            {
              path: ["parts", parts.length],
              value: { shape: name, material: parts[0]?.material ?? FIRST_MATERIAL },
            },
          ],
        },
        ...parts
          .map((part) => part.shape)
          .filter((shape): shape is string => typeof shape === "string" && shape in shapes)
          .slice(0, 3)
          .flatMap((shape) => joined(name, shape, shapes)),
      ];
  const tooled = (verb: string, kind: "difference" | "union") =>
    TOOLS.map((tool): ShapeVerb => {
      const added = freeName(tool, [...names, whole]);
      return {
        label: `${verb} a ${tool}`,
        adds: added,
        changes: [
          { path: ["shapes", added], value: toolFor(tool, kind, body, voxel) },
          ...become({ kind, of: [whole, added] }),
        ],
      };
    });
  const size = body
    ? ([0, 1, 2].map((i) => body.high[i]! - body.low[i]!) as unknown as Triple)
    : ([0.04, 0.04, 0.04] as Triple);
  return [
    ...unused,
    {
      label: "Hollow it out",
      changes: become({
        kind: "difference",
        of: [whole, { kind: "offset", of: whole, distance: written(-WALL * voxel) }],
      }),
    },
    {
      label: "Move it as a whole",
      changes: become({ kind: "translate", of: whole, by: [0, 0, 0] }),
    },
    ...tooled("Cut with", "difference"),
    ...tooled("Join with", "union"),
    ...(["x", "y", "z"] as const).map((axis) => ({
      label: `Mirror in ${axis} = 0, keeping it`,
      changes: become({ kind: "mirror", of: whole, normal: axis, keep: true }),
    })),
    ...(["x", "y", "z"] as const).map((axis, along) => ({
      label: `Repeat along ${axis}`,
      changes: become({
        kind: "array",
        of: whole,
        count: size.map((_, i) => (i === along ? 3 : 1)),
        spacing: size.map((side, i) => (i === along ? written(1.5 * side) : "0 mm")),
      }),
    })),
    {
      label: "Repeat around z",
      changes: become({ kind: "polar-array", of: whole, count: 3 }),
    },
  ];
}

/** Join a shape to another, cut it out of that, or keep the common part of both; the other keeps its name. */
export function joined(name: string, shape: string, shapes: Table): ShapeVerb[] {
  const whole = freeName(`${shape}-whole`, Object.keys(shapes));
  const own = shapes[shape] as Table;
  return (
    [
      [`Join it to ${shape}`, "union"],
      [`Cut it out of ${shape}`, "difference"],
      [`Intersect ${shape} with it`, "intersection"],
    ] as const
  ).map(([label, kind]) => ({
    label,
    // One that is of this kind already takes it in.
    changes:
      own.kind === kind && Array.isArray(own.of) && !own.smooth
        ? [{ path: ["shapes", shape, "of"], value: [...own.of, name] }]
        : [
            { path: ["shapes", whole], value: own },
            { path: ["shapes", shape], value: { kind, of: [whole, name] } },
          ],
  }));
}

/** Check if a shape is made of another, at any depth: joined to that, it would be made of itself. */
export function isMadeOf(name: string, of: string, shapes: Table): boolean {
  const seen = new Set<string>();
  const reaches = (one: string): boolean => {
    if (one === of) return true;
    if (seen.has(one) || !(one in shapes)) return false;
    seen.add(one);
    return namesIn(shapes[one]).some(reaches);
  };
  return reaches(name);
}

/** A tool in the middle of the body: a cutting one goes through it, a joined one stands on its top. */
function toolFor(
  tool: Tool,
  kind: "difference" | "union",
  body: Room | null,
  voxel: number,
): Table {
  const room = body ?? { low: [0, 0, 0] as Triple, high: [0.04, 0.04, 0.04] as Triple };
  const size = [0, 1, 2].map((i) => room.high[i]! - room.low[i]!) as unknown as Triple;
  const middle = [0, 1, 2].map((i) => (room.high[i]! + room.low[i]!) / 2) as unknown as Triple;
  const round = (meters: number) => Math.max(1, Math.round(meters / voxel)) * voxel;
  const across = round(SHARE * Math.min(size[0], size[1]));
  const center: Triple = kind === "union" ? [middle[0], middle[1], room.high[2]] : middle;
  switch (tool) {
    case "box": {
      const sides = [across, across, round(SHARE * size[2])];
      return { kind: tool, size: sides.map(written), center: writtenPlace(center) };
    }
    case "cylinder": {
      const base: Triple =
        kind === "union"
          ? [middle[0], middle[1], middle[2]]
          : [middle[0], middle[1], room.low[2] - voxel];
      const height = kind === "union" ? size[2] : size[2] + 2 * voxel;
      return {
        kind: tool,
        base: writtenPlace(base),
        radius: written(across / 2),
        height: written(height),
      };
    }
    case "sphere":
      return { kind: tool, radius: written(across / 2), center: writtenPlace(center) };
  }
}
