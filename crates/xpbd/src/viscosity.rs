//! Viscous stress of hyperelastic voxels.
//!
//! Both kinds act on the deviatoric stress `s` in the voxel's rotated frame (the volumetric response of rubber is
//! elastic):
//!
//! - Kelvin–Voigt with the retardation time `τ`: `τ ds/dt`.
//! - Prony branches `(γ, τ)`: `dq/dt + q/τ = γ ds/dt`, integrated exactly for a rate that is constant in a
//!   substep: `q ← e^(−h/τ) q + γ e^(−h/2τ) Δs` (Simo 1987, doi 10.1016/0045-7825(87)90107-1, with the
//!   midpoint of the exponential). Neither depends on the step as long as it resolves the motion.

use voxsoft_solid::Body;
use voxsoft_solid::brick::BrickStress;
use voxsoft_solid::vector::Vec3;

/// Viscous history variables of all voxels.
pub(crate) struct Viscosity {
    retardation: f64,
    before: Vec<BrickStress>,
    branches: Vec<Vec<BrickStress>>,
    /// True at the first substep and after a jump back, where no rate is known.
    fresh: bool,
}

impl Viscosity {
    pub fn new(body: &Body, retardation: f64) -> Self {
        let branches = |brick| {
            body.material_of(brick)
                .branches()
                .map(|_| BrickStress::ZERO)
        };
        Self {
            retardation,
            before: vec![BrickStress::ZERO; body.bricks().len()],
            branches: body
                .bricks()
                .iter()
                .map(|b| branches(b).collect())
                .collect(),
            fresh: true,
        }
    }

    /// Discards the last stress, whose rate is meaningless after a jump; branches stay.
    pub fn restart(&mut self) {
        self.fresh = true;
    }

    /// Adds the forces of all voxels, elastic and viscous, after `h` seconds since the last call.
    pub fn add_forces(&mut self, body: &Body, positions: &[Vec3], h: f64, forces: &mut [Vec3]) {
        let fresh = std::mem::replace(&mut self.fresh, false);
        let retardation = self.retardation;
        for (index, brick) in body.bricks().iter().enumerate() {
            let material = body.material_of(brick);
            let before = &mut self.before[index];
            let branches = &mut self.branches[index];
            let viscous = |now: &BrickStress| {
                let last = std::mem::replace(before, *now);
                if fresh {
                    return branches
                        .iter()
                        .fold(BrickStress::ZERO, |sum, q| sum.plus_scaled(1.0, q));
                }
                let change = now.plus_scaled(-1.0, &last);
                let mut sum = BrickStress::ZERO.plus_scaled(retardation / h, &change);
                for (q, (stiffness, time)) in branches.iter_mut().zip(material.branches()) {
                    let half = libm::exp(-h / (2.0 * time));
                    *q = BrickStress::ZERO
                        .plus_scaled(half * half, q)
                        .plus_scaled(stiffness * half, &change);
                    sum = sum.plus_scaled(1.0, q);
                }
                sum
            };
            let corners = brick.viscous_forces(material, positions, viscous);
            brick.add_to(&corners, forces);
        }
    }
}
