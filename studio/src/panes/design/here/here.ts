// Actions at a face of the body that was pressed, and their text in the design.
import type { Parameter } from "../../../protocol";
import type { Face } from "../../../view/hands/face";
import { written, writtenPlace } from "../bodies/placing";
import type { Change } from "../edits";
import { freeName } from "../fields/starters";

type Table = Readonly<Record<string, unknown>>;
type Triple = readonly [number, number, number];

/** Something that can be done at a face. */
export interface Verb {
  readonly id: string;
  readonly label: string;
  readonly title: string;
  readonly changes: readonly Change[];
  /** True if the body is larger afterwards, so that the picture fits it anew. */
  readonly grows?: boolean;
}

/** Voxels to each side of a point that a place around it holds. */
const AROUND = 1.5;
/** Rounding of positions in single precision, as a part of a voxel. */
const NEAR = 1e-3;

/** A coordinate as text: by the one parameter that it follows, else as a length. */
export function coordinate(meters: number, parameters: readonly Parameter[], voxel: number) {
  if (Math.abs(meters) < NEAR * voxel) return 0;
  const forms = parameters
    .filter((one) => one.kind === "length")
    .flatMap(({ name, value }): [string, number][] => [
      [`= ${name}`, value],
      [`= -${name}`, -value],
      [`= ${name}/2`, value / 2],
      [`= -${name}/2`, -value / 2],
    ])
    .filter(([, value]) => Math.abs(value - meters) < NEAR * voxel);
  // If two forms would do, the next change of one of them would move the place wrongly.
  return forms.length === 1 && forms[0] ? forms[0][0] : written(meters);
}

/** Check if some text of shapes names a parameter in a number along an axis, or in one of no axis. */
function names(value: unknown, name: RegExp, axis: number): boolean {
  if (typeof value === "string") return value.trim().startsWith("=") && name.test(value);
  if (Array.isArray(value)) {
    const isPlace = value.length === 3 && value.every((one) => typeof one !== "object");
    return (isPlace ? [value[axis]] : value).some((one) => names(one, name, axis));
  }
  if (typeof value !== "object" || value === null) return false;
  return Object.values(value).some((one) => names(one, name, axis));
}

/**
 * The parameters by which shapes reach along an axis: another one may have the same value by chance.
 *
 * All of them for a design that describes no shapes.
 */
export function parametersAlong(
  axis: number,
  parameters: readonly Parameter[],
  source: Table,
): readonly Parameter[] {
  const shapes = ["shapes", "parts", "bodies"].map((section) => source[section]).filter(Boolean);
  if (shapes.length === 0) return parameters;
  return parameters.filter(({ name }) => {
    const word = new RegExp(`(?<![A-Za-z0-9_])${name}(?![A-Za-z0-9_])`);
    return shapes.some((one) => names(one, word, axis));
  });
}

/** The region of a face: its plane, and its box where other faces lie in the same plane. */
export function regionOfFace(
  face: Face,
  parameters: readonly Parameter[],
  source: Table = {},
): Table | null {
  if (face.axis === null) return null;
  const along = (axis: number) => {
    const own = parametersAlong(axis, parameters, source);
    return [face.low[axis]!, face.high[axis]!].map((x) => coordinate(x, own, face.voxelSize));
  };
  const axes = face.shared ? [0, 1, 2] : [face.axis];
  return Object.fromEntries(axes.map((axis) => ["xyz"[axis], along(axis)]));
}

/** A ball around the point that was pressed. */
export function regionAround(face: Face): Table {
  return { center: writtenPlace([...face.point]), radius: written(AROUND * face.voxelSize) };
}

/** A point inside the cavity that a face bounds: half a voxel off the wall. */
export function pointInside(face: Face): Triple {
  return face.point.map((x, i) => x + 0.5 * face.voxelSize * face.normal[i]!) as unknown as Triple;
}

/** Everything that can be done at a place of the outside. */
export function verbsAt(region: Table, normal: Triple, source: Table): Verb[] {
  const list = (section: string) => (source[section] as readonly unknown[] | undefined) ?? [];
  const names = (section: string) => Object.keys((source[section] as Table | undefined) ?? {});
  const append = (section: string, value: unknown): Change => ({
    path: [section, list(section).length],
    value,
  });
  const push = normal.map((x) => (Math.abs(x) < 0.05 ? 0 : `${Number((-100 * x).toFixed(1))} mN`));
  const layers = list("layers").map((one) => String((one as Table).name ?? ""));
  return [
    {
      id: "clamp",
      label: "Clamp",
      title: "Hold what lies here where it is",
      changes: [append("clamps", { region })],
    },
    {
      id: "push",
      label: "Push",
      title: "A force of 100 mN onto it, which keeps its direction",
      changes: [append("loads", { kind: "force", region, value: push })],
    },
    {
      id: "press",
      label: "Press",
      title: "A pressure of 1 kPa onto it, which follows the surface",
      changes: [append("loads", { kind: "traction", region, value: "1 kPa" })],
    },
    {
      id: "probe",
      label: "Probe",
      title: "Measure how it moves",
      changes: [{ path: ["probes", freeName("probe", names("probes"))], value: region }],
    },
    {
      id: "layer",
      label: "Layer",
      title: "Bond a sheet of fabric to it, which resists stretch",
      changes: [
        append("layers", {
          name: freeName("fabric", layers),
          region,
          young: "30 MPa",
          thickness: "0.3 mm",
        }),
      ],
    },
  ];
}

/** Actions in a cavity: a pressure, by the name of the chamber that it has or gets. */
export function verbsIn(face: Face, name: string, source: Table): Verb[] {
  const chambers = Object.keys((source.chambers as Table | undefined) ?? {});
  const loads = (source.loads as readonly unknown[] | undefined) ?? [];
  const known = chambers.includes(name);
  const chamber = known ? name : freeName("chamber", chambers);
  const naming: Change = {
    path: ["chambers", chamber],
    value: { point: writtenPlace([...pointInside(face)]) },
  };
  const press: Change = {
    path: ["loads", loads.length],
    value: { kind: "pressure", cavity: chamber, value: "1 kPa" },
  };
  const pressing: Verb = {
    id: "fill",
    label: "Pressure",
    title: "A pressure of 1 kPa in this chamber",
    changes: known ? [press] : [naming, press],
  };
  const named: Verb = {
    id: "name",
    label: "Name this chamber",
    title: "Loads and numbers then call it by its name",
    changes: [naming],
  };
  return known ? [pressing] : [pressing, named];
}
