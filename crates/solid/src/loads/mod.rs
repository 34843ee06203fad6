//! External loads: each kind is a file here, a variant of [`LoadKind`], and nothing else in the core.

mod dielectric;
mod gravity;
mod hydrostatic;
mod point_forces;
mod pressure;
mod tendon;

use std::fmt::Debug;

use serde::{Deserialize, Serialize};

use crate::assembly::Visitor;
use crate::vector::Vec3;
use crate::{History, Mirrored, ProblemError};

pub use dielectric::{Dielectric, Element};
pub use gravity::Gravity;
pub use hydrostatic::Hydrostatic;
pub use point_forces::PointForces;
pub use pressure::{Pressure, enclosed_volume};
pub use tendon::{Drive, Place, Tendon, TendonMemory, TendonState};

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
    fn visit_stiffness(&self, _positions: &[Vec3], _factor: f64, _visit: Visitor<'_>) {}

    /// Visits the vertices of every element of that derivative.
    fn visit_pattern(&self, _visit: &mut dyn FnMut(&[u32])) {}

    /// This load on renumbered vertices.
    fn renumbered(&self, number: &dyn Fn(u32) -> u32) -> Box<dyn ExternalForce>;
}

/// The kinds of loads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LoadKind {
    /// An acceleration of all mass.
    Gravity(Gravity),
    /// A pressure on a surface.
    Pressure(Pressure),
    /// Forces on vertices.
    Forces(PointForces),
    /// The weight of a liquid in a cavity.
    Hydrostatic(Hydrostatic),
    /// A pressure on a surface that crosses planes of symmetry.
    MirroredPressure(Mirrored<Pressure>),
    /// The pull of a tendon.
    Tendon(Tendon),
    /// The squeeze of a sheet by its electrodes.
    Dielectric(Dielectric),
}

impl LoadKind {
    /// This load with its friction bounds held constant during a step, which gives a tendon with friction a potential.
    pub(crate) fn held(&self) -> Self {
        match self {
            Self::Tendon(tendon) => Self::Tendon(tendon.held()),
            other => other.clone(),
        }
    }
}

impl std::ops::Deref for LoadKind {
    type Target = dyn ExternalForce;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Gravity(gravity) => gravity,
            Self::Pressure(pressure) => pressure,
            Self::Forces(forces) => forces,
            Self::Hydrostatic(weight) => weight,
            Self::MirroredPressure(pressure) => pressure,
            Self::Tendon(tendon) => tendon,
            Self::Dielectric(sheet) => sheet,
        }
    }
}

impl From<Gravity> for LoadKind {
    fn from(gravity: Gravity) -> Self {
        Self::Gravity(gravity)
    }
}

impl From<Pressure> for LoadKind {
    fn from(pressure: Pressure) -> Self {
        Self::Pressure(pressure)
    }
}

impl From<Mirrored<Pressure>> for LoadKind {
    fn from(pressure: Mirrored<Pressure>) -> Self {
        Self::MirroredPressure(pressure)
    }
}

impl From<Tendon> for LoadKind {
    fn from(tendon: Tendon) -> Self {
        Self::Tendon(tendon)
    }
}

impl From<Dielectric> for LoadKind {
    fn from(sheet: Dielectric) -> Self {
        Self::Dielectric(sheet)
    }
}

impl From<Hydrostatic> for LoadKind {
    fn from(weight: Hydrostatic) -> Self {
        Self::Hydrostatic(weight)
    }
}

impl From<PointForces> for LoadKind {
    fn from(forces: PointForces) -> Self {
        Self::Forces(forces)
    }
}

/// A load with its history.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// The kind of load, with its data.
    pub kind: LoadKind,
    /// The factor over time.
    pub history: History,
}

impl Load {
    /// A constant gravity in m/s².
    pub fn gravity(acceleration: Vec3) -> Self {
        Self::constant(Gravity { acceleration })
    }

    /// A load that does not vary with time.
    pub fn constant(kind: impl Into<LoadKind>) -> Self {
        Self {
            kind: kind.into(),
            history: History::constant(),
        }
    }
}

/// Refuses numbers that are not finite.
fn check_finite(values: &[f64]) -> Result<(), ProblemError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(ProblemError::NotFinite { what: "a load" })
    }
}
