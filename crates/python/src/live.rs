//! `_core.Live`: an interactive run that continues between calls.
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::PyBytes;
use voxsoft_contact::surface_contact::SurfaceContact;
use voxsoft_frames::FrameHead;
use voxsoft_player::{converging, stepper};
use voxsoft_solid::vector::{Vec3, norm, sub};
use voxsoft_solid::{Ask, Grab, Look, Method, Problem, State, Stepper};
use voxsoft_statics::{Motion, Side};
use voxsoft_xpbd::Dynamics;

use crate::answer::PyAdvance;
use crate::arrays::{from_rows, rows};
use crate::display::{PyDisplay, field as field_of};
use crate::errors::to_python;
use crate::gate;
use crate::handle::PyMemory;
use crate::inputs::{InputArgument, inputs_of};
use crate::player::dynamics;
use crate::simulate::PyProblem;

/// Interactive run of a problem. Any thread may call any method; calls are serialized.
#[pyclass(frozen, name = "Live", module = "voxsoft._core")]
pub struct PyLive {
    surface: PyDisplay,
    live: Mutex<Box<dyn Stepper>>,
}

impl PyLive {
    /// Locks in the calling thread, never in one of the pool: a pool thread could pick up another call of the same run
    /// while it waits in a loop, and would deadlock.
    fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Box<dyn Stepper>>> {
        let message = "an earlier call of this run panicked; please report it";
        self.live
            .lock_py_attached(py)
            .map_err(|_| PyRuntimeError::new_err(message))
    }

    /// Runs short work, without a check for Ctrl-C.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut dyn Stepper) -> T + Send,
    ) -> PyResult<T> {
        let mut guard = self.lock(py)?;
        let live = guard.as_mut();
        Ok(py.detach(|| work(live)))
    }

    /// Runs short work on a converged motion.
    fn with_motion<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Motion) -> T + Send,
    ) -> PyResult<T> {
        let found = self.with(py, |live| live.as_any().downcast_mut().map(work))?;
        let message = "only converged steps are differentiated";
        found.ok_or_else(|| PyValueError::new_err(message))
    }

    fn report(
        &self,
        py: Python<'_>,
        advance: impl Fn(&mut dyn Stepper, &mut dyn FnMut(Ask) -> bool) -> Look + Sync,
    ) -> PyResult<PyAdvance> {
        let started = Instant::now();
        let mut guard = self.lock(py)?;
        let live = guard.as_mut();
        let (look, taken) = gate::run(py, |cancel| {
            let mut taken = 0;
            let look = advance(live, &mut |ask| {
                if ask == Ask::After {
                    taken += 1;
                }
                !cancel.load(Ordering::Relaxed)
            });
            (look, taken)
        })?;
        drop(guard);
        PyAdvance::of(&look, taken, started.elapsed().as_secs_f64())
    }
}

/// A grab for Python: number, vertex, target in m, force in N, stretch in m.
type PyGrab = (u32, u32, Vec3, Vec3, f64);

