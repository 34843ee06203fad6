//! `_core.Problem` and its XPBD solvers.
//!
//! Long because all methods of one Python class stand in one block.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voxsoft_solid::balance::{balance_under, total_load_under};
use voxsoft_solid::vector::{Vec3, sub};
use voxsoft_solid::{
    Body, Fluid, Hex8, Load, Material, Membrane, Mesh, PerBlock, Problem, ProblemError, State,
    StepEnd, Velocities, elastic, work_of_clamps, work_of_load,
};
use voxsoft_xpbd::{Answer, Damping, Dynamics, Relaxation, Status, Trial, relax, simulate};

use crate::answer::{PyAnswer, undefined_of};
use crate::arrays::{from_rows, rows};
use crate::errors::to_python;
use crate::gate;
use crate::handle::{Handle, PyMemory};
use crate::inputs::{InputArgument, inputs_of};
use crate::materials::PyMaterial;
use crate::problem_parts::PyProblemParts;
use crate::surface_contact::{Touching, contact_of};
use crate::tendon::{PyTendon, tendons};
use crate::watch::{Watch, collect_sensors};

/// Numbers of chambers, (c, 6), and tendons.
type PyDrives<'py> = (Bound<'py, PyArray2<f64>>, Vec<Py<PyTendon>>);

/// State of a motion: positions, velocities, time in s, memory and inputs.
type StateArgument<'py> = (
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    f64,
    PyRef<'py, PyMemory>,
    Vec<InputArgument>,
);

/// A mechanical problem: a body with clamps, loads and a floor.
#[pyclass(frozen, name = "Problem", module = "voxsoft._core")]
pub struct PyProblem {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) materials: Arc<Vec<Material>>,
    pub(crate) problem: Arc<Handle>,
    pub(crate) touching: Option<Arc<Touching>>,
    /// Fractions of the blocks, if they are not those of the mesh.
    pub(crate) fractions: Option<Arc<PerBlock>>,
}

