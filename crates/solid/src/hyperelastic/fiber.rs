//! Fiber families: stiffness along one direction of the rest state.

use super::symmetric::{Sym, to_matrix};
use crate::matrix::apply;
use crate::vector::{Vec3, dot, scale};

/// A family of fibers spread over a material: energy `E_f/8 (|F a|²/λ₀² − 1)²` per rest volume, which for
/// small strain and `λ₀ = 1` is `E_f ε²/2` along `a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fiber {
    /// Unit vector of the fibers at rest.
    pub direction: Vec3,
    /// Modulus in Pa: the stiffness of a fiber times the part of the volume that is fiber.
    pub modulus: f64,
    /// Set if fibers also carry compression; thin ones buckle and do not.
    pub compression: bool,
    /// The stretch `λ₀` at which they are free of stress: 1, unless they are longer or shorter by themselves.
    pub free: f64,
}

impl Fiber {
    /// The direction over the free stretch, `a/λ₀`.
    fn course(&self) -> Vec3 {
        scale(1.0 / self.free, self.direction)
    }
}

/// `S a` and `(|S a|² − 1)/2` with `a/λ₀` for `a`, zero where a fiber is slack.
fn strain(fiber: &Fiber, stretch: &Sym) -> (Vec3, f64, bool) {
    let along = apply(&to_matrix(stretch), fiber.course());
    let strain = (dot(along, along) - 1.0) / 2.0;
    let taut = strain > 0.0 || fiber.compression;
    (along, if taut { strain } else { 0.0 }, taut)
}

/// `a ⊗ Sa` made symmetric: the derivative of the strain.
fn slope(fiber: &Fiber, along: Vec3) -> Sym {
    let a = fiber.course();
    let pair = |i: usize, j: usize| (a[i] * along[j] + a[j] * along[i]) / std::f64::consts::SQRT_2;
    [
        a[0] * along[0],
        a[1] * along[1],
        a[2] * along[2],
        pair(1, 2),
        pair(0, 2),
        pair(0, 1),
    ]
}

pub(crate) fn energy(fiber: &Fiber, stretch: &Sym) -> f64 {
    let (_, strain, _) = strain(fiber, stretch);
    0.5 * fiber.modulus * strain * strain
}

pub(crate) fn add_stress(fiber: &Fiber, stretch: &Sym, stress: &mut Sym) {
    let (along, strain, _) = strain(fiber, stretch);
    for (t, s) in stress.iter_mut().zip(slope(fiber, along)) {
        *t += fiber.modulus * strain * s;
    }
}

pub(crate) fn add_tangent(fiber: &Fiber, stretch: &Sym, tangent: &mut [Sym; 6]) {
    let (along, strain, taut) = strain(fiber, stretch);
    if !taut {
        return;
    }
    let slope = slope(fiber, along);
    // The second derivative of the strain along dS is sym(a ⊗ dS a).
    for column in 0..6 {
        let mut unit = [0.0; 6];
        unit[column] = 1.0;
        let second = self::slope(fiber, apply(&to_matrix(&unit), fiber.course()));
        for row in 0..6 {
            tangent[row][column] +=
                fiber.modulus * (slope[row] * slope[column] + strain * second[row]);
        }
    }
}
