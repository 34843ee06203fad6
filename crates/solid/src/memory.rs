//! Memory of a problem: its data that depend on the load path.

use crate::ContactMemory;
use crate::fluid::FluidMemory;
use crate::loads::TendonMemory;

/// The path-dependent data of a problem: [`crate::Problem::memory`] reads them and [`crate::Problem::remember`]
/// restores them.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    /// The time in s of the present free stretches of all materials; infinite after all histories.
    pub time: f64,
    /// The largest isochoric energy (J/m³) so far of each hyperelastic voxel, if any softens.
    pub peaks: Option<Vec<f64>>,
    /// Friction of each tendon among the loads, in their order; `None` before a state was accepted.
    pub tendons: Vec<Option<TendonMemory>>,
    /// Gas and liquid in chambers.
    pub fluid: Option<FluidMemory>,
    /// Contact between surfaces.
    pub contact: Option<ContactMemory>,
}
