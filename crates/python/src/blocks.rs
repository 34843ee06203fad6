//! `_core.block_slopes` and its kin: fractions of the blocks of a problem, and derivatives by them.
use std::sync::Arc;
use std::sync::atomic::Ordering;

use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::prelude::*;
use voxsoft_solid::{Blocks, PerBlock};

use crate::equilibrium::{gradients_of, to_python};
use crate::gate;
use crate::handle::Handle;
use crate::simulate::PyProblem;

/// Copy of the problem with other fractions of the stiffness and the mass of each block, (v,), each times that of the
/// mesh.
#[pyfunction]
pub fn with_fractions(
    problem: PyRef<'_, PyProblem>,
    stiffness: PyReadonlyArray1<'_, f64>,
    mass: PyReadonlyArray1<'_, f64>,
) -> PyResult<PyProblem> {
    problem.filled(Arc::new(PerBlock {
        stiffness: stiffness.as_array().to_vec(),
        mass: mass.as_array().to_vec(),
    }))
}

/// Mass in kg of each block of the mesh, without layers.
#[pyfunction]
pub fn block_masses<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    Ok(PyArray1::from_vec(py, problem.blocks()?.masses()))
}

/// Elastic energy in J of each block at a fraction of one of its stiffness, without layers and springs.
#[pyfunction]
pub fn block_energies<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
    positions: PyReadonlyArray2<'_, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let positions = problem.positions(&positions)?;
    let energies = problem.blocks()?.energies(problem.now().body(), &positions);
    Ok(PyArray1::from_vec(py, energies))
}

/// Slopes by the fractions of the stiffness and of the mass of all blocks, (k, v) each, one row for each gradient (k, n,
/// 3) of a number by the positions of an equilibrium. Raises as `adjoint` does.
#[pyfunction]
#[pyo3(signature = (problem, positions, gradients, *, memory=u64::MAX))]
#[expect(clippy::type_complexity, reason = "two arrays")]
pub fn block_slopes<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
    positions: PyReadonlyArray2<'_, f64>,
    gradients: PyReadonlyArray3<'_, f64>,
    memory: u64,
) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>)> {
    let (positions, own) = (problem.positions(&positions)?, problem.own());
    let gradients = gradients_of(&gradients, own, positions.len())?;
    let (inner, blocks) = (problem.now(), problem.blocks()?);
    let count = blocks.count();
    let slopes = gate::run_owned(py, move |cancel| {
        let mut stop = || cancel.load(Ordering::Relaxed);
        voxsoft_statics::block_slopes(&inner, &blocks, &positions, &gradients, memory, &mut stop)
    })?
    .map_err(to_python)?;
    let table = |pick: fn(&PerBlock) -> &Vec<f64>| {
        let flat: Vec<f64> = slopes.iter().flat_map(|each| pick(each).clone()).collect();
        PyArray1::from_vec(py, flat).reshape([slopes.len(), count])
    };
    Ok((table(|each| &each.stiffness)?, table(|each| &each.mass)?))
}

impl PyProblem {
    /// Parts that each block of the mesh brings to the body.
    fn blocks(&self) -> PyResult<Blocks> {
        let blocks = Blocks::of(self.now().body(), &self.mesh, &self.materials);
        blocks.map_err(crate::errors::to_python)
    }

    /// Copy of the problem with other fractions of its blocks.
    pub(crate) fn filled(&self, fractions: Arc<PerBlock>) -> PyResult<Self> {
        let problem = self.now().with_fractions(&self.blocks()?, &fractions);
        let problem = problem.map_err(crate::errors::to_python)?;
        Ok(Self {
            problem: Arc::new(Handle::new(problem)),
            fractions: Some(fractions),
            ..self.with(|_| ())
        })
    }
}
