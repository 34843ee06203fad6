//! Memory of a problem: all that the way to a state leaves behind.

use crate::ContactMemory;
use crate::fluid::FluidMemory;
use crate::loads::TendonMemory;

/// Everything that a problem remembers, as plain data: [`crate::Problem::memory`] reads it and
/// [`crate::Problem::remember`] puts it back.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    /// The time in s that the free stretches of all materials belong to; infinite after all histories.
    pub time: f64,
    /// The largest isochoric energy (J/m³) that each hyperelastic voxel has had, where any softens.
    pub peaks: Option<Vec<f64>>,
    /// Friction of each load that is a tendon, in their order; `None` before a state was accepted.
    pub tendons: Vec<Option<TendonMemory>>,
    /// Gas and liquid in chambers.
    pub fluid: Option<FluidMemory>,
    /// Surfaces that touch.
    pub contact: Option<ContactMemory>,
}
