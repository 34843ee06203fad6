// Lengths that whole voxels cannot hold.

/** Unit of the search for a common voxel, m. */
const MICRON = 1e-6;
/** Smallest voxel that is offered, in the present ones: each halving makes eight times as many. */
const FINEST = 0.25;
/** Relative rounding of a length. */
const ROUNDING = 1e-6;

/** Names of parameters that shapes depend on, also by the formulas of other parameters. */
export function namesOfShapes(source: Readonly<Record<string, unknown>>): ReadonlySet<string> {
  const parameters = (source.parameters as Record<string, unknown> | undefined) ?? {};
  const found = new Set<string>();
  const look = (value: unknown): void => {
    if (typeof value === "string") {
      for (const [name] of value.startsWith("=") ? value.matchAll(/[A-Za-z_]\w*/g) : []) {
        if (found.has(name) || !(name in parameters)) continue;
        found.add(name);
        look(parameters[name]);
      }
    } else if (typeof value === "object" && value !== null) Object.values(value).forEach(look);
  };
  look([source.shapes, source.parts]);
  return found;
}

/** Number of voxels along a length; null where it is a whole one. */
export function brokenCount(length: number, voxel: number): number | null {
  const count = Math.abs(length) / voxel;
  return Math.abs(count - Math.round(count)) <= ROUNDING * Math.max(1, count) ? null : count;
}

/** Largest voxel, up to the present one, of which all lengths are multiples; null where none is near. */
export function commonVoxel(lengths: readonly number[], voxel: number): number | null {
  const whole = lengths.map((length) => Math.round(Math.abs(length) / MICRON)).filter(Boolean);
  const common = whole.reduce(divisor, 0);
  if (common === 0) return null;
  const finest = ((FINEST - ROUNDING) * voxel) / MICRON;
  let parts = Math.ceil(common / (voxel / MICRON) - ROUNDING);
  // Whole microns, which are written without rounding.
  while (common % parts !== 0) parts += 1;
  return common / parts < finest ? null : (common / parts) * MICRON;
}

/** Largest common divisor (Euclid). */
function divisor(a: number, b: number): number {
  return b === 0 ? a : divisor(b, a % b);
}
