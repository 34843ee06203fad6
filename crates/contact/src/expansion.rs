//! Exact floating-point sums (Shewchuk 1997), for the few determinants that are not orientations of four points. Slow,
//! and evaluated only if rounding could change the sign.
use crate::predicates::Point;
use crate::vectors::{cross, dot};

/// Bound of the rounding error in the determinant below, relative to the products that are added up.
const ROUNDING: f64 = 1e-14;

/// The sign of det(b − a, d − c, y − x): -1, 0 or 1.
pub(crate) fn sign_of([a, b]: [Point; 2], [c, d]: [Point; 2], [x, y]: [Point; 2]) -> f64 {
    let difference = |p: Point, q: Point| -> Point { std::array::from_fn(|i| q[i] - p[i]) };
    let (u, v, w) = (difference(a, b), difference(c, d), difference(x, y));
    let size = dot(
        cross_of_sizes(u.map(f64::abs), v.map(f64::abs)),
        w.map(f64::abs),
    );
    let estimate = dot(cross(u, v), w);
    if estimate.abs() > ROUNDING * size {
        return estimate.signum();
    }
    exact_sign([a, b], [c, d], [x, y])
}

fn cross_of_sizes(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] + a[k] * b[j]
    })
}

fn exact_sign(u: [Point; 2], v: [Point; 2], w: [Point; 2]) -> f64 {
    let mut sum = Vec::new();
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        for (first, second, sign) in [(j, k, 1.0), (k, j, -1.0)] {
            for (s, p) in [(1.0, u[1][first]), (-1.0, u[0][first])] {
                for (t, q) in [(1.0, v[1][second]), (-1.0, v[0][second])] {
                    for (r, o) in [(1.0, w[1][i]), (-1.0, w[0][i])] {
                        let (high, low) = product(p, q);
                        for part in [high, low] {
                            let (high, low) = product(part, sign * s * t * r * o);
                            add(&mut sum, low);
                            add(&mut sum, high);
                        }
                    }
                }
            }
        }
    }
    // The parts do not overlap, so the largest decides the sign.
    sum.last().map_or(0.0, |part| part.signum())
}

/// Adds a number to an expansion of parts that do not overlap, smallest first (Shewchuk's grow-expansion).
fn add(sum: &mut Vec<f64>, number: f64) {
    let mut carry = number;
    let mut kept = 0;
    for i in 0..sum.len() {
        let (high, low) = total(carry, sum[i]);
        if low != 0.0 {
            sum[kept] = low;
            kept += 1;
        }
        carry = high;
    }
    sum.truncate(kept);
    if carry != 0.0 {
        sum.push(carry);
    }
}

/// Rounded sum a + b and its rounding error (Knuth's two-sum).
fn total(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    (sum, (a - of_a) + (b - of_b))
}

/// Rounded product a · b and its rounding error (Dekker's two-product).
fn product(a: f64, b: f64) -> (f64, f64) {
    let rounded = a * b;
    let ((a1, a0), (b1, b0)) = (split(a), split(b));
    (
        rounded,
        a0 * b0 - (((rounded - a1 * b1) - a0 * b1) - a1 * b0),
    )
}

/// Splits a number into two of 26 bits each (Veltkamp).
fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_whole_numbers(p in prop::array::uniform6(prop::array::uniform3(-9..10_i64)), far in 0..50_u32) {
            // A shift that rounding would not survive, exact in floating point.
            let shift = 2.0_f64.powi(far as i32);
            let at = |i: usize| p[i].map(|x| x as f64 + shift);
            let d = |i: usize| -> [i64; 3] { std::array::from_fn(|a| p[i + 1][a] - p[i][a]) };
            let (u, v, w) = (d(0), d(2), d(4));
            let det: i64 = (0..3).map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                (u[j] * v[k] - u[k] * v[j]) * w[i]
            }).sum();
            let pairs = ([at(0), at(1)], [at(2), at(3)], [at(4), at(5)]);
            prop_assert_eq!(exact_sign(pairs.0, pairs.1, pairs.2), det.signum() as f64);
            prop_assert_eq!(sign_of(pairs.0, pairs.1, pairs.2), det.signum() as f64);
        }
    }
}
