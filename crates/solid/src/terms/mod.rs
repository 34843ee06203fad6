//! Blocks of like elements, each with an energy.
//!
//! A [`crate::Body`] is a list of such terms: those built from its mesh (edges, tetrahedra, voxels, membranes), and any
//! that are attached to it. Solvers know a term by this trait, so a new kind of element is one file that implements it
//! and a variant of [`Attachment`], by which bindings and scenes know it; terms of other crates go through
//! [`crate::Body::attach`]. Dispatch is per block, never per element. A solver with a quicker form of some terms asks
//! the body for them by name: strips of edges and tetrahedra, multigrid on voxels, the inertia of membranes.

mod edges;
mod hex8;
mod membranes;
mod springs;
mod tets;

use serde::{Deserialize, Serialize};

use crate::Mirrored;
use crate::term::Term;

pub use edges::{Edge, Edges};
pub(crate) use hex8::FORCE_BATCH;
pub use hex8::Hex8s;
pub use membranes::Membranes;
pub use springs::{Spring, Springs};
pub(crate) use tets::volume_hessian;
pub use tets::{Tet, Tets};

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