#[pymethods]
impl PyProblem {
    #[new]
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        tets: PyReadonlyArray2<'_, u32>,
        tet_part: PyReadonlyArray1<'_, u8>,
        tet_block: PyReadonlyArray1<'_, u32>,
        materials: Vec<PyMaterial>,
        parts: PyRef<'_, PyProblemParts>,
    ) -> PyResult<Self> {
        let mut mesh = Mesh {
            vertices: rows("vertices", &vertices)?,
            tets: rows("tets", &tets)?,
            tet_part: tet_part.as_array().to_vec(),
            tet_block: tet_block.as_array().to_vec(),
            block_fraction: parts.block_fraction.clone(),
            block_filling: parts.block_filling.clone(),
            block_axes: parts.block_axes.clone(),
            coarse: parts.coarse.clone(),
            membranes: Vec::new(),
            attachments: parts.attachments.clone(),
            point_masses: Vec::new(),
        };
        let count = mesh.vertices.len();
        for (triangles, material) in &parts.membranes {
            for triangle in triangles {
                if let Some(&index) = triangle.iter().find(|&&v| v as usize >= count) {
                    let what = "vertex of a membrane";
                    let index = index as usize;
                    return Err(to_python(ProblemError::Index { what, index, count }));
                }
                let corners = triangle.map(|v| mesh.vertices[v as usize]);
                let membrane = Membrane::new(*triangle, corners, *material).map_err(to_python)?;
                mesh.membranes.push(membrane);
            }
        }
        Self::assemble(py, mesh, materials, &parts)
    }

    /// Copy of the problem with the same body and loads and other materials.
    fn with_materials(&self, py: Python<'_>, materials: Vec<PyMaterial>) -> PyResult<Self> {
        let now = self.now();
        let parts = PyProblemParts {
            clamps: now.clamps().to_vec(),
            loads: now.loads().to_vec(),
            floor: now.floor(),
            membranes: Vec::new(),
            block_fraction: Vec::new(),
            block_filling: Vec::new(),
            block_axes: Vec::new(),
            coarse: Vec::new(),
            attachments: Vec::new(),
            touch: None,
            tendons: Vec::new(),
            dielectrics: Vec::new(),
            fluid: now.fluid().cloned(),
        };
        let mut mesh = Mesh::clone(&self.mesh);
        let mut parts = parts;
        if let Some(touching) = &self.touching {
            mesh.vertices.truncate(touching.first);
            let own = parts.clamps.len() - touching.parts.held();
            mesh.point_masses.clear();
            parts.clamps.truncate(own);
            parts.touch = Some(touching.parts.clone());
        }
        let made = Self::assemble(py, mesh, materials, &parts)?;
        match &self.fractions {
            Some(fractions) => made.filled(Arc::clone(fractions)),
            None => Ok(made),
        }
    }

    #[getter]
    fn mass(&self) -> f64 {
        self.now().body().masses()[..self.own()].iter().sum()
    }

    #[getter]
    fn masses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.now().body().masses()[..self.own()])
    }

    /// Edges of the lattice as (vertices, rest length, stiffness) arrays.
    #[expect(clippy::type_complexity, reason = "three arrays")]
    fn edges<'py>(
        &self,
        py: Python<'py>,
    ) -> (
        Bound<'py, PyArray2<u32>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<f64>>,
    ) {
        let now = self.now();
        let edges = now.body().edges();
        let vertices: Vec<[u32; 2]> = edges.iter().map(|edge| edge.vertices).collect();
        let collect = |value: fn(&voxsoft_solid::Edge) -> f64| edges.iter().map(value).collect();
        (
            from_rows(py, &vertices),
            PyArray1::from_vec(py, collect(|edge| edge.length)),
            PyArray1::from_vec(py, collect(|edge| edge.stiffness)),
        )
    }

    /// Pressure (Pa, positive in tension) in each hyperelastic voxel, on the vertex at its lowest corner; NaN on other
    /// vertices.
    fn pressures<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let positions = self.positions(&positions)?;
        let now = self.now();
        let body = now.body();
        let pressures = body.hex8_term().pressures(&positions);
        let mut found = vec![f64::NAN; self.own()];
        for (index, hex8) in body.small_hex8s().iter().enumerate() {
            found[hex8.vertices[0] as usize] = pressures[body.element_of(index)];
        }
        Ok(PyArray1::from_vec(py, found))
    }

    /// Largest isochoric energy (J/m³) so far of each hyperelastic voxel, if any has the Mullins effect.
    fn peaks<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let peaks = self.now().body().hex8_term().peaks()?;
        Some(PyArray1::from_vec(py, peaks))
    }

    /// Sets the largest isochoric energies (J/m³) so far of hyperelastic voxels.
    fn set_peaks(&self, peaks: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let (got, expected) = (peaks.len()?, self.now().body().hex8s().len());
        if got != expected {
            let what = "peaks of voxels";
            return Err(to_python(ProblemError::Length {
                what,
                got,
                expected,
            }));
        }
        let peaks = peaks.as_array().to_vec();
        self.problem.change(|problem| problem.set_peaks(&peaks));
        Ok(())
    }

    /// Viscous stress of a creep as numbers; `None` without one.
    fn creep<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let row = self.now().creep_row()?;
        Some(PyArray1::from_vec(py, row))
    }

    /// The problem at a time in s of a creep, with the numbers of `creep` there.
    fn with_creep(&self, time: f64, row: PyReadonlyArray1<'_, f64>) -> PyResult<Self> {
        let row = row.as_array().to_vec();
        let mut fits = false;
        let resumed = self.with(|problem| fits = problem.resume_creep(time, &row));
        if fits {
            Ok(resumed)
        } else {
            Err(PyValueError::new_err("creep: numbers of another body"))
        }
    }

    /// Elastic energy in J and forces in N at the given positions.
    fn elastic<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<(f64, Bound<'py, PyArray2<f64>>)> {
        let positions = self.positions(&positions)?;
        let mut forces = vec![[0.0; 3]; positions.len()];
        let now = self.now();
        elastic::add_forces(now.body(), &positions, &mut forces);
        if let Some(contact) = now.contact() {
            let mut others = vec![[0.0; 3]; positions.len()];
            contact.add_forces(&positions, &mut others);
            for (force, other) in forces.iter_mut().zip(others) {
                *force = sub(*force, other);
            }
        }
        let energy = self.elastic_energy(&positions);
        Ok((energy, from_rows(py, &forces[..self.own()])))
    }

    /// Elastic plus external force (N) on every vertex under the final values of all loads. Tendons marked in `taut`
    /// stay taut.
    #[pyo3(signature = (positions, taut=vec![]))]
    fn net_forces<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        taut: Vec<bool>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.positions(&positions)?;
        let mut forces = vec![[0.0; 3]; positions.len()];
        let now = self.now();
        let problem = now.with_taut_tendons(&taut);
        problem.add_loads(&positions, f64::INFINITY, &mut forces);
        elastic::add_forces(now.body(), &positions, &mut forces);
        Ok(from_rows(py, &forces[..self.own()]))
    }

    /// Tendons at the given positions under the final values of all loads, as if loaded in one step.
    fn tendons(
        &self,
        py: Python<'_>,
        positions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Vec<Py<PyTendon>>> {
        let positions = self.positions(&positions)?;
        let mut problem = Problem::clone(&self.now());
        problem.start_loads();
        let factor_of = |load: &Load| load.history.at(f64::INFINITY);
        tendons(py, &problem, &positions, &factor_of)
    }

    /// Measures a moving state of all vertices, objects included, under the loads at its time, and inputs that replace
    /// those of the problem: nothing is solved.
    #[pyo3(signature = (positions, velocities, time, memory, residual, inputs=vec![]))]
    #[expect(clippy::too_many_arguments, reason = "arguments of one Python call")]
    fn measure(
        &self,
        py: Python<'_>,
        positions: PyReadonlyArray2<'_, f64>,
        velocities: PyReadonlyArray2<'_, f64>,
        time: f64,
        memory: &PyMemory,
        residual: f64,
        inputs: Vec<InputArgument>,
    ) -> PyResult<PyAnswer> {
        let positions = self.positions(&positions)?;
        let velocities = rows("velocities", &velocities)?;
        if velocities.len() != positions.len() {
            let message = format!(
                "velocities: {} rows, expected {}",
                velocities.len(),
                positions.len()
            );
            return Err(PyValueError::new_err(message));
        }
        let there = self.at(time, memory, inputs)?;
        let answer = Answer {
            state: State {
                positions,
                velocities,
                time,
            },
            status: Status::NotAtRest,
            residual,
            steps: 0,
            back_offs: 0,
            substep: 0.0,
            breakdown: None,
        };
        let watch = Watch::new(None, Vec::new(), false);
        there.answer(py, answer, watch, &|load| load.history.at(time))
    }

    /// Measures chambers, (c, 6), and tendons alone, of a state like that of `measure`.
    #[pyo3(signature = (positions, time, memory, inputs=vec![]))]
    fn drives<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'_, f64>,
        time: f64,
        memory: &PyMemory,
        inputs: Vec<InputArgument>,
    ) -> PyResult<PyDrives<'py>> {
        let positions = self.positions(&positions)?;
        let problem = self.at(time, memory, inputs)?.now();
        let factor_of = |load: &Load| load.history.at(time);
        let chambers = from_rows(py, &chambers(&problem, &positions, &factor_of));
        Ok((chambers, tendons(py, &problem, &positions, &factor_of)?))
    }

    /// Work (J) of some loads, by their numbers, and of all clamps, over the step of a motion between two states of all
    /// vertices: positions, velocities, time, memory, and inputs that replace those of the problem.
    fn step_work(
        &self,
        before: StateArgument<'_>,
        after: StateArgument<'_>,
        loads: Vec<usize>,
    ) -> PyResult<(Vec<f64>, Vec<f64>)> {
        let ends = [self.step_end(before)?, self.step_end(after)?];
        let count = self.now().loads().len();
        if let Some(index) = loads.iter().find(|index| **index >= count) {
            let message = format!("loads: {index} is no load, there are {count}");
            return Err(PyValueError::new_err(message));
        }
        let of_loads = loads.iter().map(|load| work_of_load(&ends, *load));
        Ok((of_loads.collect(), work_of_clamps(&ends)))
    }

    /// Reads the bytes of a memory of this problem.
    fn read_memory(&self, bytes: &[u8]) -> PyResult<PyMemory> {
        let memory = self.now().read_memory(bytes).map(PyMemory);
        memory.ok_or_else(|| {
            PyValueError::new_err("bytes: damaged, or the memory of another problem")
        })
    }

    /// Relaxes to equilibrium. `trial` is a number of steps and the residual above which the run then ends.
    #[pyo3(signature = (*, tolerance, max_steps, trial=None, start=None, progress=None))]
    fn relax(
        &self,
        py: Python<'_>,
        tolerance: f64,
        max_steps: u64,
        trial: Option<(u64, f64)>,
        start: Option<PyReadonlyArray2<'_, f64>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyAnswer> {
        let settings = Relaxation {
            tolerance,
            max_steps,
            trial: trial.map(|(steps, residual)| Trial { steps, residual }),
        };
        let problem = self.now();
        let mut state = State::at_rest(problem.body());
        if let Some(start) = start {
            state.positions = self.positions(&start)?;
        }
        let mut watch = Watch::new(progress, Vec::new(), false);
        let answer = gate::run(py, |cancel| {
            relax(&problem, state, &settings, &mut |now| {
                watch.see(now, cancel)
            })
        })?;
        let there = self.with(|_| ());
        there.answer(py, answer, watch, &|load| load.history.at(f64::INFINITY))
    }

    #[pyo3(signature = (*, time_step, substeps, iterations, damping, retardation, end_time, max_time, tolerance,
        record_interval=None, sensors=vec![], frames=false, progress=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "keyword arguments of one Python call"
    )]
    fn simulate(
        &self,
        py: Python<'_>,
        time_step: f64,
        substeps: Option<u32>,
        iterations: u32,
        damping: Option<f64>,
        retardation: f64,
        end_time: Option<f64>,
        max_time: f64,
        tolerance: f64,
        record_interval: Option<f64>,
        sensors: Vec<(PyReadonlyArray1<'_, u32>, PyReadonlyArray1<'_, f64>)>,
        frames: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyAnswer> {
        let damping = damping.map_or(Damping::Critical, Damping::Rate);
        let settings = Dynamics {
            time_step,
            substeps,
            iterations,
            damping,
            retardation,
            end_time,
            max_time,
            tolerance,
            record_interval,
            ..Dynamics::default()
        };
        let problem = self.now();
        let state = State::at_rest(problem.body());
        let mut watch = Watch::new(progress, collect_sensors(&sensors), frames);
        let answer = gate::run(py, |cancel| {
            simulate(&problem, state, &settings, &mut |now| {
                watch.see(now, cancel)
            })
        })?;
        let time = answer.state.time;
        let there = self.with(|problem| problem.begin(time));
        there.answer(py, answer, watch, &|load| load.history.at(time))
    }
}

