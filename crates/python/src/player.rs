//! `_core.Scene` and `_core.Player`: interactive play of a problem, in this process or in a page.
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Instant;

use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::{IntoPyDict, PyBytes, PyTuple};
use serde::Serialize;
use serde_json::to_vec;
use voxsoft_frames::{
    Display, Field, FieldName, HEADER, MAGIC, MessageKind, TopologyFlag, frame_flag, name_of,
};
use voxsoft_player::{
    COLUMNS, Cast, Clock, Command, Control, Event, FRAME_TIME, Mode, PACES, Player, Probe, Refusal,
    Rest, STIFFNESS,
};
use voxsoft_scene::Scene;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, ProblemError};
use voxsoft_xpbd::{Damping, Dynamics};

use crate::arrays::{from_rows, of_vertices, rows};
use crate::display::{PyDisplay, field as field_of};
use crate::errors::to_python;
use crate::gate;
use crate::handle::Handle;
use crate::simulate::PyProblem;

/// Settings of live dynamics.
pub(crate) fn dynamics(
    substeps: Option<u32>,
    damping: Option<f64>,
    retardation: f64,
    tolerance: f64,
) -> Dynamics {
    Dynamics {
        substeps,
        damping: damping.map_or(Damping::Critical, Damping::Rate),
        retardation,
        tolerance,
        ..Dynamics::default()
    }
}

/// Wall clock since `began`, canceled by Ctrl-C.
struct Wall<'a> {
    began: Instant,
    cancel: &'a AtomicBool,
}

impl Clock for Wall<'_> {
    fn now(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    fn canceled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// A problem with its display, controls and settings, for play here or in a page that opens its bytes.
#[pyclass(frozen, name = "Scene", module = "voxsoft._core")]
pub struct PyScene {
    problem: Arc<Handle>,
    /// Number of vertices of its body, without those of objects.
    own: usize,
    scene: Scene,
}

#[pymethods]
impl PyScene {
    /// Makes a scene. For a problem with contact, `surfaces` are the names of all surfaces and `middles` the centers
    /// (m) of the boxes of the drawn objects.
    #[new]
    #[pyo3(signature = (problem, triangles, tags, voxel_size, *, topology=1, controls=vec![], probes=vec![],
        substeps=None, damping=None, retardation=0.0, tolerance=1e-4, surfaces=vec![], middles=vec![], memory=u64::MAX))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn new(
        problem: PyRef<'_, PyProblem>,
        triangles: PyReadonlyArray2<'_, u32>,
        tags: PyReadonlyArray1<'_, u8>,
        voxel_size: f64,
        topology: u32,
        controls: Vec<(f64, Vec<u32>)>,
        probes: Vec<(String, Vec<u32>, Vec<f64>)>,
        substeps: Option<u32>,
        damping: Option<f64>,
        retardation: f64,
        tolerance: f64,
        surfaces: Vec<String>,
        middles: Vec<Vec3>,
        memory: u64,
    ) -> PyResult<Self> {
        let control = |(value, loads)| Control { value, loads };
        let probe = |(name, vertices, weights)| Probe {
            name,
            vertices,
            weights,
        };
        let touching = problem.touching.as_ref();
        let mechanics = problem.now();
        let scene = Scene {
            notes: String::new(),
            mesh: (*problem.mesh).clone(),
            materials: problem.materials.to_vec(),
            clamps: mechanics.clamps().to_vec(),
            loads: mechanics.loads().to_vec(),
            floor: mechanics.floor(),
            touching: touching.map(|t| t.to_play(mechanics.body(), surfaces, &middles)),
            positions: None,
            triangles: rows("triangles", &triangles)?,
            tags: tags.as_array().to_vec(),
            voxel_size,
            settings: Dynamics {
                memory,
                ..dynamics(substeps, damping, retardation, tolerance)
            },
            cast: Cast {
                topology,
                controls: controls.into_iter().map(control).collect(),
                probes: probes.into_iter().map(probe).collect(),
            },
        };
        Ok(Self {
            problem: Arc::clone(&problem.problem),
            own: problem.own(),
            scene,
        })
    }

    /// Packs the bytes that a page opens; the page first shows `positions` (m) if they are given.
    #[pyo3(signature = (notes="", positions=None))]
    fn pack<'py>(
        &self,
        py: Python<'py>,
        notes: &str,
        positions: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let positions = positions.map(|array| of_vertices("positions", &array, self.own));
        let scene = Scene {
            notes: notes.to_owned(),
            positions: positions.transpose()?,
            ..self.scene.clone()
        };
        Ok(PyBytes::new(py, &py.detach(|| scene.write())))
    }

    /// Makes a player at the rest pose and time zero.
    #[pyo3(signature = (*, deterministic=false))]
    fn play(&self, py: Python<'_>, deterministic: bool) -> PyResult<PyPlayer> {
        let (problem, scene) = (&self.problem, &self.scene);
        let player = gate::run(py, |_| {
            if scene.touching.is_some() {
                // The player needs a contact of its own: the problem's may be solved at the same time.
                return scene.play(deterministic);
            }
            let (triangles, tags) = (&scene.triangles, &scene.tags);
            let settings = Dynamics {
                deterministic,
                ..scene.settings.clone()
            };
            let problem = Problem::clone(&problem.now());
            let surface = Display::surface(problem.body(), triangles, tags, scene.voxel_size)?;
            Ok::<_, ProblemError>(Player::new(problem, settings, surface, scene.cast.clone()))
        })?;
        Ok(PyPlayer {
            problem: Arc::clone(problem),
            own: self.own,
            player: Mutex::new(player.map_err(to_python)?),
            began: Instant::now(),
        })
    }
}

