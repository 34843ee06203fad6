//! `_core.equilibrium` and `_core.adjoint`: the statics solver on a `_core.Problem`.
use std::sync::Arc;
use std::sync::atomic::Ordering;

use numpy::{
    PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::exceptions::{PyArithmeticError, PyMemoryError, PyValueError};
use pyo3::prelude::*;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Progress, State};
use voxsoft_statics::{AdjointError, Control, LinearSolver, Settings, Start};
use voxsoft_xpbd::{Answer, Status};

use crate::answer::{PyAnswer, PyPath};
use crate::arrays::from_rows;
use crate::gate;
use crate::simulate::PyProblem;
use crate::watch::{Watch, collect_sensors};

/// Adjoint states (k, n, 3) for gradients (k, n, 3) of scalar objectives at an equilibrium, over the vertices of the
/// body without those that carry objects. `memory` is the limit in bytes for the tangent; a `MemoryError` carries the
/// bytes needed.
#[pyfunction]
#[pyo3(signature = (problem, positions, gradients, *, memory=u64::MAX))]
pub fn adjoint<'py>(
    problem: PyRef<'py, PyProblem>,
    py: Python<'py>,
    positions: PyReadonlyArray2<'_, f64>,
    gradients: PyReadonlyArray3<'_, f64>,
    memory: u64,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let (positions, own) = (problem.positions(&positions)?, problem.own());
    let gradients = gradients_of(&gradients, own, positions.len())?;
    let inner = problem.now();
    let states = gate::run_owned(py, move |cancel| {
        let mut stop = || cancel.load(Ordering::Relaxed);
        voxsoft_statics::adjoint(&inner, &positions, &gradients, memory, &mut stop)
    })?
    .map_err(to_python)?;
    let of_body = states.iter().flat_map(|state| &state[..own]);
    let flat: Vec<f64> = of_body.flatten().copied().collect();
    PyArray1::from_vec(py, flat).reshape([states.len(), own, 3])
}

/// Gradients (k, n, 3) by the positions of the `own` vertices of a body, zero on the others of `all`.
pub(crate) fn gradients_of(
    gradients: &PyReadonlyArray3<'_, f64>,
    own: usize,
    all: usize,
) -> PyResult<Vec<Vec<Vec3>>> {
    let view = gradients.as_array();
    if view.shape()[1..] != [own, 3] {
        let message = format!(
            "gradients: shape {:?}, expected (k, {own}, 3)",
            view.shape()
        );
        return Err(PyValueError::new_err(message));
    }
    let each = |gradient: numpy::ndarray::ArrayView2<'_, f64>| {
        let row = |r: numpy::ndarray::ArrayView1<'_, f64>| [r[0], r[1], r[2]];
        let mut rows: Vec<Vec3> = gradient.rows().into_iter().map(row).collect();
        rows.resize(all, [0.0; 3]);
        rows
    };
    Ok(view.outer_iter().map(each).collect())
}

/// Maps an error of an adjoint solution to Python; a `MemoryError` carries the bytes needed.
pub(crate) fn to_python(error: AdjointError) -> PyErr {
    match error {
        AdjointError::OutOfMemory(bytes) => PyMemoryError::new_err(bytes),
        AdjointError::Singular | AdjointError::Unsettled | AdjointError::Cancelled => {
            PyArithmeticError::new_err(error.to_string())
        }
    }
}