#[pymethods]
impl PyLive {
    #[new]
    #[pyo3(signature = (problem, triangles, tags, voxel_size, *, time_step=0.01, substeps=None, iterations=1,
        damping=None, retardation=0.0, tolerance=1e-4, deterministic=false, converged=false,
        accuracy=f64::INFINITY, memory=u64::MAX))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn new(
        py: Python<'_>,
        problem: PyRef<'_, PyProblem>,
        triangles: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxel_size: f64,
        time_step: f64,
        substeps: Option<u32>,
        iterations: u32,
        damping: Option<f64>,
        retardation: f64,
        tolerance: f64,
        deterministic: bool,
        converged: bool,
        accuracy: f64,
        memory: u64,
    ) -> PyResult<Self> {
        let settings = Dynamics {
            time_step,
            iterations,
            deterministic,
            memory,
            ..dynamics(substeps, damping, retardation, tolerance)
        };
        let surface = PyDisplay::surface(problem, triangles, tags, voxel_size)?;
        let problem = surface.problem.now();
        let live = gate::run(py, |_| {
            let problem = Problem::clone(&problem);
            if converged {
                converging(problem, settings, accuracy)
            } else {
                Ok(stepper(problem, settings))
            }
        })?
        .map_err(|status| {
            let message = format!("the tangent of a step cannot be made: {}", status.name());
            PyMemoryError::new_err(message)
        })?;
        Ok(Self {
            surface,
            live: Mutex::new(live),
        })
    }

    #[getter]
    fn substep(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |live| live.step())
    }

    /// "explicit" or "implicit".
    #[getter]
    fn method(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.with(py, |live| match live.method() {
            Method::Explicit => "explicit",
            Method::Implicit => "implicit",
        })
    }

    /// Requests steps of another length in s; explicit steps ignore it, as stability sets them.
    fn prefer_step(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        if !(seconds > 0.0 && seconds.is_finite()) {
            let message = format!("seconds must be above zero, got {seconds}");
            return Err(PyValueError::new_err(message));
        }
        self.with(py, |live| live.prefer_step(seconds))
    }

    /// Adds a parameter by which a converged motion is differentiated from now on, with neighbors at `offset` from its
    /// value; returns its number.
    fn vary(&self, py: Python<'_>, offset: f64) -> PyResult<usize> {
        if !(offset > 0.0 && offset.is_finite()) {
            let message = format!("offset must be above zero, got {offset}");
            return Err(PyValueError::new_err(message));
        }
        self.with_motion(py, |motion| motion.vary::<SurfaceContact>(offset))
    }

    /// Forgets all parameters of derivatives.
    fn forget_variations(&self, py: Python<'_>) -> PyResult<()> {
        self.with_motion(py, Motion::forget_variations)
    }

    /// Commands the neighbor of a parameter above its value, or that below.
    fn command_variation(
        &self,
        py: Python<'_>,
        parameter: usize,
        above: bool,
        inputs: Vec<InputArgument>,
    ) -> PyResult<()> {
        let inputs = inputs_of(inputs)?;
        let side = if above { Side::Above } else { Side::Below };
        self.with_motion(py, |motion| {
            motion.command_variation(parameter, side, &inputs)
        })?
        .map_err(to_python)
    }

    /// Slopes of positions (m) and velocities (m/s) by a parameter, per unit of it.
    fn slopes<'py>(
        &self,
        py: Python<'py>,
        parameter: usize,
    ) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let slopes = self.with_motion(py, |motion| motion.slopes(parameter))?;
        let slopes = slopes.map_err(crate::equilibrium::to_python)?;
        Ok([&slopes.positions, &slopes.velocities].map(|rows| from_rows(py, rows)))
    }

    /// Takes `substeps` substeps, fewer at rest or after a breakdown.
    fn advance(&self, py: Python<'_>, substeps: u32) -> PyResult<PyAdvance> {
        self.report(py, |live, go_on| live.advance_while(substeps, go_on))
    }

    /// Takes substeps until a time in s, fewer at rest or after a breakdown.
    fn advance_to(&self, py: Python<'_>, time: f64) -> PyResult<PyAdvance> {
        self.report(py, |live, go_on| live.advance_to(time, go_on))
    }

    /// Takes substeps for `seconds` of wall-clock time, at least one and at most `max_substeps`.
    #[pyo3(signature = (seconds, max_substeps=u32::MAX))]
    fn advance_for(&self, py: Python<'_>, seconds: f64, max_substeps: u32) -> PyResult<PyAdvance> {
        let budget = Duration::try_from_secs_f64(seconds).map_err(|_| {
            PyValueError::new_err(format!("seconds must be zero or more, got {seconds}"))
        })?;
        let started = Instant::now();
        self.report(py, |live, go_on| {
            live.advance_while(max_substeps, &mut |ask| {
                let more = go_on(ask);
                more && (ask == Ask::Within || started.elapsed() < budget)
            })
        })
    }

    /// Sets a load to `factor` times its final value; `None` restores its load history.
    #[pyo3(signature = (load, factor))]
    fn set_load(&self, py: Python<'_>, load: usize, factor: Option<f64>) -> PyResult<()> {
        self.with(py, |live| live.set_load(load, factor))?
            .map_err(to_python)
    }

    /// Replaces the courses of inputs over time: times in s and values, constant outside of them.
    fn command(&self, py: Python<'_>, inputs: Vec<InputArgument>) -> PyResult<()> {
        let inputs = inputs_of(inputs)?;
        self.with(py, |live| live.command(&inputs))?
            .map_err(to_python)
    }

    fn grab(
        &self,
        py: Python<'_>,
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> PyResult<()> {
        self.with(py, |live| live.grab(number, vertex, target, stiffness))?
            .map_err(to_python)
    }

    fn release(&self, py: Python<'_>, number: u32) -> PyResult<bool> {
        self.with(py, |live| live.release(number))
    }

    fn grabs(&self, py: Python<'_>) -> PyResult<Vec<PyGrab>> {
        self.with(py, |live| {
            let positions = &live.state().positions;
            let one = |(number, grab): &(u32, Grab)| {
                let position = positions[grab.vertex as usize];
                let stretch = norm(sub(grab.anchor, position));
                let force = grab.force(position);
                (*number, grab.vertex, grab.target, force, stretch)
            };
            live.grabs().iter().map(one).collect()
        })
    }

    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |live| live.reset())
    }

    #[pyo3(signature = (positions, time=0.0))]
    fn seek(
        &self,
        py: Python<'_>,
        positions: PyReadonlyArray2<'_, f64>,
        time: f64,
    ) -> PyResult<()> {
        let positions = rows("positions", &positions)?;
        self.with(py, |live| live.seek(positions, time))?
            .map_err(to_python)
    }

    /// Goes on from a state with the memory that the problem had there.
    fn resume(
        &self,
        py: Python<'_>,
        positions: PyReadonlyArray2<'_, f64>,
        velocities: PyReadonlyArray2<'_, f64>,
        time: f64,
        memory: PyRef<'_, PyMemory>,
    ) -> PyResult<()> {
        let state = State {
            positions: rows("positions", &positions)?,
            velocities: rows("velocities", &velocities)?,
            time,
        };
        let memory = memory.0.clone();
        self.with(py, |live| live.resume(state, &memory))?
            .map_err(to_python)
    }

    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.with(py, |live| live.state().positions.clone())?;
        Ok(from_rows(py, &positions))
    }

    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let velocities = self.with(py, |live| live.state().velocities.clone())?;
        Ok(from_rows(py, &velocities))
    }

    /// Memory at the last state: all data that depend on the load path.
    fn memory(&self, py: Python<'_>) -> PyResult<PyMemory> {
        self.with(py, |live| PyMemory(live.memory()))
    }

    /// Displayed vertices of the body, in ascending order.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.surface.vertices(py)
    }

    fn pack_topology<'py>(&self, py: Python<'py>, topology: u32) -> Bound<'py, PyBytes> {
        self.surface.pack_topology(py, topology)
    }

    /// Packs a frame of the present state on the surface, or on another display of the same problem.
    #[pyo3(signature = (topology, frame, field, seq=0, flags=0, display=None))]
    #[expect(clippy::too_many_arguments, reason = "a frame's head")]
    fn pack_frame<'py>(
        &self,
        py: Python<'py>,
        topology: u32,
        frame: u32,
        field: u16,
        seq: u32,
        flags: u8,
        display: Option<PyRef<'_, PyDisplay>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let shown = display.as_deref().unwrap_or(&self.surface);
        if !Arc::ptr_eq(&shown.problem, &self.surface.problem) {
            let message = "display: it belongs to another problem";
            return Err(PyValueError::new_err(message));
        }
        let field = field_of(field)?;
        let head = FrameHead {
            topology,
            frame,
            seq,
            flags,
        };
        // Copies the state, so that the run can go on meanwhile.
        let state = self.with(py, |live| live.state().clone())?;
        let problem = shown.problem.now();
        let body = problem.body();
        let bytes = py.detach(|| shown.display.frame(body, &state, field, head));
        Ok(PyBytes::new(py, &bytes))
    }
}
