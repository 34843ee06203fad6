// Dimensions of quantities, as VoxSoft's units know them: exponents of length, mass, time and angle.
// An angle has a dimension of its own: a bare number must not pass for radians.

export type Dimension = readonly [length: number, mass: number, time: number, angle: number];

export const PLAIN: Dimension = [0, 0, 0, 0];

const NAMES: readonly (readonly [string, Dimension])[] = [
  ["a length", [1, 0, 0, 0]],
  ["an area", [2, 0, 0, 0]],
  ["a volume", [3, 0, 0, 0]],
  ["a pressure", [-1, 1, -2, 0]],
  ["a density", [-3, 1, 0, 0]],
  ["a mass", [0, 1, 0, 0]],
  ["a force", [1, 1, -2, 0]],
  ["an acceleration", [1, 0, -2, 0]],
  ["a time", [0, 0, 1, 0]],
  ["a rate", [0, 0, -1, 0]],
  ["a speed", [1, 0, -1, 0]],
  ["an angle", [0, 0, 0, 1]],
  ["a stiffness", [0, 1, -2, 0]],
  ["a compliance", [0, -1, 2, 0]],
  ["a volume compliance", [4, -1, 2, 0]],
  ["an energy", [2, 1, -2, 0]],
  ["a plain number", PLAIN],
];

export function sameDimension(a: Dimension, b: Dimension): boolean {
  return a.every((power, i) => power === b[i]);
}

/** Dimension of a product with `other` raised to `power`. */
export function timesDimension(a: Dimension, other: Dimension, power = 1): Dimension {
  const at = (i: 0 | 1 | 2 | 3) => a[i] + power * other[i];
  return [at(0), at(1), at(2), at(3)];
}

/** A dimension in words, such as “a length”; its exponents where it has no name. */
export function describeDimension(dimension: Dimension): string {
  const named = NAMES.find(([, known]) => sameDimension(known, dimension));
  if (named) return named[0];
  return (["length", "mass", "time", "angle"] as const)
    .flatMap((name, i) => {
      const power = dimension[i] ?? 0;
      return power === 0 ? [] : [power === 1 ? name : `${name}^${power}`];
    })
    .join("·");
}
