//! Error of a step of viscous stress without inertia, by which its length is chosen.
//!
//! A branch `(γ, τ)` is exact for a stress `s` that is linear in the step. A curvature `s″` adds
//!
//! ```text
//! γ s″ φ,   φ = ∫₀ʰ e^(−u/τ) (h/2 − u) du = τ² (x/2 − 1 + e^(−x) (1 + x/2)),   x = h/τ,
//! ```
//!
//! with `φ = h³/12τ` for short steps (second order in all) and `φ = τ h/2` for long ones. The curvature is the change of the
//! rate since the last step. After a corner of the loads there is no last one, and `s″` counts as large as
//! `ds/dt/τ`, that of a stress that relaxes with the branch.

use serde::{Deserialize, Serialize};

use super::viscosity::{Viscosity, stresses};
use crate::Body;
use crate::element::hex8::Hex8Stress;
use crate::vector::Vec3;

/// Ratio `h/τ` below which `φ` is a series, for rounding.
const SHORT: f64 = 0.05;

/// Course of the steps so far.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Pace {
    /// Rates `ds/dt` (Pa/s) in the last step, and its length in s; `None` at first and after a corner of the loads.
    last: Option<(Vec<Hex8Stress>, f64)>,
    /// Largest norm of `s` over all voxels so far, Pa √m³.
    largest: f64,
    /// Length in s of the next step; `None` with `last`.
    next: Option<f64>,
}

impl Pace {
    /// Updates after a step in which the stresses have changed.
    pub(super) fn take_step(
        &mut self,
        body: &Body,
        before: &[Hex8Stress],
        now: &[Hex8Stress],
        step: f64,
    ) {
        self.largest = self.largest.max(norm(body, now));
        self.last = (step > 0.0).then(|| {
            let pairs = now.iter().zip(before);
            let rate = |(now, before): (&Hex8Stress, &Hex8Stress)| {
                let change = now.plus_scaled(-1.0, before);
                Hex8Stress::ZERO.plus_scaled(1.0 / step, &change)
            };
            (pairs.map(rate).collect(), step)
        });
    }
}

impl Pace {
    /// Largest norm, length of the next and of the last step (NaN where there is none), and the rates in the last one.
    pub(super) fn numbers(&self) -> (f64, f64, f64, &[Hex8Stress]) {
        let next = self.next.unwrap_or(f64::NAN);
        match &self.last {
            Some((rates, length)) => (self.largest, next, *length, rates),
            None => (self.largest, next, f64::NAN, &[]),
        }
    }

    /// The course with these numbers.
    pub(super) fn of_numbers(
        largest: f64,
        next: f64,
        length: f64,
        rates: Option<Vec<Hex8Stress>>,
    ) -> Self {
        Self {
            last: rates.map(|rates| (rates, length)),
            largest,
            next: next.is_finite().then_some(next),
        }
    }
}

impl Viscosity {
    /// Discards the rates of the last step: the loads have a corner here.
    pub fn turn_corner(&mut self) {
        (self.pace.last, self.pace.next) = (None, None);
    }

    /// Length in s that was chosen for the next step; `None` at first and after a corner of the loads.
    pub fn next_step(&self) -> Option<f64> {
        self.pace.next
    }

    /// Sets the length in s of the next step.
    pub fn set_next_step(&mut self, step: f64) {
        self.pace.next = Some(step);
    }

    /// Error of the stress of all branches after a step of `step` seconds to `positions`, relative to the largest stress so
    /// far, both as root mean squares over the volume.
    pub fn error(&self, body: &Body, positions: &[Vec3], step: f64) -> f64 {
        let Some(before) = &self.before else {
            return 0.0;
        };
        let last = self.pace.last.as_ref();
        let materials = body.hex8_term().materials.iter();
        let weights: Vec<f64> = materials
            .map(|material| {
                let each = material.branches().map(|(stiffness, time)| {
                    let part = stiffness * time * time * curvature_weight(step / time);
                    match last {
                        Some((_, length)) => part * 2.0 / (step + length),
                        None => part / time,
                    }
                });
                each.sum()
            })
            .collect();
        let now = stresses(body, positions);
        let errors: Vec<Hex8Stress> = body
            .hex8s()
            .iter()
            .enumerate()
            .map(|(index, hex8)| {
                let change = now[index].plus_scaled(-1.0, &before[index]);
                let mut turn = Hex8Stress::ZERO.plus_scaled(1.0 / step, &change);
                if let Some((rates, _)) = last {
                    turn = turn.plus_scaled(-1.0, &rates[index]);
                }
                Hex8Stress::ZERO.plus_scaled(weights[hex8.material as usize], &turn)
            })
            .collect();
        let largest = self.pace.largest.max(norm(body, &now));
        if largest > 0.0 {
            norm(body, &errors) / largest
        } else {
            0.0
        }
    }
}

/// Integral `φ/τ²` over the ratio `h/τ`.
fn curvature_weight(ratio: f64) -> f64 {
    if ratio < SHORT {
        return ratio.powi(3) / 12.0 * (1.0 - ratio / 2.0 + 0.15 * ratio * ratio);
    }
    ratio / 2.0 - 1.0 + libm::exp(-ratio) * (1.0 + ratio / 2.0)
}

/// Norm of a stress over the volume of a body, Pa √m³.
fn norm(body: &Body, stresses: &[Hex8Stress]) -> f64 {
    let hex8s = body.hex8s().iter().zip(stresses);
    let squares = hex8s.map(|(hex8, stress)| hex8.volume(body.material_of(hex8)) * stress.square());
    squares.sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weight_of_curvature_is_smooth_and_has_its_limits() {
        let closed = |x: f64| x / 2.0 - 1.0 + libm::exp(-x) * (1.0 + x / 2.0);
        // The first term left out of the series is x⁶/360, against x³/12.
        assert!((curvature_weight(0.049) / closed(0.049) - 1.0).abs() < 1e-5);
        assert!((curvature_weight(1e-3) / (1e-9 / 12.0) - 1.0).abs() < 1e-3);
        assert!((curvature_weight(1e4) / 5e3 - 1.0).abs() < 1e-3);
    }
}
