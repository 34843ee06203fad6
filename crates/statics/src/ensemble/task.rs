//! Input and output of a solution of many candidates.

use voxsoft_solid::Status;
use voxsoft_solid::vector::Vec3;

use super::layout::Layout;

/// Parameters of one candidate, as factors on the common problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// Factor on the stiffness of all edges.
    pub edge: f64,
    /// Factor on the stiffness of all tetrahedra.
    pub bulk: f64,
    /// Factor on gravity: of another density, or another acceleration.
    pub weight: f64,
    /// Factor on all other forces.
    pub forces: f64,
}

/// Result of one candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// Last equilibrium, in m.
    pub positions: Vec<Vec3>,
    /// [`Status::AtRest`] in a stable equilibrium under the full load; [`Status::NotConverged`] if [`crate::solve`],
    /// which has more methods, may still find one; [`Status::Cancelled`].
    pub status: Status,
    /// Relative residual force.
    pub residual: f64,
    /// Newton steps.
    pub iterations: u32,
    /// Cuts of the load step.
    pub back_offs: u32,
}

/// Input of all groups.
pub(super) struct Task<'a> {
    pub layout: &'a Layout,
    pub arch: pulp::Arch,
    pub variants: &'a [Variant],
    pub tolerance: f64,
    pub stop: &'a (dyn Fn() -> bool + Sync),
}
