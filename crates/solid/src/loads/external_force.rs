//! The contract of a kind of external load.

use std::fmt::Debug;

use crate::ProblemError;
use crate::assembly::Visitor;
use crate::vector::Vec3;

/// The vertices that a load acts on: positions at rest, present positions, and masses.
#[derive(Debug, Clone, Copy)]
pub struct Vertices<'a> {
    /// Positions at rest in m.
    pub rest: &'a [Vec3],
    /// Positions in m.
    pub positions: &'a [Vec3],
    /// Lumped masses in kg.
    pub masses: &'a [f64],
}

/// Forces of a kind of load on the vertices, at a factor of one if none is given.
///
/// [`crate::conformance::check_load`] checks these contracts for every kind.
pub trait ExternalForce: Debug + Send + Sync {
    /// Checks numbers and indices against the number of vertices.
    fn check(&self, vertices: usize) -> Result<(), ProblemError>;

    /// Adds `factor` times the forces in N.
    fn add_forces(&self, on: Vertices<'_>, factor: f64, forces: &mut [Vec3]);

    /// Minus the potential in J: its derivative by positions is the force, if the load is conservative. It is zero for
    /// dead loads on a body at rest.
    fn work(&self, on: Vertices<'_>) -> f64;

    /// The potential in J under a factor, up to a constant.
    fn potential(&self, on: Vertices<'_>, factor: f64) -> f64 {
        -factor * self.work(on)
    }

    /// Adds `weight` times the derivative of the forces by the factor, in N.
    fn add_slopes(&self, on: Vertices<'_>, _factor: f64, weight: f64, forces: &mut [Vec3]) {
        self.add_forces(on, weight, forces);
    }

    /// Tests whether the forces are the factor times those at a factor of one.
    fn is_proportional(&self) -> bool {
        true
    }

    /// Tests whether it controls a length, with a stiffness above that of any body.
    fn holds_length(&self) -> bool {
        false
    }

    /// Tests whether its stiffness couples nearby vertices only, so that multigrid on the voxels converges with it.
    fn is_local(&self) -> bool {
        true
    }

    /// Tests whether the forces depend on the load path.
    fn depends_on_way(&self) -> bool {
        false
    }

    /// Tests whether the forces depend on the present positions. Those of a dead load do not.
    fn follows(&self) -> bool {
        false
    }

    /// Tests whether the forces change with time under a constant factor.
    fn varies(&self) -> bool {
        false
    }

    /// Tests whether the forces depend on the velocities within a time step, which are functions of the positions at its
    /// end ([`crate::Problem::begin_motion`]).
    fn feels_motion(&self) -> bool {
        false
    }

    /// Finds a component without a finite value at positions (m), velocities (m/s) and a time (s): the vertex and the axis.
    fn undefined(
        &self,
        _positions: &[Vec3],
        _velocities: &[Vec3],
        _time: f64,
    ) -> Option<(usize, usize)> {
        None
    }

    /// Tests whether the forces have a potential, so that their derivative is symmetric.
    fn is_conservative(&self) -> bool {
        true
    }

    /// Tests whether it is proportional to the masses.
    fn is_weight(&self) -> bool {
        false
    }

    /// Tests whether its work is a pressure times a volume, which volume control prescribes instead.
    fn is_pressure(&self) -> bool {
        false
    }

    /// Visits the element matrices of `factor` times minus the derivative of the forces by positions (N/m), as
    /// [`crate::Term::visit_stiffness`] does.
    fn visit_stiffness(&self, _on: Vertices<'_>, _factor: f64, _visit: Visitor<'_>) {}

    /// Visits the vertices of every element of that derivative.
    fn visit_pattern(&self, _visit: &mut dyn FnMut(&[u32])) {}

    /// This load on renumbered vertices.
    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce>;
}

/// Refuses numbers that are not finite.
pub(crate) fn check_finite(values: &[f64]) -> Result<(), ProblemError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(ProblemError::NotFinite { what: "a load" })
    }
}
