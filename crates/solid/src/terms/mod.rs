//! Blocks of like elements, each with an energy.
//!
//! A [`crate::Body`] is a list of such terms: those built from its mesh (edges, tetrahedra, voxels, membranes), and any
//! that are attached to it. Solvers know a term by this trait, so a new kind of element is one file that implements it
//! and a variant of [`Attachment`], by which bindings and scenes know it; terms of other crates go through
//! [`crate::Body::attach`]. Dispatch is per block, never per element. A solver with a quicker form of some terms asks
//! the body for them by name: strips of edges and tetrahedra, multigrid on voxels, the inertia of membranes.

mod bricks;
mod edges;
mod membranes;
mod springs;
mod tets;

use std::fmt::Debug;

use serde::{Deserialize, Serialize};

use crate::assembly::{
    Elements, ElementsVisitor, Visitor, add_product, add_row_sums, check_indices,
};
use crate::brick::{Carried, Tangent};
use crate::membrane::Plane;
use crate::vector::Vec3;
use crate::{Mirrored, ProblemError};

pub use bricks::Bricks;
pub(crate) use bricks::FORCE_BATCH;
pub use edges::{Edge, Edges};
pub use membranes::Membranes;
pub use springs::{Spring, Springs};
pub(crate) use tets::volume_hessian;
pub use tets::{Tet, Tets};

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

    /// Predicts the strains after a step `moves` from `positions`, to first order, as carried by [`crate::mixed`];
    /// `None` for a term that is evaluated at the end of the step.
    fn predict(&self, _positions: &[Vec3], _moves: &[Vec3]) -> Option<Strain> {
        None
    }

    /// Adds the forces in N at `positions` of the stress of predicted strains.
    fn add_predicted_forces(&self, _strain: &Strain, positions: &[Vec3], forces: &mut [Vec3]) {
        self.add_forces(positions, forces);
    }

    /// Visits the element matrices of the tangent in N/m at `positions` with the stress of predicted strains.
    fn visit_predicted_stiffness(&self, _strain: &Strain, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_stiffness(positions, visit);
    }

    /// Visits the element matrices of that tangent in batches of a size that the term chooses.
    fn visit_predicted_elements(
        &self,
        strain: &Strain,
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
    fn carry(&self, _strain: &mut Strain, _positions: &[Vec3], _moves: &[Vec3]) -> bool {
        false
    }
}

/// The kinds of terms that can be attached to a body by name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attachment {
    /// Springs between places, or to fixed points.
    Springs(Springs),
    /// Membranes that cross planes of symmetry.
    MirroredMembranes(Mirrored<Membranes>),
}

impl Attachment {
    /// Adds its masses in kg to those of the vertices.
    pub(crate) fn add_masses(&self, masses: &mut [f64]) {
        match self {
            Self::Springs(_) => {}
            Self::MirroredMembranes(membranes) => membranes.add_masses(masses),
        }
    }

    /// Sets the stiffness of the material around each vertex, in N/m.
    pub(crate) fn set_behind(&mut self, behind: &[f64]) {
        match self {
            Self::Springs(_) => {}
            Self::MirroredMembranes(membranes) => membranes.set_behind(behind),
        }
    }
}

impl std::ops::Deref for Attachment {
    type Target = dyn Term;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Springs(springs) => springs,
            Self::MirroredMembranes(membranes) => membranes,
        }
    }
}

/// Predicted strains of all elements of a term, unknowns of their own ([`crate::mixed`]): plain data that only the term
/// can read.
#[derive(Debug, Clone)]
pub enum Strain {
    /// A number for each element: a change of length or of volume, a pressure.
    Numbers(Vec<f64>),
    /// The strain of each membrane.
    Planes(Vec<Plane>),
    /// Strain and pressure of each hyperelastic voxel.
    Voxels(Vec<Carried>),
}

impl Strain {
    /// The numbers of a term that predicts one for each element; empty for other terms.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Self::Numbers(numbers) => numbers,
            Self::Planes(_) | Self::Voxels(_) => &[],
        }
    }

    fn planes(&self) -> &[Plane] {
        match self {
            Self::Planes(planes) => planes,
            Self::Numbers(_) | Self::Voxels(_) => &[],
        }
    }

    fn voxels(&self) -> Option<&[Carried]> {
        match self {
            Self::Voxels(voxels) => Some(voxels),
            Self::Numbers(_) | Self::Planes(_) => None,
        }
    }
}
