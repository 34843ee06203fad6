//! Viscous stress of hyperelastic voxels over long steps.
//!
//! Both kinds follow the deviatoric stress `s` in the voxel's rotated frame, as in explicit steps:
//!
//! - Kelvin–Voigt with the retardation time `τ`: `τ (s − sₙ)/h`.
//! - Prony branches `(γ, τ)`: `q = e^(−h/τ) qₙ + γ e^(−h/2τ) (s − sₙ)` (Simo 1987,
//!   doi 10.1016/0045-7825(87)90107-1, with the midpoint of the exponential).
//!
//! Over one step both are a share of `s` and a stress that is known at its start, so that the step keeps its potential:
//! `s` is the gradient of the deviatoric energy, the other is linear in the strain.

use voxsoft_solid::Body;
use voxsoft_solid::brick::{BrickStress, Within};
use voxsoft_solid::vector::Vec3;

/// Viscous memory of all voxels.
pub(super) struct Viscosity {
    retardation: f64,
    /// Stress `sₙ` at the last step; empty until the first step.
    before: Vec<BrickStress>,
    branches: Vec<Vec<BrickStress>>,
}

impl Viscosity {
    /// `None` for a body without viscous stress.
    pub fn new(body: &Body, retardation: f64) -> Option<Self> {
        let branches = |brick| body.material_of(brick).branches().count();
        let counts: Vec<usize> = body.bricks().iter().map(branches).collect();
        if counts.is_empty() || (retardation == 0.0 && counts.iter().all(|&count| count == 0)) {
            return None;
        }
        Some(Self {
            retardation,
            before: Vec::new(),
            branches: counts
                .into_iter()
                .map(|count| vec![BrickStress::ZERO; count])
                .collect(),
        })
    }

    /// Resets the memory: the body has been at its positions for ever.
    pub fn restart(&mut self) {
        self.before.clear();
        for branches in &mut self.branches {
            branches.fill(BrickStress::ZERO);
        }
    }

    /// Adds the viscous stress over a step of `step` seconds from `positions`.
    pub fn start(&mut self, body: &Body, positions: &[Vec3], step: f64, within: &mut [Within]) {
        if self.before.is_empty() {
            self.before = stresses(body, positions);
        }
        let bricks = body.bricks().iter().zip(&self.before).zip(&self.branches);
        for (((brick, before), branches), within) in bricks.zip(within) {
            let mut share = self.retardation / step;
            let mut stress = BrickStress::ZERO;
            let material = body.material_of(brick);
            for (q, (stiffness, time)) in branches.iter().zip(material.branches()) {
                let half = (-step / (2.0 * time)).exp();
                share += stiffness * half;
                stress = stress.plus_scaled(half * half, q);
            }
            within.share = share;
            within.stress = stress.plus_scaled(-share, before);
        }
    }

    /// Updates the memory at the end of that step.
    pub fn end(&mut self, body: &Body, positions: &[Vec3], step: f64) {
        let now = stresses(body, positions);
        let bricks = body.bricks().iter().zip(&self.before).zip(&now);
        for (((brick, before), now), branches) in bricks.zip(&mut self.branches) {
            let change = now.plus_scaled(-1.0, before);
            let material = body.material_of(brick);
            for (q, (stiffness, time)) in branches.iter_mut().zip(material.branches()) {
                let half = (-step / (2.0 * time)).exp();
                *q = BrickStress::ZERO
                    .plus_scaled(half * half, q)
                    .plus_scaled(stiffness * half, &change);
            }
        }
        self.before = now;
    }
}

fn stresses(body: &Body, positions: &[Vec3]) -> Vec<BrickStress> {
    let bricks = body.bricks().iter();
    bricks
        .map(|brick| brick.deviatoric_stress(body.material_of(brick), positions))
        .collect()
}