/// Player of a live problem; commands and events are JSON. Any thread may call any method; calls are serialized.
#[pyclass(frozen, name = "Player", module = "voxsoft._core")]
pub struct PyPlayer {
    problem: Arc<Handle>,
    /// Number of vertices of its body, without those of objects.
    own: usize,
    player: Mutex<Player>,
    began: Instant,
}

impl PyPlayer {
    /// Locks in the calling thread, never in one of the pool: a pool thread could pick up another call of the same
    /// player while it waits in a loop, and would deadlock.
    fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Player>> {
        let message = "an earlier call of this player panicked; please report it";
        let guard = self.player.lock_py_attached(py);
        guard.map_err(|_| PyRuntimeError::new_err(message))
    }

    /// Runs short work, without a check for Ctrl-C.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Player) -> T + Send,
    ) -> PyResult<T> {
        let mut guard = self.lock(py)?;
        let player = &mut *guard;
        Ok(py.detach(|| work(player)))
    }
}

fn refused(refusal: Refusal) -> PyErr {
    PyValueError::new_err((refusal.place, refusal.what, refusal.hint))
}

/// Serializes `value` to JSON.
fn json<'py>(py: Python<'py>, value: &impl Serialize) -> Bound<'py, PyBytes> {
    let json = to_vec(value).expect("events have names and numbers alone");
    PyBytes::new(py, &json)
}