impl PyProblem {
    fn assemble(
        py: Python<'_>,
        mesh: Mesh,
        materials: Vec<PyMaterial>,
        parts: &PyProblemParts,
    ) -> PyResult<Self> {
        let materials: Vec<Material> = materials.into_iter().map(|given| given.0).collect();
        let (mut clamps, mut loads, floor) =
            (parts.clamps.clone(), parts.loads.clone(), parts.floor);
        let first = mesh.vertices.len();
        for (tendon, history) in parts.tendons.iter().cloned() {
            let load = tendon.load(history, parts.touch.as_ref(), first);
            let missing = || PyValueError::new_err("tendon: there is no such object");
            loads.push(load.ok_or_else(missing)?);
        }
        loads.extend(parts.dielectrics.iter().cloned());
        let touch = parts.touch.clone();
        let fluid = parts.fluid.as_ref().map(Fluid::anew);
        gate::run_owned(py, move |_| {
            let mut mesh = mesh;
            if let Some(parts) = &touch {
                parts.add_frames(&mut mesh, &mut clamps);
            }
            let body = Body::new(&mesh, &materials)?;
            let mut problem = Problem::new(body, clamps, loads, floor)?;
            if let Some(fluid) = fluid.transpose()? {
                problem = problem.with_fluid(fluid)?;
            }
            let mut touching = None;
            if let Some(parts) = touch {
                if let Some(springs) = parts.frame_springs(problem.body(), first) {
                    problem = problem.with_term(Arc::new(springs))?;
                }
                let (made, contact) = parts.into_touching(&problem, first)?;
                problem = problem.with_contact(contact)?;
                touching = Some(Arc::new(made));
            }
            Ok(Self {
                mesh: Arc::new(mesh),
                materials: Arc::new(materials),
                problem: Arc::new(Handle::new(problem)),
                touching,
                fractions: None,
            })
        })?
        .map_err(to_python)
    }

