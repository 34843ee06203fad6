//! The contract of a term of the energy: a block of like elements.

use std::fmt::Debug;

use crate::ProblemError;
use crate::assembly::{
    Elements, ElementsVisitor, Visitor, add_product, add_row_sums, check_indices,
};
use crate::element::hex8::{Hex8AssumedStrain, Tangent};
use crate::element::membrane::Plane;
use crate::vector::Vec3;

/// A block of like elements.
///
/// [`crate::conformance::check_term`] checks these contracts for every term.
pub trait Term: Debug + Send + Sync {
    /// The name of its elements.
    fn name(&self) -> &'static str;

    /// Checks numbers and indices against the number of vertices.
    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        let mut outcome = Ok(());
        self.visit_pattern(&mut |element| {
            if outcome.is_ok() {
                outcome = check_indices("vertex of an attached term", element, vertices);
            }
        });
        outcome
    }

    /// Tests whether it ties the body to fixed points, so that moving the whole body costs energy.
    fn is_anchored(&self) -> bool {
        false
    }

    /// Tests whether it acts on single vertices or between nearby surfaces only, so that multigrid on the voxels
    /// converges with it.
    fn is_local(&self) -> bool {
        false
    }

    /// Visits the vertices of every element: its stiffness couples no others.
    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32]));

    /// The energy in J.
    fn energy(&self, positions: &[Vec3]) -> f64;

    /// Adds the forces in N, minus the gradient of the energy.
    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]);

    /// Visits the element matrices of the stiffness in N/m, the Hessian of the energy, one at a time.
    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>);

    /// Visits the element matrices of the stiffness in batches of a size that the term chooses.
    fn visit_elements(&self, positions: &[Vec3], visit: ElementsVisitor<'_>) {
        self.visit_stiffness(positions, &mut |vertices, matrix| {
            visit(Elements {
                width: vertices.len(),
                vertices,
                matrices: matrix,
            });
        });
    }

    /// Visits the element matrices of the tangent stiffness, with or without its geometric part, which may make it
    /// indefinite.
    fn visit_tangent(&self, positions: &[Vec3], _tangent: Tangent, visit: Visitor<'_>) {
        self.visit_stiffness(positions, visit);
    }

    /// Adds for every vertex a bound in N/m on the row sum of the stiffness, where the term is as stiff as it gets near
    /// `positions`.
    fn add_row_sums(&self, positions: &[Vec3], sums: &mut [f64]) {
        self.visit_stiffness(positions, &mut |vertices, matrix| {
            add_row_sums(vertices, matrix, sums);
        });
    }

    /// Adds the product of the stiffness at `positions` with `direction`; terms may omit its geometric part.
    fn add_product(&self, positions: &[Vec3], direction: &[Vec3], product: &mut [Vec3]) {
        self.visit_stiffness(positions, &mut |vertices, matrix| {
            add_product(vertices, matrix, direction, product);
        });
    }

    /// Predicts the strains after a step `moves` from `positions`, to first order, as carried by
    /// [`crate::element::assumed_strain`]; `None` for a term that is evaluated at the end of the step.
    fn predict(&self, _positions: &[Vec3], _moves: &[Vec3]) -> Option<AssumedStrain> {
        None
    }

    /// Adds the forces in N at `positions` of the stress of predicted strains.
    fn add_predicted_forces(
        &self,
        _strain: &AssumedStrain,
        positions: &[Vec3],
        forces: &mut [Vec3],
    ) {
        self.add_forces(positions, forces);
    }

    /// Visits the element matrices of the tangent in N/m at `positions` with the stress of predicted strains.
    fn visit_predicted_stiffness(
        &self,
        _strain: &AssumedStrain,
        positions: &[Vec3],
        visit: Visitor<'_>,
    ) {
        self.visit_stiffness(positions, visit);
    }

    /// Visits the element matrices of that tangent in batches of a size that the term chooses.
    fn visit_predicted_elements(
        &self,
        strain: &AssumedStrain,
        positions: &[Vec3],
        visit: ElementsVisitor<'_>,
    ) {
        self.visit_predicted_stiffness(strain, positions, &mut |vertices, matrix| {
            visit(Elements {
                width: vertices.len(),
                vertices,
                matrices: matrix,
            });
        });
    }

    /// Updates carried strains by a step `moves` from `positions`; returns `false` if [`Term::predict`] there gives all
    /// that is needed.
    fn update(&self, _strain: &mut AssumedStrain, _positions: &[Vec3], _moves: &[Vec3]) -> bool {
        false
    }
}

/// Predicted strains of all elements of a term, unknowns of their own ([`crate::element::assumed_strain`]): plain data
/// that only the term can read.
#[derive(Debug, Clone)]
pub enum AssumedStrain {
    /// A number for each element: a change of length or of volume, a pressure.
    Numbers(Vec<f64>),
    /// The strain of each membrane.
    Planes(Vec<Plane>),
    /// Strain and pressure of each hyperelastic voxel.
    Voxels(Vec<Hex8AssumedStrain>),
}

impl AssumedStrain {
    /// The numbers of a term that predicts one for each element; empty for other terms.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Self::Numbers(numbers) => numbers,
            Self::Planes(_) | Self::Voxels(_) => &[],
        }
    }

    pub(crate) fn planes(&self) -> &[Plane] {
        match self {
            Self::Planes(planes) => planes,
            Self::Numbers(_) | Self::Voxels(_) => &[],
        }
    }

    pub(crate) fn voxels(&self) -> Option<&[Hex8AssumedStrain]> {
        match self {
            Self::Voxels(voxels) => Some(voxels),
            Self::Numbers(_) | Self::Planes(_) => None,
        }
    }
}