#[pymethods]
impl PyPlayer {
    /// Executes a command and returns the events. A refusal is a `ValueError` of place, message and hint.
    fn command<'py>(&self, py: Python<'py>, command: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let command: Command = serde_json::from_slice(command)
            .map_err(|error| PyValueError::new_err(("command", error.to_string(), "")))?;
        let mut guard = self.lock(py)?;
        let player = &mut *guard;
        let events = gate::run(py, |_| player.command(command))?;
        Ok(json(py, &events.map_err(refused)?))
    }

    /// Advances by `seconds` of wall-clock time at the pace, within a wall-clock `budget` (s); returns the events.
    fn advance<'py>(
        &self,
        py: Python<'py>,
        seconds: f64,
        budget: f64,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let mut guard = self.lock(py)?;
        let (player, began) = (&mut *guard, self.began);
        let events = gate::run(py, |cancel| {
            player.advance(seconds, budget, &Wall { began, cancel })
        })?;
        Ok(json(py, &events))
    }

    /// Takes the final positions (m) of a solver, at a time (s) or now; returns the events. `poses` has the center (m)
    /// and the rotation of each object, row by row.
    #[pyo3(signature = (positions, state, sentence, residual, elastic, time=None, poses=vec![]))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn go_to_rest<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        state: &str,
        sentence: String,
        residual: f64,
        elastic: f64,
        time: Option<f64>,
        poses: Vec<(Vec3, [Vec3; 3])>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let rest = Rest {
            positions: rows("positions", &positions)?,
            poses,
            mode: match state {
                "at-rest" => Mode::AtRest,
                "diverged" => Mode::Diverged,
                _ => Mode::Paused,
            },
            sentence,
            residual,
            elastic,
            time,
        };
        let events = self.with(py, |player| player.go_to_rest(rest))?;
        Ok(json(py, &events.map_err(to_python)?))
    }

    /// Takes the motion found by a solver, (f, n, 3) positions (m) at f times (s), as recorded frames to seek.
    fn take_motion(
        &self,
        py: Python<'_>,
        times: PyReadonlyArray1<'_, f64>,
        positions: PyReadonlyArray3<'_, f64>,
    ) -> PyResult<()> {
        let (times, frames) = (times.as_array(), positions.as_array());
        if frames.shape()[0] != times.len() || frames.shape()[2] != 3 {
            let message = format!("positions: {:?} at {} times", frames.shape(), times.len());
            return Err(PyValueError::new_err(message));
        }
        let row = |row: ArrayView1<'_, f64>| [row[0], row[1], row[2]];
        let of_frame = |frame: ArrayView2<'_, f64>| frame.outer_iter().map(row).collect();
        let pairs = times.iter().copied().zip(frames.outer_iter().map(of_frame));
        let motion: Vec<(f64, Vec<Vec3>)> = pairs.collect();
        let taken = self.with(py, |player| player.take_motion(motion))?;
        taken.map_err(to_python)
    }

    /// Pauses with a sentence for the reason: a load or a grab lets time run again if play was requested.
    #[pyo3(signature = (sentence=""))]
    fn hold(&self, py: Python<'_>, sentence: &str) -> PyResult<()> {
        self.with(py, |player| player.hold(sentence.to_owned()))
    }

    /// Plays on at once, when this body replaces another one that was playing.
    fn resume(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, Player::resume)
    }

    /// Stops until the next play command, with a sentence for the reason.
    fn halt(&self, py: Python<'_>, sentence: String) -> PyResult<()> {
        self.with(py, |player| player.halt(sentence))
    }

    #[getter]
    fn state(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.with(py, |player| player.mode().name())
    }

    /// Number of the displayed frame.
    #[getter]
    fn frame(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |player| player.frame())
    }

    #[getter]
    fn moving(&self, py: Python<'_>) -> PyResult<bool> {
        self.with(py, |player| player.moving())
    }

    #[getter]
    fn wants_play(&self, py: Python<'_>) -> PyResult<bool> {
        self.with(py, |player| player.wants_play())
    }

    #[getter]
    fn unloaded(&self, py: Python<'_>) -> PyResult<bool> {
        self.with(py, |player| player.unloaded())
    }

    fn stat<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let stat = self.with(py, |player| Event::Stat(player.stat()))?;
        Ok(json(py, &stat))
    }

    /// Present contacts and poses of objects as an event; none without contact.
    fn moment<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let moment = self.with(py, |player| player.moment())?;
        Ok(moment.map(|event| json(py, &event)))
    }

    /// All rows of the plots.
    fn plot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let plot = self.with(py, |player| Event::Plot(player.whole_plot()))?;
        Ok(json(py, &plot))
    }

    /// Number, time, loads and grabs of the displayed frame.
    fn shown<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let shown = self.with(py, |player| player.shown())?;
        Ok(json(py, &shown))
    }

    /// Positions (m) of the body in the displayed frame.
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.with(py, |player| player.state().positions.clone())?;
        Ok(from_rows(py, &positions[..self.own]))
    }

    /// Packs the displayed frame, on the surface or on another display of the same problem.
    #[pyo3(signature = (field, seq=0, display=None))]
    fn pack_frame<'py>(
        &self,
        py: Python<'py>,
        field: u16,
        seq: u32,
        display: Option<PyRef<'_, PyDisplay>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let display = display.as_deref();
        if display.is_some_and(|other| !Arc::ptr_eq(&other.problem, &self.problem)) {
            let message = "display: it belongs to another problem";
            return Err(PyValueError::new_err(message));
        }
        let field = field_of(field)?;
        let display = display.map(|other| &other.display);
        let bytes = self.with(py, |player| player.pack_frame(field, seq, display))?;
        Ok(PyBytes::new(py, &bytes))
    }
}

/// Adds the constants that Python and the page share with the core.
pub(crate) fn add_constants(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("MAGIC", MAGIC)?;
    module.add("HEADER", HEADER)?;
    module.add("PACES", PyTuple::new(module.py(), PACES)?)?;
    module.add("PLOT_COLUMNS", PyTuple::new(module.py(), COLUMNS)?)?;
    module.add("FRAME_TIME", FRAME_TIME)?;
    module.add("STIFFNESS", STIFFNESS)?;
    let fields = Field::ALL.map(|field| {
        let called = name_of(field);
        let FieldName {
            name, title, unit, ..
        } = called;
        (field as u16, name, title, unit, called.signed)
    });
    module.add("FIELDS", PyTuple::new(module.py(), fields)?)?;
    let codes = |codes: &[(&str, u8)]| codes.to_vec().into_py_dict(module.py());
    module.add(
        "MESSAGE_KINDS",
        codes(&[
            ("TOPOLOGY", MessageKind::Topology as u8),
            ("FRAME", MessageKind::Frame as u8),
            ("SMOOTH", MessageKind::Smooth as u8),
        ])?,
    )?;
    module.add(
        "FRAME_FLAGS",
        codes(&[
            ("PAUSED", frame_flag::PAUSED),
            ("DIVERGED", frame_flag::DIVERGED),
            ("AT_REST", frame_flag::AT_REST),
        ])?,
    )?;
    module.add(
        "TOPOLOGY_FLAGS",
        codes(&[
            ("SURFACE", TopologyFlag::Surface as u8),
            ("SHRUNK_TETS", TopologyFlag::ShrunkTets as u8),
        ])?,
    )
}
