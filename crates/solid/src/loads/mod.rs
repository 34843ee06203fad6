//! External loads: each kind is a file here, a variant of [`LoadKind`], and nothing else in the core.

pub(crate) mod clamp;
mod dielectric;
pub(crate) mod eigenstrain;
pub(crate) mod external_force;
pub mod grabs;
mod gravity;
pub(crate) mod history;
mod hydrostatic;
mod point_forces;
mod pressure;
mod tendon;

use serde::{Deserialize, Serialize};

use crate::vector::Vec3;
use crate::{History, Mirrored};
use external_force::ExternalForce;

pub use dielectric::{Dielectric, Element};
pub use gravity::Gravity;
pub use hydrostatic::Hydrostatic;
pub use point_forces::PointForces;
pub use pressure::{Pressure, enclosed_volume};
pub use tendon::{Drive, Place, Tendon, TendonMemory, TendonState};

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
