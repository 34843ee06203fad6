//! `_core.sensitivities`: derivatives along a load path with contact.
use std::sync::Arc;
use std::sync::atomic::Ordering;

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_contact::touch::Touch;
use voxsoft_solid::{Problem, RecordedContact};
use voxsoft_statics::Varied;

use crate::equilibrium::to_python;
use crate::gate;
use crate::simulate::{PyProblem, from_rows};
use crate::touch_answer::PyContact;

/// The next load path of a problem is recorded, for `sensitivities`.
#[pyfunction]
pub fn record_contact(problem: PyRef<'_, PyProblem>) -> PyResult<()> {
    problem.touch()?.record();
    Ok(())
}

/// Of the steps that were recorded: whether contact settled as precisely as was asked for, and the largest part of the
/// pressure with friction under which something slipped, and on what came into contact after the first of them.
#[pyfunction]
pub fn recorded_contact(problem: PyRef<'_, PyProblem>) -> PyResult<(bool, f64, f64)> {
    let touch = problem.touch()?;
    Ok((
        touch.recorded_precisely(),
        touch.recorded_slip(),
        touch.recorded_touching_later(),
    ))
}

/// Whether the contact of two problems is of the same surfaces, wherever they are.
#[pyfunction]
pub fn same_surfaces(problem: PyRef<'_, PyProblem>, other: PyRef<'_, PyProblem>) -> PyResult<bool> {
    let vertices = |problem: &PyProblem| problem.now().body().rest().len();
    let same = problem.touch()?.has_surfaces_of(other.touch()?);
    Ok(same && vertices(&problem) == vertices(&other))
}

/// What touches at some positions, with the multipliers that contact holds.
#[pyfunction]
pub fn contacts_at(
    problem: PyRef<'_, PyProblem>,
    py: Python<'_>,
    positions: PyReadonlyArray2<'_, f64>,
) -> PyResult<Vec<Py<PyContact>>> {
    let positions = problem.positions(&positions)?;
    let touching = problem.touching.as_ref();
    touching.map_or(Ok(Vec::new()), |touching| touching.contacts(py, &positions))
}

impl PyProblem {
    fn touch(&self) -> PyResult<&Arc<Touch>> {
        let nothing = || PyValueError::new_err("nothing touches in this problem");
        let touching = self.touching.as_ref().ok_or_else(nothing)?;
        Ok(&touching.touch)
    }
}

/// A problem, by how much the value of its parameter is off, and its weight in the derivative.
type PyVaried<'py> = (PyRef<'py, PyProblem>, f64, f64);

/// Where the body is (m) in varied problems at the end of the path that a problem has recorded, to the first order: for
/// each parameter, for each of its varied problems. `factors` are the load factors of the steps.
#[pyfunction]
#[pyo3(signature = (problem, factors, varied, *, memory=u64::MAX))]
pub fn sensitivities<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
    factors: Vec<f64>,
    varied: Vec<Vec<PyVaried<'py>>>,
    memory: u64,
) -> PyResult<Vec<Vec<Bound<'py, PyArray2<f64>>>>> {
    let own = problem.own();
    let touch = Arc::clone(problem.touch()?);
    let inner = problem.now();
    let mut parameters: Vec<Vec<Shared>> = Vec::new();
    for parameter in &varied {
        let shared = parameter.iter().map(|(problem, offset, weight)| {
            Ok(Shared {
                problem: problem.now(),
                touch: Arc::clone(problem.touch()?),
                offset: *offset,
                weight: *weight,
            })
        });
        parameters.push(shared.collect::<PyResult<_>>()?);
    }
    let turn = problem.turns.take(py)?;
    let ends = gate::run_owned(py, move |cancel| {
        let _turn = turn;
        let mut stop = || cancel.load(Ordering::Relaxed);
        let moments = touch.take_recorded();
        let borrowed: Vec<Vec<Varied<'_, Touch>>> = parameters
            .iter()
            .map(|parameter| parameter.iter().map(Shared::varied).collect())
            .collect();
        voxsoft_statics::sensitivities(
            &inner, &*touch, &moments, &factors, &borrowed, memory, &mut stop,
        )
    })?
    .map_err(to_python)?;
    let arrays = |parameter: &Vec<Vec<_>>| {
        let each = parameter.iter().map(|end| from_rows(py, &end[..own]));
        each.collect()
    };
    Ok(ends.iter().map(arrays).collect())
}

struct Shared {
    problem: Arc<Problem>,
    touch: Arc<Touch>,
    offset: f64,
    weight: f64,
}

impl Shared {
    fn varied(&self) -> Varied<'_, Touch> {
        Varied {
            problem: &self.problem,
            contact: &self.touch,
            offset: self.offset,
            weight: self.weight,
        }
    }
}
