//! `_core.modes`: natural vibration modes about an equilibrium.
use std::sync::atomic::Ordering;

use numpy::{PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use voxsoft_solid::Problem;

use crate::equilibrium::to_python;
use crate::gate;
use crate::sensitivity::contact_mut;
use crate::simulate::PyProblem;

/// Squares of angular frequencies (k,) in 1/s², and mode shapes (k, n, 3) of unit modal mass in kg^-1/2.
type Vibrations<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray3<f64>>);

/// The `count` lowest vibration modes about an equilibrium. `memory` is the limit in bytes for the tangent; a
/// `MemoryError` carries the bytes needed.
#[pyfunction]
#[pyo3(signature = (problem, positions, count, *, memory=u64::MAX))]
pub fn modes<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
    positions: PyReadonlyArray2<'_, f64>,
    count: usize,
    memory: u64,
) -> PyResult<Vibrations<'py>> {
    let positions = problem.positions(&positions)?;
    let vertices = positions.len();
    let mut inner = Problem::clone(&problem.now());
    if let Some(contact) = contact_mut(&mut inner) {
        contact.stick_firmly();
    }
    let found = gate::run_owned(py, move |cancel| {
        let mut stop = || cancel.load(Ordering::Relaxed);
        voxsoft_statics::modes(&inner, &positions, count, memory, &mut stop)
    })?
    .map_err(to_python)?;
    let squares = found.iter().map(|mode| mode.square).collect();
    let shapes: Vec<f64> = found
        .iter()
        .flat_map(|mode| mode.shape.iter().flatten().copied())
        .collect();
    Ok((
        PyArray1::from_vec(py, squares),
        PyArray1::from_vec(py, shapes).reshape([found.len(), vertices, 3])?,
    ))
}
