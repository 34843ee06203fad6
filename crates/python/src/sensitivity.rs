//! `_core.sensitivities`: derivatives along a load path with contact.
use std::sync::atomic::Ordering;

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_contact::surface_contact::SurfaceContact;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, RecordedContact};
use voxsoft_statics::Varied;

use crate::arrays::from_rows;
use crate::contact_answer::PyContact;
use crate::equilibrium::to_python;
use crate::gate;
use crate::simulate::PyProblem;
use crate::surface_contact::contact_of;

/// Copy of a problem that records its load path for `sensitivities`.
#[pyfunction]
pub fn recording(problem: PyRef<'_, PyProblem>) -> PyResult<PyProblem> {
    problem.look_at_contact(|_| ())?;
    Ok(problem.with(|problem| {
        if let Some(touch) = contact_mut(problem) {
            touch.record();
        }
    }))
}

/// Contact over the recorded steps: true if it always converged to the requested precision; the largest part of the
/// pressure with friction under which surfaces slipped; and the largest part on points that came into contact after the
/// first step.
#[pyfunction]
pub fn recorded_contact(problem: PyRef<'_, PyProblem>) -> PyResult<(bool, f64, f64)> {
    problem.look_at_contact(|touch| {
        (
            touch.recorded_precisely(),
            touch.recorded_slip(),
            touch.recorded_touching_later(),
        )
    })
}

/// True if the contact surfaces of two problems have the same topology, at any positions.
#[pyfunction]
pub fn same_surfaces(problem: PyRef<'_, PyProblem>, other: PyRef<'_, PyProblem>) -> PyResult<bool> {
    let vertices = |problem: &PyProblem| problem.now().body().rest().len();
    let same = problem
        .look_at_contact(|touch| other.look_at_contact(|other| touch.has_surfaces_of(other)))??;
    Ok(same && vertices(&problem) == vertices(&other))
}

/// Contacts at given positions, with the present multipliers of contact.
#[pyfunction]
pub fn contacts_at(
    problem: PyRef<'_, PyProblem>,
    py: Python<'_>,
    positions: PyReadonlyArray2<'_, f64>,
) -> PyResult<Vec<Py<PyContact>>> {
    let positions = problem.positions(&positions)?;
    let touching = problem.touching.as_ref();
    touching.map_or(Ok(Vec::new()), |touching| {
        touching.contacts(py, &problem.now(), &positions)
    })
}

impl PyProblem {
    fn look_at_contact<T>(&self, look: impl FnOnce(&SurfaceContact) -> T) -> PyResult<T> {
        let nothing = || PyValueError::new_err("nothing touches in this problem");
        contact_of(&self.now()).map(look).ok_or_else(nothing)
    }
}

pub(crate) fn contact_mut(problem: &mut Problem) -> Option<&mut SurfaceContact> {
    problem.contact_mut()?.found_by_mut().downcast_mut()
}

/// A varied problem, the offset of its parameter, and its weight in the derivative.
type PyVaried<'py> = (PyRef<'py, PyProblem>, f64, f64);

/// Positions (m) at the end of a path, and the problem with its memory there.
type PyEnd<'py> = (Bound<'py, PyArray2<f64>>, PyProblem);

/// First-order positions (m) of the body in varied problems at the end of the recorded load path of a problem, each
/// with the problem there: for each parameter, for each of its varied problems. `factors` are the load factors of the
/// steps.
#[pyfunction]
#[pyo3(signature = (problem, factors, varied, *, memory=u64::MAX))]
pub fn sensitivities<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
    factors: Vec<f64>,
    varied: Vec<Vec<PyVaried<'py>>>,
    memory: u64,
) -> PyResult<Vec<Vec<PyEnd<'py>>>> {
    let own = problem.own();
    problem.look_at_contact(|_| ())?;
    let mut inner = Problem::clone(&problem.now());
    let moments = contact_mut(&mut inner).map_or_else(Vec::new, |touch| touch.take_recorded());
    let mut parameters: Vec<Vec<Varied>> = Vec::new();
    for parameter in &varied {
        let shared = parameter.iter().map(|(problem, offset, weight)| {
            problem.look_at_contact(|_| ())?;
            Ok(Varied {
                problem: Problem::clone(&problem.now()),
                offset: *offset,
                weight: *weight,
            })
        });
        parameters.push(shared.collect::<PyResult<_>>()?);
    }
    let (ends, parameters) = gate::run_owned(py, move |cancel| {
        let mut stop = || cancel.load(Ordering::Relaxed);
        let ends = voxsoft_statics::sensitivities::<SurfaceContact>(
            &inner,
            &moments,
            &factors,
            &mut parameters,
            memory,
            &mut stop,
        );
        (ends, parameters)
    })?;
    let ends = ends.map_err(to_python)?;
    let mut found = parameters.iter().flatten();
    let pairs = ends.iter().zip(&varied).map(|(ends, varied)| {
        let pair = |(end, (problem, ..)): (&Vec<Vec3>, &PyVaried<'py>)| {
            let memory = found.next().map(|found| found.problem.memory());
            let there = problem.with(|problem| {
                memory.iter().for_each(|memory| problem.remember(memory));
            });
            (from_rows(py, &end[..own]), there)
        };
        ends.iter().zip(varied).map(pair).collect()
    });
    Ok(pairs.collect())
}
