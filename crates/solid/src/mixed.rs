//! Strains that Newton's method carries along by itself.
//!
//! A long Newton step of a slender body turns its elements far, which the linear step mistakes for
//! stretch. The stress at the end of the step is then spurious, its geometric stiffness ruins the
//! next tangent, and dozens of iterations go into undoing it. Treating the strain `ê` as an unknown of
//! its own (as mixed elements do) avoids this: stress and moduli are those of `ê`, which the *linear*
//! step predicts, `ê = e(x) + B δ`, and which is moderate. Newton's method on both unknowns is
//!
//! `(Bᵀ C B + G(σ)) δ = f − Bᵀ (σ + C (e(x) − ê))`, `σ = Φ'(ê)`, `C = Φ''(ê)`.
//!
//! The equilibrium is the same; the way there is several times shorter (Magisano, Leonetti and Garcea
//! 2017, doi 10.1016/j.cma.2016.09.044).
//!
//! The pressure of a voxel is an unknown too, `p̂ = K (J(ê) − 1)` at the end and predicted linearly on the way. A strain
//! that bulges by 10 % in a step misses its volume by some 1 % in second order, which a bulk modulus of 100 times
//! the shear modulus takes for a pressure as large as that modulus: the geometric stiffness of that ruined
//! tangents the more the less a material can be compressed. Newton's method on `x`, `ê` and `p̂` differs from the above
//! by `p̂` in place of `K (J(ê) − 1)` in `C` and `G` alone; in the forces it cancels.

use crate::Body;
use crate::assembly::{ElementsVisitor, Visitor};
use crate::terms::{Strain, Term};
use crate::vector::Vec3;

/// The place of hyperelastic voxels among the terms of a body.
const BRICKS: usize = 2;

/// The strain of every element of a body.
pub struct Strains<'a> {
    terms: Vec<Box<dyn Strain + 'a>>,
}

impl<'a> Strains<'a> {
    /// The strains that a step `moves` from `positions` leads to, to first order.
    pub fn predict(body: &'a Body, positions: &[Vec3], moves: &[Vec3]) -> Self {
        let predict = |term| Self::of_term(term, positions, moves);
        Self {
            terms: body.terms().map(predict).collect(),
        }
    }

    /// The strains at `positions` with other pressures in the hyperelastic voxels, in Pa, positive in tension: those of
    /// larger voxels there, say.
    pub fn with_pressures(body: &'a Body, positions: &[Vec3], pressures: &[f64]) -> Self {
        let bricks = body.brick_term().with_pressures(positions, pressures);
        let others = body.terms_but_bricks();
        let as_they_are = others.map(|term| Box::new(AsItIs(term)) as Box<dyn Strain + 'a>);
        // In the order of the body's terms, in which they are carried on.
        let mut terms: Vec<_> = as_they_are.collect();
        terms.insert(BRICKS, bricks);
        Self { terms }
    }

    /// The same after a further step.
    #[must_use]
    pub fn carry(mut self, body: &'a Body, positions: &[Vec3], moves: &[Vec3]) -> Self {
        for (term, strain) in body.terms().zip(&mut self.terms) {
            if !strain.carry(positions, moves) {
                *strain = Self::of_term(term, positions, moves);
            }
        }
        self
    }

    fn of_term(term: &'a dyn Term, positions: &[Vec3], moves: &[Vec3]) -> Box<dyn Strain + 'a> {
        let strain = term.predict(positions, moves);
        strain.unwrap_or_else(|| Box::new(AsItIs(term)))
    }

    /// Adds the forces at `positions` of the stress that these strains predict, in N.
    pub fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        for term in &self.terms {
            term.add_forces(positions, forces);
        }
    }

    /// The tangent at `positions` with the stress of these strains, as many elements at a time as suits.
    pub fn visit_elements(&self, positions: &[Vec3], visit: ElementsVisitor<'_>) {
        for term in &self.terms {
            term.visit_elements(positions, visit);
        }
    }
}

/// A term without strains of its own to carry along.
struct AsItIs<'a>(&'a dyn Term);

impl Strain for AsItIs<'_> {
    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        self.0.add_forces(positions, forces);
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.0.visit_stiffness(positions, visit);
    }

    fn visit_elements(&self, positions: &[Vec3], visit: ElementsVisitor<'_>) {
        self.0.visit_elements(positions, visit);
    }
}
