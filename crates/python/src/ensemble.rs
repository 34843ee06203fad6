//! `_core.Ensemble`: the equilibria of many variants of one problem at a time.
use std::sync::Arc;
use std::sync::atomic::Ordering;

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_statics::{Ensemble, Variant};

use crate::answer::PySettlement;
use crate::arrays::rows;
use crate::gate;
use crate::simulate::PyProblem;

/// A problem laid out for many candidates at a time.
#[pyclass(frozen, name = "Ensemble", module = "voxsoft._core")]
pub struct PyEnsemble(Arc<Ensemble>);

#[pymethods]
impl PyEnsemble {
    /// Lays out a problem; None for one that an ensemble does not support.
    #[staticmethod]
    fn of(problem: PyRef<'_, PyProblem>) -> Option<Self> {
        Ensemble::of(&problem.now()).map(Arc::new).map(Self)
    }

    /// Number of products of 3×3 blocks in each factorization.
    #[getter]
    fn products(&self) -> u64 {
        self.0.products()
    }

    /// Memory of the tangents of one thread in bytes.
    #[getter]
    fn bytes(&self) -> u64 {
        self.0.bytes()
    }

    /// Number of candidates solved at a time on one thread.
    #[getter]
    fn lanes(&self) -> usize {
        self.0.lanes()
    }

    /// The equilibria of candidates with factors (n, 4) on edges, tetrahedra, gravity and other forces.
    fn settle(
        &self,
        py: Python<'_>,
        factors: PyReadonlyArray2<'_, f64>,
        tolerance: f64,
    ) -> PyResult<PySettlement> {
        let rows: Vec<[f64; 4]> = rows("factors", &factors)?;
        let mut variants = Vec::with_capacity(rows.len());
        for [edge, bulk, weight, forces] in rows {
            let stiff = edge > 0.0 && bulk > 0.0 && edge.is_finite() && bulk.is_finite();
            if !stiff || !weight.is_finite() || !forces.is_finite() {
                let message = "factors on stiffness must be positive, and all must be finite";
                return Err(PyValueError::new_err(message));
            }
            variants.push(Variant {
                edge,
                bulk,
                weight,
                forces,
            });
        }
        // Owned work lets Ctrl-C return at once: one Newton step of a wide body takes longer.
        let ensemble = Arc::clone(&self.0);
        let found = gate::run_owned(py, move |cancel| {
            let stop = || cancel.load(Ordering::Relaxed);
            ensemble.settle(&variants, tolerance, &stop)
        })?;
        let vertices = found.first().map_or(0, |f| f.positions.len());
        let flat: Vec<f64> = found
            .iter()
            .flat_map(|f| f.positions.as_flattened())
            .copied()
            .collect();
        let counts = |value: fn(&voxsoft_statics::Settled) -> u32| {
            PyArray1::from_vec(py, found.iter().map(value).collect()).unbind()
        };
        Ok(PySettlement {
            status: found.iter().map(|f| f.status.into()).collect(),
            positions: PyArray1::from_vec(py, flat)
                .reshape([found.len(), vertices, 3])?
                .unbind(),
            residual: PyArray1::from_vec(py, found.iter().map(|f| f.residual).collect()).unbind(),
            iterations: counts(|f| f.iterations),
            back_offs: counts(|f| f.back_offs),
        })
    }
}
