//! The second-order backward difference formula for steps of any length.
//!
//! With `ω` the last step over the one before,
//!
//! ```text
//! v = σ (x − x̂),   a = σ (v − v̂),   σ = 1/(β h),   β = (1 + ω)/(1 + 2ω),
//! x̂ = a₁ xₙ + a₂ xₙ₋₁,  v̂ likewise,   a₁ = (1 + ω)²/(1 + 2ω),   a₂ = −ω²/(1 + 2ω).
//! ```
//!
//! The first step has nothing before it: `a₁ = 1`, `a₂ = 0`, `β = 1`, backward Euler.

use voxsoft_solid::State;
use voxsoft_solid::vector::{Vec3, add, scale};

/// What a step starts from.
pub(crate) struct Start {
    /// `σ` in 1/s.
    pub rate: f64,
    /// `a₁` and `a₂`.
    pub weights: [f64; 2],
    /// `x̂` in m.
    pub positions: Vec<Vec3>,
    /// `v̂` in m/s.
    pub velocities: Vec<Vec3>,
}

impl Start {
    /// A step of `step` seconds from `now`, with the state before it where there is one.
    pub fn new(now: &State, before: Option<&State>, step: f64) -> Self {
        let Some(before) = before else {
            return Self {
                rate: 1.0 / step,
                weights: [1.0, 0.0],
                positions: now.positions.clone(),
                velocities: now.velocities.clone(),
            };
        };
        let ratio = step / (now.time - before.time);
        let first = (1.0 + ratio).powi(2) / (1.0 + 2.0 * ratio);
        let second = -ratio * ratio / (1.0 + 2.0 * ratio);
        let mix = |a: &[Vec3], b: &[Vec3]| {
            let pairs = a.iter().zip(b);
            pairs
                .map(|(a, b)| add(scale(first, *a), scale(second, *b)))
                .collect()
        };
        Self {
            rate: (1.0 + 2.0 * ratio) / ((1.0 + ratio) * step),
            weights: [first, second],
            positions: mix(&now.positions, &before.positions),
            velocities: mix(&now.velocities, &before.velocities),
        }
    }
}
