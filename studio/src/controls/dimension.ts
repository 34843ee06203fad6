// Dimensions of quantities, as VoxSoft's units know them: exponents of length, mass, time, angle, electric current and temperature.
// An angle has a dimension of its own: a bare number must not pass for radians.
import { KINDS } from "../protocol";

export type Dimension = readonly [
  length: number,
  mass: number,
  time: number,
  angle: number,
  current: number,
  temperature: number,
];

export const PLAIN: Dimension = [0, 0, 0, 0, 0, 0];

export function sameDimension(a: Dimension, b: Dimension): boolean {
  return a.every((power, i) => power === b[i]);
}

/** Dimension of a product with `other` raised to `power`. */
export function timesDimension(a: Dimension, other: Dimension, power = 1): Dimension {
  const at = (i: 0 | 1 | 2 | 3 | 4 | 5) => a[i] + power * other[i];
  return [at(0), at(1), at(2), at(3), at(4), at(5)];
}

/** A dimension in words, such as “a length”; its exponents where it has no name. */
export function describeDimension(dimension: Dimension): string {
  const named = Object.values(KINDS).find((kind) => sameDimension(kind.dimension, dimension));
  if (named) return named.called;
  return (["length", "mass", "time", "angle", "current", "temperature"] as const)
    .flatMap((name, i) => {
      const power = dimension[i] ?? 0;
      return power === 0 ? [] : [power === 1 ? name : `${name}^${power}`];
    })
    .join("·");
}