    /// Present problem with its history variables.
    pub(crate) fn now(&self) -> Arc<Problem> {
        self.problem.now()
    }

    /// Copy of the problem, changed by `act` (its history variables, say).
    pub(crate) fn with(&self, act: impl FnOnce(&mut Problem)) -> Self {
        let mut problem = Problem::clone(&self.now());
        act(&mut problem);
        Self {
            mesh: Arc::clone(&self.mesh),
            materials: Arc::clone(&self.materials),
            problem: Arc::new(Handle::new(problem)),
            touching: self.touching.clone(),
            fractions: self.fractions.clone(),
        }
    }

    /// Elastic energy of the material, J, without the energy of contact.
    fn elastic_energy(&self, positions: &[Vec3]) -> f64 {
        let now = self.now();
        let of_contact = now
            .contact()
            .map_or(0.0, |contact| contact.energy(positions));
        elastic::stored_energy(now.body(), positions) - of_contact
    }

    /// Number of vertices of the body, without those of objects.
    pub(crate) fn own(&self) -> usize {
        let all = self.now().body().rest().len();
        self.touching
            .as_ref()
            .map_or(all, |touching| touching.first)
    }

    /// Pressures in the order of hyperelastic voxels, read at the vertices at their lowest corners.
    pub(crate) fn hex8_pressures(&self, array: &PyReadonlyArray1<'_, f64>) -> PyResult<Vec<f64>> {
        let array = array.as_array();
        let now = self.now();
        let hex8s = now.body().hex8s();
        let pressure = |hex8: &Hex8| array.get(hex8.vertices[0] as usize).copied();
        let found: Option<Vec<f64>> = hex8s.iter().map(pressure).collect();
        match found {
            Some(found) if found.iter().all(|p| p.is_finite()) => Ok(found),
            _ => Err(PyValueError::new_err(
                "pressures: a voxel has none at its lowest corner",
            )),
        }
    }

