//! `_core.transient`: motion over time with contact, on a `_core.Problem`.
use std::sync::{Arc, Mutex};

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use voxsoft_contact::surface_contact::PairReport;
use voxsoft_solid::vector::{Vec3, axpy, dot};
use voxsoft_solid::{Damping, Progress, State, elastic};
use voxsoft_statics::Transient;
use voxsoft_xpbd::Answer;

use crate::answer::PyAnswer;
use crate::contact_answer::PyTouchHistory;
use crate::gate;
use crate::simulate::PyProblem;
use crate::surface_contact::contact_of;
use crate::watch::{Watch, collect_sensors};

/// Solves for the motion by implicit steps of `step` seconds, to `end_time` or to rest. Without a rate (1/s), `damping`
/// is critical.
#[pyfunction]
#[pyo3(signature = (problem, *, step, damping, end_time, max_time, tolerance, retardation=0.0, record_interval=None, memory=u64::MAX, sensors=vec![], frames=false, progress=None))]
#[expect(
    clippy::too_many_arguments,
    reason = "keyword arguments of one Python call"
)]
pub fn transient(
    problem: PyRef<'_, PyProblem>,
    py: Python<'_>,
    step: f64,
    damping: Option<f64>,
    end_time: Option<f64>,
    max_time: f64,
    tolerance: f64,
    retardation: f64,
    record_interval: Option<f64>,
    memory: u64,
    sensors: Vec<(PyReadonlyArray1<'_, u32>, PyReadonlyArray1<'_, f64>)>,
    frames: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyAnswer> {
    let settings = Transient {
        step,
        damping: damping.map_or(Damping::Critical, Damping::Rate),
        retardation,
        tolerance,
        accuracy: f64::INFINITY,
        end_time,
        max_time,
        record_interval,
        memory,
        ..Transient::default()
    };
    let inner = problem.now();
    let touching = problem.touching.as_ref().map(Arc::clone);
    let mut watch = Watch::new(progress, collect_sensors(&sensors), frames);
    let seen: Mutex<Seen> = Mutex::default();
    let (solution, watch, seen) = gate::run_owned(py, move |cancel| {
        let mut see = |now: &Progress<'_>| {
            if let Some(touching) = touching.as_ref().filter(|_| now.record) {
                let positions = touching.seen(now.positions);
                let mut seen = seen.lock().expect("no holder of the lock panics");
                // Contact has no forces yet before the first step.
                let started = now.steps > 0;
                let touch = contact_of(now.problem).filter(|_| started);
                let pairs = touch.map(|touch| touch.pairs(&positions));
                seen.pairs.push(pairs.unwrap_or_default());
                seen.frames.push(positions[touching.own()..].to_vec());
                seen.motion.push(Motion::of(now));
            }
            watch.see(now, cancel)
        };
        let start = State::at_rest(inner.body());
        let solution = settings.follow(&inner, start, &mut see);
        (solution, watch, seen)
    })?;
    let seen = seen.into_inner().expect("no holder of the lock panics");
    let history = seen.into_python(py, &problem)?;
    let time = solution.state.time;
    let there = problem.with(|problem| {
        problem.remember(&solution.memory);
        problem.begin(time);
    });
    let answer = Answer {
        state: solution.state,
        status: solution.status,
        residual: solution.residual,
        steps: solution.steps,
        back_offs: solution.back_offs,
        substep: step,
        breakdown: solution.breakdown,
    };
    let found = there.answer(py, answer, watch, &|load| load.history.at(time))?;
    Ok(PyAnswer { history, ..found })
}

/// Contact, objects and energies at every record.
#[derive(Default)]
struct Seen {
    pairs: Vec<Vec<PairReport>>,
    /// Positions of the vertices of all objects.
    frames: Vec<Vec<Vec3>>,
    motion: Vec<Motion>,
}

/// Energies in J and momentum in kg m/s of body and objects.
struct Motion {
    /// Elastic energy without the energy of contact.
    elastic: f64,
    kinetic: f64,
    /// Potential of the loads as they are at that time.
    loads: f64,
    momentum: Vec3,
}

impl Motion {
    fn of(now: &Progress<'_>) -> Self {
        let problem = now.problem;
        let stored = elastic::stored_energy(problem.body(), now.positions);
        let touching = problem
            .contact()
            .map_or(0.0, |contact| contact.energy(now.positions));
        let (mut kinetic, mut momentum) = (0.0, [0.0; 3]);
        for (v, mass) in now.velocities.iter().zip(problem.body().masses()) {
            kinetic += 0.5 * mass * dot(*v, *v);
            axpy(&mut momentum, *mass, *v);
        }
        Self {
            elastic: stored - touching,
            kinetic,
            loads: problem.stored_load_potential(now.positions, &|load| load.history.at(now.time)),
            momentum,
        }
    }
}

impl Seen {
    fn into_python(
        self,
        py: Python<'_>,
        problem: &PyProblem,
    ) -> PyResult<Option<Py<PyTouchHistory>>> {
        let Some(touching) = &problem.touching else {
            return Ok(None);
        };
        let contacts = self
            .pairs
            .into_iter()
            .map(|pairs| crate::contact_answer::to_python(py, pairs));
        let objects = self.frames.iter().map(|frames| touching.poses(py, frames));
        let history = PyTouchHistory {
            contacts: contacts.collect::<PyResult<_>>()?,
            objects: objects.collect::<PyResult<_>>()?,
            elastic: self.motion.iter().map(|now| now.elastic).collect(),
            kinetic: self.motion.iter().map(|now| now.kinetic).collect(),
            loads: self.motion.iter().map(|now| now.loads).collect(),
            momentum: self.motion.iter().map(|now| now.momentum).collect(),
        };
        Ok(Some(Py::new(py, history)?))
    }
}
