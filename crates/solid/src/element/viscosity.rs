//! Viscous stress of hyperelastic voxels.
//!
//! Both kinds act on the deviatoric stress `s` in the voxel's rotated frame (the volumetric response of rubber is
//! elastic):
//!
//! - Kelvin–Voigt with the retardation time `τ`: `τ ds/dt`.
//! - Prony branches `(γ, τ)`: `dq/dt + q/τ = γ ds/dt`, integrated exactly for a rate that is constant in a
//!   step: `q ← e^(−h/τ) q + γ e^(−h/2τ) Δs` (Simo 1987, doi 10.1016/0045-7825(87)90107-1, with the
//!   midpoint of the exponential). Neither depends on the step as long as it resolves the motion.
//!
//! Steps without inertia ([`Weight::Mean`]) may be longer than `τ`, and have the mean of the exponential in place of its
//! midpoint: `γ (1 − e^(−h/τ)) τ/h Δs`, exact for a constant rate at any length. See [`super::viscous_error`].
//!
//! Explicit substeps add the stress to the forces ([`Viscosity::add_forces`]). Over an implicit step both kinds are a
//! share of `s` and a stress that is known at its start ([`Viscosity::start`]), so that the step keeps its potential:
//! `s` is the gradient of the deviatoric energy, the other is linear in the strain.

use serde::{Deserialize, Serialize};

use crate::Body;
use crate::element::coordinates::STRAIN_COMPONENTS;
use crate::element::hex8::{Hex8Stress, Within};
use crate::element::viscous_error::Pace;
use crate::vector::Vec3;

/// Weight of the change of stress over a step in a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Weight {
    /// The exponential at the middle of the step.
    Middle,
    /// Its mean over the step.
    Mean,
}

/// Viscous history variables of all voxels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Viscosity {
    retardation: f64,
    weight: Weight,
    /// Stress `s` after the last step; `None` where no rate is known: at first and after a jump.
    pub(super) before: Option<Vec<Hex8Stress>>,
    branches: Vec<Vec<Hex8Stress>>,
    /// Steps without inertia so far.
    pub(super) pace: Pace,
}

impl Viscosity {
    /// No history, with the retardation time in s of Kelvin–Voigt damping.
    pub fn new(body: &Body, retardation: f64) -> Self {
        let branches = |hex8| {
            let branches = body.material_of(hex8).branches();
            branches.map(|_| Hex8Stress::ZERO).collect()
        };
        Self {
            retardation,
            weight: Weight::Middle,
            before: None,
            branches: body.hex8s().iter().map(branches).collect(),
            pace: Pace::default(),
        }
    }

    /// History variables of a body for steps without inertia, from its free state on; `None` for one without branches.
    pub fn without_inertia(body: &Body) -> Option<Self> {
        let new = Self::of_viscous(body, 0.0)?;
        Some(Self {
            weight: Weight::Mean,
            before: Some(vec![Hex8Stress::ZERO; body.hex8s().len()]),
            ..new
        })
    }

    /// History variables of a body with viscous stress; `None` for one without.
    pub fn of_viscous(body: &Body, retardation: f64) -> Option<Self> {
        let new = Self::new(body, retardation);
        let relaxes = new.branches.iter().any(|branches| !branches.is_empty());
        (relaxes || (retardation > 0.0 && !new.branches.is_empty())).then_some(new)
    }

    /// Discards the last stress, whose rate is meaningless after a jump; branches stay.
    pub fn jump(&mut self) {
        self.before = None;
    }

    /// Resets the history: the body has been at its positions for ever.
    pub fn restart(&mut self) {
        self.before = None;
        for branches in &mut self.branches {
            branches.fill(Hex8Stress::ZERO);
        }
    }

    /// Adds the forces (N) of all voxels, elastic and viscous, after `h` seconds since the last call.
    pub fn add_forces(&mut self, body: &Body, positions: &[Vec3], h: f64, forces: &mut [Vec3]) {
        let fresh = self.before.is_none();
        let count = body.hex8s().len();
        let before = self
            .before
            .get_or_insert_with(|| vec![Hex8Stress::ZERO; count]);
        let retardation = self.retardation;
        for (index, hex8) in body.hex8s().iter().enumerate() {
            let material = body.material_of(hex8);
            let before = &mut before[index];
            let branches = &mut self.branches[index];
            let viscous = |now: &Hex8Stress| {
                let last = std::mem::replace(before, *now);
                if fresh {
                    return branches
                        .iter()
                        .fold(Hex8Stress::ZERO, |sum, q| sum.plus_scaled(1.0, q));
                }
                let change = now.plus_scaled(-1.0, &last);
                let mut sum = Hex8Stress::ZERO.plus_scaled(retardation / h, &change);
                for (q, branch) in branches.iter_mut().zip(material.branches()) {
                    *q = after(q, branch, h, Weight::Middle, &change);
                    sum = sum.plus_scaled(1.0, q);
                }
                sum
            };
            let corners = hex8.viscous_forces(material, positions, viscous);
            hex8.add_to(&corners, forces);
        }
    }

