//! Results of the solvers for Python: frozen classes with typed attributes, and the status of a solution.
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Breakdown, LiveStatus, Look, Status};

use crate::contact_answer::{PyContact, PyObjectPose, PyTouchHistory};
use crate::contact_field::PyContactField;
use crate::simulate::PyProblem;
use crate::tendon::PyTendon;

/// Status at the end of a solution.
#[pyclass(
    frozen,
    eq,
    hash,
    name = "Status",
    module = "voxsoft._core",
    rename_all = "SCREAMING_SNAKE_CASE"
)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PyStatus {
    AtRest,
    EndTime,
    Slow,
    NotAtRest,
    Diverged,
    LimitReached,
    NotConverged,
    Mechanism,
    OutOfMemory,
    Cancelled,
}

impl From<Status> for PyStatus {
    fn from(status: Status) -> Self {
        match status {
            Status::AtRest => Self::AtRest,
            Status::EndTime => Self::EndTime,
            Status::Slow => Self::Slow,
            Status::NotAtRest => Self::NotAtRest,
            Status::Diverged => Self::Diverged,
            Status::LimitReached => Self::LimitReached,
            Status::NotConverged => Self::NotConverged,
            Status::Mechanism => Self::Mechanism,
            Status::OutOfMemory(_) => Self::OutOfMemory,
            Status::Cancelled => Self::Cancelled,
        }
    }
}

/// The last good state, the steps that led to it, and the records taken on the way.
#[pyclass(frozen, get_all, name = "Answer", module = "voxsoft._core")]
pub struct PyAnswer {
    pub status: PyStatus,
    pub positions: Py<PyArray2<f64>>,
    /// Positions of all vertices, those of the frames of rigid objects last.
    pub all_positions: Py<PyArray2<f64>>,
    pub velocities: Py<PyArray2<f64>>,
    pub time: f64,
    pub residual: f64,
    pub steps: u64,
    pub back_offs: u32,
    pub substep: f64,
    pub breakdown: Option<(usize, Vec3, f64)>,
    pub undefined: Option<(usize, usize, Vec3, f64)>,
    pub reactions: Py<PyArray2<f64>>,
    pub reaction: Vec3,
    pub reaction_moment: Vec3,
    pub load: Vec3,
    pub load_moment: Vec3,
    pub elastic_energy: f64,
    pub record_times: Py<PyArray1<f64>>,
    pub records: Py<PyArray3<f64>>,
    pub frames: Py<PyArray3<f64>>,
    pub path: Option<Py<PyPath>>,
    /// Pressure, volume, mass, flow, work and energy of each chamber with a fluid, and at each record.
    pub chambers: Py<PyArray2<f64>>,
    pub chamber_records: Py<PyArray3<f64>>,
    /// Contact of each pair of surfaces that touch.
    pub contacts: Vec<Py<PyContact>>,
    /// Poses of the rigid objects.
    pub objects: Vec<Py<PyObjectPose>>,
    /// Contacts and poses of objects at the times of the records.
    pub history: Option<Py<PyTouchHistory>>,
    /// Tendons in the order of the design.
    pub tendons: Vec<Py<PyTendon>>,
    /// Contact over the vertices of the body; none for a problem without contact.
    pub contact_field: Option<Py<PyContactField>>,
    /// The problem with its history variables (softening, contact, fluid) at the end.
    pub problem: Py<PyProblem>,
}

/// Load path of a static solution.
#[pyclass(frozen, get_all, name = "LoadPath", module = "voxsoft._core")]
pub struct PyPath {
    /// The load factor of the answer.
    pub factor: f64,
    /// Part of the requested range of the control that was reached.
    pub reached: f64,
    /// The load factor at the first limit, if one was met.
    pub limit: Option<f64>,
    /// True for an answer that is stable under constant loads.
    pub stable: bool,
    /// Bytes that the tangent takes, if they exceed the limit; otherwise 0.
    pub needed_bytes: u64,
    /// The load factors at which the body snapped to another equilibrium.
    pub snaps: Vec<f64>,
    /// Factor, iterations, residual and stability of each converged point.
    pub points: Py<PyArray2<f64>>,
}

/// The equilibria of many candidates, one row for each.
#[pyclass(frozen, get_all, name = "Settlement", module = "voxsoft._core")]
pub struct PySettlement {
    pub status: Vec<PyStatus>,
    pub positions: Py<PyArray3<f64>>,
    pub residual: Py<PyArray1<f64>>,
    pub iterations: Py<PyArray1<u32>>,
    pub back_offs: Py<PyArray1<u32>>,
}

/// Status of a live run.
#[pyclass(
    frozen,
    eq,
    hash,
    name = "LiveStatus",
    module = "voxsoft._core",
    rename_all = "SCREAMING_SNAKE_CASE"
)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PyLiveStatus {
    Moving,
    AtRest,
    Diverged,
}

impl TryFrom<LiveStatus> for PyLiveStatus {
    type Error = PyErr;

    fn try_from(status: LiveStatus) -> PyResult<Self> {
        match status {
            LiveStatus::Moving => Ok(Self::Moving),
            LiveStatus::AtRest => Ok(Self::AtRest),
            LiveStatus::Diverged => Ok(Self::Diverged),
            LiveStatus::OutOfMemory(bytes) => Err(PyMemoryError::new_err(format!(
                "a step takes about {bytes} bytes for its tangent, more than the limit of memory"
            ))),
        }
    }
}

/// The load, the component, the place in m and the time in s of a load that had no value at a breakdown.
pub(crate) fn undefined_of(breakdown: Option<Breakdown>) -> Option<(usize, usize, Vec3, f64)> {
    let found = breakdown?.undefined?;
    Some((found.load, found.axis, found.place, found.time))
}

/// Progress of a live run.
#[pyclass(frozen, get_all, name = "Advance", module = "voxsoft._core")]
pub struct PyAdvance {
    pub status: PyLiveStatus,
    pub time: f64,
    pub substep: f64,
    /// Substeps since the start.
    pub substeps: u64,
    /// Substeps taken in this call.
    pub taken: u32,
    pub back_offs: u32,
    pub residual: f64,
    pub elastic: f64,
    pub kinetic: f64,
    pub breakdown: Option<(usize, Vec3, f64)>,
    pub undefined: Option<(usize, usize, Vec3, f64)>,
    /// Wall-clock time of this call, s.
    pub seconds: f64,
}

impl PyAdvance {
    /// A run that has ended because memory did not suffice raises a `MemoryError`.
    pub(crate) fn of(look: &Look, taken: u32, seconds: f64) -> PyResult<Self> {
        Ok(Self {
            status: look.status.try_into()?,
            time: look.time,
            substep: look.substep,
            substeps: look.substeps,
            taken,
            back_offs: look.back_offs,
            residual: look.residual,
            elastic: look.elastic,
            kinetic: look.kinetic,
            breakdown: look.breakdown.map(|b| (b.vertex, b.rest, b.when)),
            undefined: undefined_of(look.breakdown),
            seconds,
        })
    }
}