    pub(crate) fn positions(&self, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Vec3>> {
        let mut positions = rows("positions", array)?;
        let expected = self.now().body().rest().len();
        if let Some(touching) = &self.touching
            && positions.len() == touching.first
        {
            positions = touching.completed(&self.now(), positions);
        }
        if positions.len() != expected {
            let message = format!("positions: {} rows, expected {expected}", positions.len());
            return Err(PyValueError::new_err(message));
        }
        Ok(positions)
    }

    /// Returns one end of a step.
    fn step_end(
        &self,
        (positions, velocities, time, memory, inputs): StateArgument<'_>,
    ) -> PyResult<StepEnd> {
        let positions = self.positions(&positions)?;
        let velocities = rows("velocities", &velocities)?;
        if velocities.len() != positions.len() {
            let (got, expected) = (velocities.len(), positions.len());
            let message = format!("velocities: {got} rows, expected {expected}");
            return Err(PyValueError::new_err(message));
        }
        let problem = Problem::clone(&self.at(time, &memory, inputs)?.now());
        let state = State {
            positions,
            velocities,
            time,
        };
        Ok(StepEnd::new(problem, state, memory.0.past.clone()))
    }

    /// Returns the problem at a time in s, with its memory there and inputs that replace its own.
    fn at(&self, time: f64, memory: &PyMemory, inputs: Vec<InputArgument>) -> PyResult<Self> {
        let mut outcome = Ok(());
        let inputs = inputs_of(inputs)?;
        let there = self.with(|problem| {
            outcome =
                (inputs.into_iter()).try_for_each(|(input, course)| problem.command(input, course));
            problem.remember(&memory.0);
            problem.begin(time);
        });
        outcome.map_err(to_python)?;
        Ok(there)
    }

    /// Converts an answer for Python; `self` has the history variables of its end, and reactions are those under loads
    /// with these factors.
    pub(crate) fn answer(
        self,
        py: Python<'_>,
        answer: Answer,
        watch: Watch,
        factor_of: &dyn Fn(&Load) -> f64,
    ) -> PyResult<PyAnswer> {
        if let Some(raised) = watch.raised {
            return Err(raised);
        }
        let positions = &answer.state.positions;
        let own = self.own();
        let problem = in_motion(self.now(), &answer.state);
        let (contacts, objects) = match &self.touching {
            Some(touching) => (
                touching.contacts(py, &problem, positions)?,
                touching.poses(py, &touching.seen(positions)[touching.own()..])?,
            ),
            None => (Vec::new(), Vec::new()),
        };
        let touching = self.touching.as_ref();
        let contact_field = touching
            .zip(contact_of(&problem))
            .map(|(touching, touch)| touching.field(py, touch, positions))
            .transpose()?;
        let balance = balance_under(&problem, positions, factor_of);
        let (load, load_moment) = total_load_under(&problem, positions, factor_of);
        let sensors = watch.sensors.len();
        let now = chambers(&problem, positions, factor_of);
        let read = if watch.chambers.is_empty() {
            0
        } else {
            watch.recorded
        };
        let frames = if watch.keep_frames { watch.recorded } else { 0 };
        Ok(PyAnswer {
            status: answer.status.into(),
            positions: from_rows(py, &positions[..own]).unbind(),
            all_positions: from_rows(py, positions).unbind(),
            velocities: from_rows(py, &answer.state.velocities[..own]).unbind(),
            time: answer.state.time,
            residual: answer.residual,
            steps: answer.steps,
            back_offs: answer.back_offs,
            substep: answer.substep,
            breakdown: answer.breakdown.map(|b| (b.vertex, b.rest, b.when)),
            undefined: undefined_of(answer.breakdown),
            reactions: from_rows(py, &balance.reactions[..own]).unbind(),
            reaction: balance.total_reaction(),
            reaction_moment: balance.total_moment(positions),
            load,
            load_moment,
            elastic_energy: self.elastic_energy(positions),
            record_times: PyArray1::from_vec(py, watch.times).unbind(),
            records: PyArray1::from_vec(py, watch.records)
                .reshape([watch.recorded, sensors, 3])?
                .unbind(),
            frames: PyArray1::from_vec(py, cut(watch.frames, positions.len(), own))
                .reshape([frames, own, 3])?
                .unbind(),
            path: None,
            chambers: from_rows(py, &now).unbind(),
            chamber_records: PyArray1::from_vec(py, watch.chambers)
                .reshape([read, now.len(), 6])?
                .unbind(),
            contacts,
            objects,
            history: None,
            tendons: tendons(py, &problem, positions, factor_of)?,
            problem: Py::new(py, self)?,
            contact_field,
        })
    }
}

/// The problem with the velocities of a state, for loads that depend on them.
fn in_motion(mut problem: Arc<Problem>, state: &State) -> Arc<Problem> {
    if problem.feels_motion() {
        let (positions, velocities) = (&state.positions, &state.velocities);
        let moving = || Velocities::of(positions, velocities, 1.0);
        Arc::make_mut(&mut problem).begin_motion(moving, positions);
    }
    problem
}

/// Numbers of each chamber with fluid.
fn chambers(
    problem: &Problem,
    positions: &[Vec3],
    factor_of: &dyn Fn(&Load) -> f64,
) -> Vec<[f64; 6]> {
    let readings = problem.fluid().map_or(Vec::new(), |fluid| {
        fluid.read(positions, fluid.instant(factor_of))
    });
    readings.iter().map(|reading| reading.numbers()).collect()
}

/// Keeps the first `own` of every `all` points.
fn cut(frames: Vec<f64>, all: usize, own: usize) -> Vec<f64> {
    if own == all {
        return frames;
    }
    let each = frames
        .chunks_exact(3 * all)
        .flat_map(|frame| &frame[..3 * own]);
    each.copied().collect()
}
