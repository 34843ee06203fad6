//! External loads: each kind is a file here, a variant of [`LoadKind`], and nothing else in the core.

pub(crate) mod clamp;
mod dielectric;
mod drag;
pub(crate) mod eigenstrain;
pub(crate) mod external_force;
mod field;
pub mod grabs;
mod gravity;
pub(crate) mod history;
mod hydrostatic;
mod point_forces;
mod pressure;
mod tendon;
mod velocities;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::vector::Vec3;
use crate::{History, Mirrored};
use external_force::ExternalForce;

pub use dielectric::{Dielectric, Element};
pub use drag::{Drag, DragLaw};
pub use field::ForceField;
pub use gravity::Gravity;
pub use hydrostatic::Hydrostatic;
pub use point_forces::PointForces;
pub use pressure::{Pressure, enclosed_volume};
pub use tendon::{Drive, Place, Tendon, TendonMemory, TendonState};
pub use velocities::Velocities;

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
    /// The drag of a fluid on a surface.
    Drag(Drag),
    /// An acceleration by formulas.
    Field(ForceField),
}

impl LoadKind {
    /// This load within the steps of a motion, which gives it a potential: a tendon with its friction bounds held constant,
    /// drag with the areas that it begins a step with.
    pub(crate) fn held(&self) -> Self {
        match self {
            Self::Tendon(tendon) => Self::Tendon(tendon.held()),
            Self::Drag(drag) => Self::Drag(drag.in_motion()),
            other => other.clone(),
        }
    }

    /// Gives it the velocities within a time step, and positions (m) near its end, if it feels motion.
    pub(crate) fn begin(&mut self, velocities: &Arc<Velocities>, near: &[Vec3]) {
        match self {
            Self::Drag(drag) => drag.begin(velocities, near),
            Self::Field(field) => field.begin(velocities),
            _ => {}
        }
    }

    /// Gives it the time in s, if it varies by itself.
    pub(crate) fn set_time(&mut self, time: f64) {
        if let Self::Field(field) = self {
            field.set_time(time);
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
            Self::Drag(drag) => drag,
            Self::Field(field) => field,
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

impl From<Drag> for LoadKind {
    fn from(drag: Drag) -> Self {
        Self::Drag(drag)
    }
}

impl From<ForceField> for LoadKind {
    fn from(field: ForceField) -> Self {
        Self::Field(field)
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
