//! Vector fields: random ones, sums, differences, rotations.

use crate::matrix::{Mat3, apply};
use crate::vector::{Vec3, add, axpy, dot, norm, sub};

/// Number of random directions in which a law is tried.
pub const TRIES: u64 = 4;

/// Central differences with this step, over the size of a body, err by its square times the third derivative and
/// by rounding over it: about 1e-10 of the largest part of a sum each.
pub const STEP: f64 = 1e-5;

/// Error allowed in differences, relative to their summands: stiff directions next to soft ones take up to four digits
/// of the ten that [`STEP`] leaves.
pub const SLACK: f64 = 1e-6;

/// Rounding of sums of many terms that cancel.
pub const ROUNDING: f64 = 1e-9;

/// A random field from a seed, components within one of zero.
pub fn random(count: usize, seed: u64) -> Vec<Vec3> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        // Marsaglia's xorshift, doi 10.18637/jss.v008.i14.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count)
        .map(|_| std::array::from_fn(|_| next()))
        .collect()
}

/// The inner product.
pub fn inner(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum()
}

/// The Euclidean norm.
pub fn size(field: &[Vec3]) -> f64 {
    inner(field, field).sqrt()
}

/// `a + s b`.
pub fn plus(a: &[Vec3], s: f64, b: &[Vec3]) -> Vec<Vec3> {
    let mut sum = a.to_vec();
    for (sum, b) in sum.iter_mut().zip(b) {
        axpy(sum, s, *b);
    }
    sum
}

/// The norm of the difference.
pub fn distance(a: &[Vec3], b: &[Vec3]) -> f64 {
    size(&plus(a, -1.0, b))
}

/// The largest distance of points from their first.
pub fn extent(points: &[Vec3]) -> f64 {
    let first = points.first().copied().unwrap_or_default();
    points
        .iter()
        .map(|p| norm(sub(*p, first)))
        .fold(0.0, f64::max)
}

/// A rotation about an oblique axis.
pub const TURN: Mat3 = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]];

/// Points rotated and moved away by about their extent.
pub fn carried(points: &[Vec3]) -> Vec<Vec3> {
    let away = [
        0.7 * extent(points),
        -0.3 * extent(points),
        0.2 * extent(points),
    ];
    points.iter().map(|p| add(apply(&TURN, *p), away)).collect()
}

/// Vectors rotated.
pub fn turned(vectors: &[Vec3]) -> Vec<Vec3> {
    vectors.iter().map(|v| apply(&TURN, *v)).collect()
}

/// Results of the same work on pools of one, two and three threads.
#[cfg(feature = "threads")]
pub fn on_threads<T: Send>(work: impl Fn() -> T + Sync) -> Vec<T> {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        // A pool that cannot be built leaves nothing to compare.
        pool.map(|pool| pool.install(&work)).ok()
    };
    (1..=3).filter_map(on).collect()
}

/// Runs the work once: without threads there is one result.
#[cfg(not(feature = "threads"))]
pub fn on_threads<T: Send>(work: impl Fn() -> T + Sync) -> Vec<T> {
    vec![work()]
}

/// The bits of a field.
pub fn bits(field: &[Vec3]) -> Vec<u64> {
    field.as_flattened().iter().map(|x| x.to_bits()).collect()
}