    /// Adds the viscous stress over a step of `step` seconds from `positions`.
    pub fn start(&mut self, body: &Body, positions: &[Vec3], step: f64, within: &mut [Within]) {
        let before = self.before.get_or_insert_with(|| stresses(body, positions));
        let hex8s = body.hex8s().iter().zip(before).zip(&self.branches);
        for (((hex8, before), branches), within) in hex8s.zip(within) {
            let mut share = match self.weight {
                Weight::Middle => self.retardation / step,
                Weight::Mean => 0.0,
            };
            let mut stress = Hex8Stress::ZERO;
            let material = body.material_of(hex8);
            for (q, (stiffness, time)) in branches.iter().zip(material.branches()) {
                let (decay, weight) = decay_and_weight(step, time, self.weight);
                share += stiffness * weight;
                stress = stress.plus_scaled(decay, q);
            }
            within.share = share;
            within.stress = stress.plus_scaled(-share, before);
        }
    }

    /// Updates the history at the end of that step.
    pub fn end(&mut self, body: &Body, positions: &[Vec3], step: f64) {
        let now = stresses(body, positions);
        if let Some(before) = &self.before {
            let hex8s = body.hex8s().iter().zip(before).zip(&now);
            for (((hex8, before), now), branches) in hex8s.zip(&mut self.branches) {
                let change = now.plus_scaled(-1.0, before);
                for (q, branch) in branches.iter_mut().zip(body.material_of(hex8).branches()) {
                    *q = after(q, branch, step, self.weight, &change);
                }
            }
            if self.weight == Weight::Mean {
                self.pace.take_step(body, before, &now, step);
            }
        }
        self.before = Some(now);
    }

    /// All of it as numbers, for storage; [`Self::restored`] reads them.
    pub fn row(&self) -> Vec<f64> {
        let (largest, next, length, rates) = self.pace.numbers();
        let known = f64::from(u8::from(self.before.is_some()));
        let mut row = vec![known, largest, next, length];
        let branches = self.branches.iter().flatten();
        let stresses = self.before.iter().flatten().chain(rates).chain(branches);
        row.extend(stresses.flat_map(Hex8Stress::row));
        row
    }

    /// History variables of steps without inertia from the numbers of [`Self::row`]; `None` where they are not of this
    /// body.
    pub fn restored(body: &Body, row: &[f64]) -> Option<Self> {
        let mut new = Self::without_inertia(body)?;
        let (&[known, largest, next, length], rest) = row.split_first_chunk::<4>()?;
        let (rows, left) = rest.as_chunks::<STRAIN_COMPONENTS>();
        let mut stresses = rows.iter().map(Hex8Stress::of_row);
        let count = body.hex8s().len();
        let part = |found: Vec<Hex8Stress>| (found.len() == count).then_some(found);
        new.before = if known > 0.0 {
            Some(part(stresses.by_ref().take(count).collect())?)
        } else {
            None
        };
        let rates = if length.is_finite() {
            Some(part(stresses.by_ref().take(count).collect())?)
        } else {
            None
        };
        new.pace = Pace::of_numbers(largest, next, length, rates);
        for branch in new.branches.iter_mut().flatten() {
            *branch = stresses.next()?;
        }
        (left.is_empty() && stresses.next().is_none()).then_some(new)
    }

    /// Sets the stress of the branches as it is, for a state that is looked at.
    pub fn hold(&self, within: &mut [Within]) {
        for (branches, within) in self.branches.iter().zip(within) {
            within.share = 0.0;
            within.stress = branches
                .iter()
                .fold(Hex8Stress::ZERO, |sum, q| sum.plus_scaled(1.0, q));
        }
    }
}

/// Decay of a branch over a step, and its weight for the change of `s`; a step of length zero has ones.
fn decay_and_weight(step: f64, time: f64, weight: Weight) -> (f64, f64) {
    match weight {
        Weight::Middle => {
            let half = libm::exp(-step / (2.0 * time));
            (half * half, half)
        }
        Weight::Mean if step == 0.0 => (1.0, 1.0),
        Weight::Mean => {
            let lost = -libm::expm1(-step / time);
            (1.0 - lost, lost * time / step)
        }
    }
}

/// Stress of a branch `(γ, τ)` after a step in which `s` has changed.
fn after(
    q: &Hex8Stress,
    branch: (f64, f64),
    step: f64,
    weight: Weight,
    change: &Hex8Stress,
) -> Hex8Stress {
    let (stiffness, time) = branch;
    let (decay, weight) = decay_and_weight(step, time, weight);
    Hex8Stress::ZERO
        .plus_scaled(decay, q)
        .plus_scaled(stiffness * weight, change)
}

pub(super) fn stresses(body: &Body, positions: &[Vec3]) -> Vec<Hex8Stress> {
    let positions = &*body.ties().seen(positions);
    let hex8s = body.hex8s().iter();
    hex8s
        .map(|hex8| hex8.deviatoric_stress(body.material_of(hex8), positions))
        .collect()
}
