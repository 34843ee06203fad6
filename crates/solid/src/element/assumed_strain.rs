//! Mixed formulation: strains as unknowns of Newton's method.
//!
//! A long Newton step of a slender body turns its elements far, which the linear step mistakes for
//! stretch. The stress at the end of the step is then spurious, its geometric stiffness ruins the
//! next tangent, and dozens of iterations go into undoing it. Treating the strain `ê` as an unknown of
//! its own (as mixed elements do) avoids this: stress and moduli are those of `ê`, which the *linear*
//! step predicts, `ê = e(x) + B δ`, and which is moderate. Newton's method on both unknowns is
//!
//! `(Bᵀ C B + G(σ)) δ = f − Bᵀ (σ + C (e(x) − ê))`, `σ = Φ'(ê)`, `C = Φ''(ê)`.
//!
//! The equilibrium is the same, with several times fewer iterations (Magisano, Leonetti and Garcea 2017, doi
//! 10.1016/j.cma.2016.09.044).
//!
//! The pressure of a voxel is an unknown too, `p̂ = K (J(ê) − 1)` at the end and predicted linearly on the way. A
//! strain that bulges by 10 % in a step misses its volume by some 1 % in second order, which a bulk modulus of 100
//! times the shear modulus takes for a pressure as large as that modulus: the geometric stiffness of that ruined
//! tangents, the more so the less a material can be compressed. Newton's method on `x`, `ê` and `p̂` differs from the
//! above by `p̂` in place of `K (J(ê) − 1)` in `C` and `G` alone; in the forces it cancels.

use crate::Body;
use crate::assembly::ElementsVisitor;
use crate::term::{AssumedStrain, Term};
use crate::vector::Vec3;

/// The strain of every element of a body, as plain data.
#[derive(Debug, Clone)]
pub struct AssumedStrains {
    /// Strains in the order of the body's terms; `None` for terms evaluated at the present strains.
    terms: Vec<Option<AssumedStrain>>,
}

impl AssumedStrains {
    /// Predicts the strains after a step `moves` from `positions`, to first order.
    pub fn predict(body: &Body, positions: &[Vec3], moves: &[Vec3]) -> Self {
        let predict = |term: &dyn Term| term.predict(positions, moves);
        Self {
            terms: body.terms().map(predict).collect(),
        }
    }

    /// The strains at `positions` with prescribed pressures in the hyperelastic voxels, in Pa, positive in tension:
    /// such as those of larger voxels there.
    pub fn with_pressures(body: &Body, positions: &[Vec3], pressures: &[f64]) -> Self {
        let hex8s = body.hex8_term();
        let is_hex8s = |term: &dyn Term| term.name() == hex8s.name();
        let with = |term| is_hex8s(term).then(|| hex8s.with_pressures(positions, pressures));
        Self {
            terms: body.terms().map(with).collect(),
        }
    }

    /// Predicts the strains after a further step.
    #[must_use]
    pub fn update(mut self, body: &Body, positions: &[Vec3], moves: &[Vec3]) -> Self {
        for (term, strain) in body.terms().zip(&mut self.terms) {
            let goes_on = strain
                .as_mut()
                .is_some_and(|strain| term.update(strain, positions, moves));
            if !goes_on {
                *strain = term.predict(positions, moves);
            }
        }
        self
    }

    /// Adds the forces at `positions` of the stress predicted by these strains, in N.
    pub fn add_forces(&self, body: &Body, positions: &[Vec3], forces: &mut [Vec3]) {
        for (term, strain) in body.terms().zip(&self.terms) {
            match strain {
                Some(strain) => term.add_predicted_forces(strain, positions, forces),
                None => term.add_forces(positions, forces),
            }
        }
    }

    /// Visits the element matrices of the tangent at `positions` with the stress of these strains, in batches.
    pub fn visit_elements(&self, body: &Body, positions: &[Vec3], visit: ElementsVisitor<'_>) {
        for (term, strain) in body.terms().zip(&self.terms) {
            match strain {
                Some(strain) => term.visit_predicted_elements(strain, positions, visit),
                None => term.visit_elements(positions, visit),
            }
        }
    }
}