/// Solves for the equilibrium. `control` is "load", "time" or "creep" (with `from_time`, `to_time`, `longest`),
/// "arc-length" (with `steps`) or "volume" (with `steps`, `ratio`); `start` are initial positions, and `pressures` replace the pressures
/// of the voxels there, see `Problem.pressures`; `linear` is "auto", "direct" or "iterative", `memory` the limit in
/// bytes for the tangent.
#[pyfunction]
#[pyo3(signature = (problem, *, tolerance, first_step=1.0, control="load", steps=20, ratio=1.0, from_time=None, to_time=f64::INFINITY, longest=1.0, linear="auto", memory=u64::MAX, start=None, pressures=None, sensors=vec![], frames=false, progress=None))]
#[expect(
    clippy::too_many_arguments,
    reason = "keyword arguments of one Python call"
)]
pub fn equilibrium(
    problem: PyRef<'_, PyProblem>,
    py: Python<'_>,
    tolerance: f64,
    first_step: f64,
    control: &str,
    steps: u32,
    ratio: f64,
    from_time: Option<f64>,
    to_time: f64,
    longest: f64,
    linear: &str,
    memory: u64,
    start: Option<PyReadonlyArray2<'_, f64>>,
    pressures: Option<PyReadonlyArray1<'_, f64>>,
    sensors: Vec<(PyReadonlyArray1<'_, u32>, PyReadonlyArray1<'_, f64>)>,
    frames: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyAnswer> {
    let inner = problem.now();
    let control = match control {
        "load" => Control::Load,
        "time" => Control::Time {
            from: from_time,
            to: to_time,
            longest,
        },
        "creep" => Control::Creep {
            from: from_time,
            to: to_time,
            longest,
        },
        "arc-length" => Control::ArcLength { steps },
        "volume" => Control::Volume { ratio, steps },
        other => {
            let message =
                format!("control: \"{other}\" is not load, time, creep, arc-length or volume");
            return Err(PyValueError::new_err(message));
        }
    };
    let linear = LinearSolver::named(linear).ok_or_else(|| {
        let names: Vec<&str> = LinearSolver::NAMES.iter().map(|named| named.0).collect();
        let message = format!("linear: \"{linear}\" is not one of {}", names.join(", "));
        PyValueError::new_err(message)
    })?;
    let settings = Settings {
        tolerance,
        first_step,
        control,
        linear,
        memory,
        ..Settings::default()
    };
    let pressures = pressures.map(|found| problem.hex8_pressures(&found));
    let pressures = pressures.transpose()?;
    let positions = start.map(|start| problem.positions(&start)).transpose()?;
    let start = positions.map(|positions| Start {
        positions,
        pressures,
    });
    let watch = Watch::new(progress, collect_sensors(&sensors), frames);
    let mut watch = watch.of_loads();
    let problem_of_work = Arc::clone(&inner);
    let (answer, watch) = gate::run_owned(py, move |cancel| {
        let mut see = |now: &Progress<'_>| watch.see(now, cancel);
        let answer = voxsoft_statics::solve(&problem_of_work, start.as_ref(), &settings, &mut see);
        (answer, watch)
    })?;
    let creeps = matches!(settings.control, Control::Creep { .. });
    let there = problem.with(|problem| {
        problem.remember(&answer.memory);
        if creeps {
            problem.hold_creep();
        }
    });
    let stable = answer.stable;
    let (factor, reached, limit) = (answer.factor, answer.reached, answer.limit);
    let path: Vec<[f64; 4]> = answer
        .path
        .iter()
        .map(|p| {
            [
                p.factor,
                f64::from(p.iterations),
                p.residual,
                f64::from(u8::from(p.stable)),
            ]
        })
        .collect();
    let mut state = State::at_rest(inner.body());
    state.positions.clone_from(&answer.positions);
    let common = Answer {
        state,
        status: answer.status,
        residual: answer.residual,
        steps: u64::from(answer.iterations),
        back_offs: answer.back_offs,
        substep: 0.0,
        breakdown: None,
    };
    let factor_of = |load: &Load| answer.factor_of(load);
    let needed_bytes = match answer.status {
        Status::OutOfMemory(bytes) => bytes,
        Status::AtRest
        | Status::EndTime
        | Status::Slow
        | Status::NotAtRest
        | Status::Diverged
        | Status::LimitReached
        | Status::NotConverged
        | Status::Mechanism
        | Status::Cancelled => 0,
    };
    let path = PyPath {
        factor,
        reached,
        limit,
        stable,
        needed_bytes,
        snaps: answer.snaps.clone(),
        points: from_rows(py, &path).unbind(),
    };
    let path = Some(Py::new(py, path)?);
    let found = there.answer(py, common, watch, &factor_of)?;
    Ok(PyAnswer { path, ..found })
}
