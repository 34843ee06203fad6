//! The second-order backward difference formula for steps of any length.
//!
//! With `ω` the last step over the one before,
//!
//! ```text
//! v = σ (x − x̂),   a = σ (v − v̂),   σ = 1/(β h),   β = (1 + ω)/(1 + 2ω),
//! x̂ = a₁ xₙ + a₂ xₙ₋₁,  v̂ likewise,   a₁ = (1 + ω)²/(1 + 2ω),   a₂ = −ω²/(1 + 2ω).
//! ```
//!
//! A step without a previous one has `a₁ = 1`, `a₂ = 0`, `β = 1`: backward Euler, whose error is `g h²/2` where a body
//! begins to fall. A motion therefore begins by a step in two stages, the diagonally implicit method of second order of
//! Alexander (1977, doi 10.1137/0714068): backward Euler over the part `γ` ([`FIRST_PART`]), then, with the part `c` of
//! both that the first stage was,
//!
//! ```text
//! σ = 1/((1 − b) h),   a₁ = b/c,   a₂ = 1 − a₁,   b = 1/(2 − 2c),
//! ```
//!
//! where `h` is the length of both. Motions that a step does not resolve are damped by both stages, like by backward
//! Euler; a mean of old and new forces would let a sudden load ring for ever.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use voxsoft_solid::State;
use voxsoft_solid::vector::{Vec3, add, scale};

/// Fraction `γ` of the first stage in the first step of a motion: both stages have the same `σ`.
pub const FIRST_PART: f64 = 1.0 - FRAC_1_SQRT_2;
/// Ratio of the second stage to the first, `(1 − γ)/γ`.
pub const SECOND_OVER_FIRST: f64 = 1.0 + SQRT_2;

/// Stage of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// First stage of the first step.
    First,
    /// Second stage of the first step.
    Second,
    /// Any step after the first one, or after a failed one.
    Later,
}

/// Start of a step: its rate and extrapolated state.
pub struct Start {
    /// Rate `σ` in 1/s.
    pub rate: f64,
    /// Weights `a₁` and `a₂`.
    pub weights: [f64; 2],
    /// Extrapolated positions `x̂` in m.
    pub positions: Vec<Vec3>,
    /// Extrapolated velocities `v̂` in m/s.
    pub velocities: Vec<Vec3>,
}

impl Start {
    /// Starts a step of `step` seconds from `now`, with the state before it if there is one.
    pub fn new(now: &State, before: Option<&State>, step: f64, stage: Stage) -> Self {
        let Some(before) = before else {
            return Self {
                rate: 1.0 / step,
                weights: [1.0, 0.0],
                positions: now.positions.clone(),
                velocities: now.velocities.clone(),
            };
        };
        let last = now.time - before.time;
        let (rate, weights) = if stage == Stage::Second {
            let part = last / (last + step);
            let weight = 0.5 / (1.0 - part);
            let rate = 1.0 / ((1.0 - weight) * (last + step));
            (rate, [weight / part, 1.0 - weight / part])
        } else {
            let ratio = step / last;
            let rate = (1.0 + 2.0 * ratio) / ((1.0 + ratio) * step);
            let first = (1.0 + ratio).powi(2) / (1.0 + 2.0 * ratio);
            let second = -ratio * ratio / (1.0 + 2.0 * ratio);
            (rate, [first, second])
        };
        let mix = |a: &[Vec3], b: &[Vec3]| {
            let pairs = a.iter().zip(b);
            pairs
                .map(|(a, b)| add(scale(weights[0], *a), scale(weights[1], *b)))
                .collect()
        };
        Self {
            rate,
            weights,
            positions: mix(&now.positions, &before.positions),
            velocities: mix(&now.velocities, &before.velocities),
        }
    }
}
