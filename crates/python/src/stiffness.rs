//! `_core.Stiffness`: the assembled tangent of a large body, and linear solutions with it.
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_statics::Stiffness;

use crate::arrays::rows;
use crate::equilibrium::to_python;
use crate::gate;
use crate::simulate::PyProblem;

/// Starts (n + 1,) of the rows, vertices (m,) and blocks (m, 3, 3) in N/m.
type Rows<'py> = (
    Bound<'py, PyArray1<u64>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray3<f64>>,
);

/// Tangent of a body of equal voxels under its whole load at `positions`, without contact. `memory` is the limit in
/// bytes; a `MemoryError` carries the bytes needed.
#[pyclass(frozen, name = "Stiffness", module = "voxsoft._core")]
pub struct PyStiffness {
    inner: Mutex<Stiffness>,
    vertices: usize,
}

#[pymethods]
impl PyStiffness {
    #[new]
    #[pyo3(signature = (problem, positions, *, memory=u64::MAX))]
    fn new(
        py: Python<'_>,
        problem: PyRef<'_, PyProblem>,
        positions: PyReadonlyArray2<'_, f64>,
        memory: u64,
    ) -> PyResult<Self> {
        let positions = problem.positions(&positions)?;
        let now = problem.now();
        let made = gate::run(py, |_| Stiffness::new(&now, &positions, memory))?;
        let inner = made.map_err(to_python)?.ok_or_else(|| {
            PyValueError::new_err(
                "conjugate gradients take bodies of equal voxels with a symmetric tangent only",
            )
        })?;
        Ok(Self {
            inner: Mutex::new(inner),
            vertices: positions.len(),
        })
    }

    /// The matrix by blocks of vertices, zero on held coordinates: `scipy.sparse.bsr_array((blocks, vertices, starts))`.
    fn block_rows<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        let rows = (self.inner.lock())
            .unwrap_or_else(PoisonError::into_inner)
            .block_rows();
        let count = rows.blocks.len();
        Ok((
            PyArray1::from_iter(py, rows.starts.iter().map(|&start| start as u64)),
            PyArray1::from_vec(py, rows.columns),
            PyArray1::from_vec(py, rows.blocks.into_flattened()).reshape([count, 3, 3])?,
        ))
    }

    /// Derives the preconditioner, which the first solution does otherwise.
    fn precondition(&self, py: Python<'_>) -> PyResult<()> {
        gate::run(py, |_| {
            let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            inner.precondition()
        })?
        .map_err(to_python)
    }

    /// Displacements (n, 3) in m under forces (n, 3) in N, to a relative error in energy of about `tolerance`, and the
    /// number of iterations.
    fn solve<'py>(
        &self,
        py: Python<'py>,
        forces: PyReadonlyArray2<'_, f64>,
        tolerance: f64,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, usize)> {
        let forces = rows("forces", &forces)?;
        if forces.len() != self.vertices {
            return Err(PyValueError::new_err(format!(
                "forces on {} vertices for a body of {}",
                forces.len(),
                self.vertices
            )));
        }
        let solution = gate::run(py, |cancel| {
            let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            inner.solve(&forces, tolerance, &mut || cancel.load(Ordering::Relaxed))
        })?
        .map_err(to_python)?;
        let flat = solution.displacements.into_flattened();
        let array = PyArray1::from_vec(py, flat).reshape([self.vertices, 3])?;
        Ok((array, solution.iterations))
    }
}
