//! Energies in principal stretches with their first and second derivatives.

use super::model::Model;
use crate::vector::Vec3;

/// The volume ratio below which `J^(−1/3)` is continued as a polynomial. Rubber in equilibrium stays within percents of
/// one; a tenth occurs during iterations only.
pub const LEAST_VOLUME: f64 = 0.1;

/// The isochoric stretch below which powers are continued as polynomials.
pub const LEAST_STRETCH: f64 = 0.05;

/// A function of the three principal stretches with its derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub struct Principal {
    /// The value in Pa (J/m³).
    pub value: f64,
    /// First derivatives.
    pub first: Vec3,
    /// Second derivatives, symmetric.
    pub second: [[f64; 3]; 3],
}

/// A function of one number with its first and second derivative.
pub type Jet = [f64; 3];

/// `x^e`, below `least` its Taylor polynomial of second order around `least`.
fn power(x: f64, exponent: f64, least: f64) -> Jet {
    let e = exponent;
    let at = x.max(least);
    let value = at.powf(e);
    let jet = [value, e * value / at, e * (e - 1.0) * value / (at * at)];
    continued(jet, x - at)
}

/// The Taylor polynomial of a jet at a distance.
fn continued([value, first, second]: Jet, distance: f64) -> Jet {
    [
        value + distance * (first + 0.5 * second * distance),
        first + second * distance,
        second,
    ]
}

/// `J^(−1/3)` and its derivatives, continued below [`LEAST_VOLUME`].
#[inline(always)]
pub fn shrink(volume: f64) -> Jet {
    if volume < LEAST_VOLUME {
        return power(volume, -1.0 / 3.0, LEAST_VOLUME);
    }
    let value = 1.0 / libm::cbrt(volume);
    let first = -value / (3.0 * volume);
    [value, first, -4.0 * first / (3.0 * volume)]
}

/// The isochoric energy of a model at principal stretches `λ`.
pub fn isochoric(model: &Model, stretches: Vec3) -> Principal {
    let [a, b, c] = stretches;
    let volume = a * b * c;
    let shrink = shrink(volume);
    let bar = stretches.map(|stretch| stretch * shrink[0]);
    through_isochoric(stretches, shrink, of_isochoric(model, bar))
}

/// The energy as a function of the isochoric stretches, as if these were free.
fn of_isochoric(model: &Model, bar: Vec3) -> Principal {
    match model {
        Model::NeoHookean { .. } | Model::Yeoh { .. } | Model::Gent { .. } => {
            let jet = of_excess(model, excess(bar)).unwrap_or_default();
            of_invariants(bar, [jet[1], 0.0], jet[2], jet[0])
        }
        Model::MooneyRivlin { c10, c01 } => {
            let value = c10 * excess(bar) + c01 * (second_invariant(bar) - 3.0);
            of_invariants(bar, [*c10, *c01], 0.0, value)
        }
        Model::Ogden { terms } => {
            let mut sum = Principal::default();
            for &(mu, alpha) in terms.iter().filter(|(mu, _)| *mu != 0.0) {
                let factor = 2.0 * mu / (alpha * alpha);
                for i in 0..3 {
                    let sign = if bar[i] < 0.0 && alpha > 0.0 {
                        -1.0
                    } else {
                        1.0
                    };
                    let jet = power(sign * bar[i], alpha, LEAST_STRETCH);
                    sum.value += factor * (jet[0] - 1.0);
                    sum.first[i] += factor * sign * jet[1];
                    sum.second[i][i] += factor * jet[2];
                }
            }
            sum
        }
    }
}

/// The energy of a model that depends on `Ī₁ − 3` alone, with its derivatives; `None` for other models.
#[inline(always)]
pub fn of_excess(model: &Model, e: f64) -> Option<Jet> {
    Some(match model {
        Model::NeoHookean { c10 } => [c10 * e, *c10, 0.0],
        Model::Yeoh { c } => [
            e * (c[0] + e * (c[1] + e * c[2])),
            c[0] + e * (2.0 * c[1] + 3.0 * c[2] * e),
            2.0 * c[1] + 6.0 * c[2] * e,
        ],
        Model::Gent { shear, limit } => {
            let at = e.min(Model::GENT_REACH * limit);
            let left = 1.0 - at / limit;
            let jet = [
                -shear * limit / 2.0 * left.ln(),
                shear / (2.0 * left),
                shear / (2.0 * limit * left * left),
            ];
            continued(jet, e - at)
        }
        Model::MooneyRivlin { .. } | Model::Ogden { .. } => return None,
    })
}

fn excess(bar: Vec3) -> f64 {
    // Written with (λ̄ − 1) so that small strains keep their digits: Ī₁ − 3 is of second order.
    bar.iter().map(|l| (l - 1.0) * (l + 1.0)).sum()
}

fn second_invariant([a, b, c]: Vec3) -> f64 {
    (a * b).powi(2) + (b * c).powi(2) + (c * a).powi(2)
}

/// A function of `Ī₁` and `Ī₂` with its slopes, and its curvature in `Ī₁`.
fn of_invariants(bar: Vec3, slopes: [f64; 2], curvature: f64, value: f64) -> Principal {
    let squares = bar.map(|l| l * l);
    let others = |i: usize| squares[(i + 1) % 3] + squares[(i + 2) % 3];
    let first = std::array::from_fn(|i| 2.0 * bar[i] * (slopes[0] + slopes[1] * others(i)));
    let second = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let both = 4.0 * curvature * bar[i] * bar[j];
            if i == j {
                both + 2.0 * (slopes[0] + slopes[1] * others(i))
            } else {
                both + 4.0 * slopes[1] * bar[i] * bar[j]
            }
        })
    });
    Principal {
        value,
        first,
        second,
    }
}

/// Chain rule through `λ̄ᵢ = λᵢ g(J)`, where `J` is the product of the stretches.
fn through_isochoric(stretches: Vec3, shrink: Jet, inner: Principal) -> Principal {
    let [g, dg, ddg] = shrink;
    let [a, b, c] = stretches;
    let volume_first = [b * c, c * a, a * b];
    let volume_second = [[0.0, c, b], [c, 0.0, a], [b, a, 0.0]];
    let mut slope = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            slope[i][j] = stretches[i] * dg * volume_first[j] + if i == j { g } else { 0.0 };
        }
    }
    let mut outer = Principal {
        value: inner.value,
        ..Principal::default()
    };
    let along: f64 = (0..3).map(|i| inner.first[i] * stretches[i]).sum();
    for j in 0..3 {
        outer.first[j] = (0..3).map(|i| inner.first[i] * slope[i][j]).sum();
        for k in 0..3 {
            let mut sum = along
                * (ddg * volume_first[j] * volume_first[k] + dg * volume_second[j][k])
                + dg * (inner.first[j] * volume_first[k] + inner.first[k] * volume_first[j]);
            for i in 0..3 {
                for l in 0..3 {
                    sum += slope[i][j] * inner.second[i][l] * slope[l][k];
                }
            }
            outer.second[j][k] = sum;
        }
    }
    outer
}
