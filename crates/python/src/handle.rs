//! Shared handle of a problem whose softening history can be replaced, and the memory of a problem.
use std::sync::{Arc, PoisonError, RwLock};

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use voxsoft_solid::{Memory, Problem};

/// Problem of a `_core.Problem`, shared with its displays and fields.
///
/// Each solution works on a copy of its own; peaks of softening from a stored result replace the whole value.
pub(crate) struct Handle(RwLock<Arc<Problem>>);

impl Handle {
    pub fn new(problem: Problem) -> Self {
        Self(RwLock::new(Arc::new(problem)))
    }

    /// Present problem with its history variables.
    pub fn now(&self) -> Arc<Problem> {
        // A value is replaced whole, so that a thread that panicked leaves none half written.
        Arc::clone(&self.0.read().unwrap_or_else(PoisonError::into_inner))
    }

    /// Changes the problem, such as its history variables.
    pub fn change(&self, act: impl FnOnce(&mut Problem)) {
        let mut kept = self.0.write().unwrap_or_else(PoisonError::into_inner);
        act(Arc::make_mut(&mut kept));
    }
}

/// Memory of a problem, a value: softening, tendons, fluids, contact and viscous stress at one state.
#[pyclass(frozen, eq, name = "Memory", module = "voxsoft._core")]
#[derive(PartialEq)]
pub struct PyMemory(pub(crate) Memory);

#[pymethods]
impl PyMemory {
    /// All data as bytes, for `Problem.read_memory`.
    fn bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.bytes())
    }
}
