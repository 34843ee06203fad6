//! Implicit dynamics with contact.
//!
//! The end of a step is an equilibrium of the body, its loads and its contact with the forces of inertia, by the
//! second-order backward difference formula ([`crate::motion::scheme`]):
//!
//! ```text
//! M (a + c v) = f(x)   ⇔   x is an equilibrium with κ/2 |x − y|²_M,   κ = σ (σ + c),   y = x̂ + v̂/(σ + c).
//! ```
//!
//! It is found like one of statics: Newton's method on the exact tangent, contact corrected until it has settled. So no
//! step ends with penetrating surfaces, and sticking samples stay in place.
//!
//! # Energy
//!
//! The formula takes `π (2π h/T)³` of the energy of a vibration of the period `T` in each period, so it damps only
//! motions that a step does not resolve. Where two bodies meet, velocities jump, and a formula that looks two steps
//! back makes them rebound too fast. A step that would end with more energy than the last state had and the loads have
//! given is therefore taken again by the backward Euler formula, which gains none where the potential is convex. The
//! impact is inelastic then, vertex by vertex; the body behind rebounds. Both formulas keep momentum to the tolerance
//! of a step.

mod energy;
mod search;
mod variations;

use std::ops::ControlFlow;

use voxsoft_solid::breakdown::{Breakdown, Reach};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Damping, History, Input, Memory, Observer, Problem, ProblemError, Progress, RecordedContact,
    Solution, Solver, State, Status,
};

pub use self::search::Newton;
pub use self::variations::{Side, Slopes};
use super::integrator::{Integrator, SAME_TIME, Stop};
use super::run::{ImplicitSettings, Run};
use crate::linear::error::FactorError;
use crate::linear::options::LinearSolver;
use crate::sensitivity::adjoint::AdjointError;

/// Settings of implicit dynamics with contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transient {
    /// Length of a step in s.
    pub step: f64,
    /// Damping of all motion.
    pub damping: Damping,
    /// Retardation time in s of Kelvin–Voigt damping: the deviatoric stress of a hyperelastic voxel becomes
    /// `s + τ ds/dt`.
    pub retardation: f64,
    /// Tolerance of rest: of the relative residual force, and of the kinetic energy over the elastic energy.
    pub tolerance: f64,
    /// Allowed error of a step ([`crate::ImplicitSettings::accuracy`]).
    pub accuracy: f64,
    /// End time in s, reached exactly; `None` runs to rest.
    pub end_time: Option<f64>,
    /// Time in s after which a run that does not come to rest is given up.
    pub max_time: f64,
    /// Time between two records in s, which steps do not exceed.
    pub record_interval: Option<f64>,
    /// Most bytes of the tangent.
    pub memory: u64,
    /// Solver of the linear systems.
    pub linear: LinearSolver,
}

impl Default for Transient {
    fn default() -> Self {
        Self {
            step: 0.01,
            damping: Damping::Rate(0.0),
            retardation: 0.0,
            tolerance: 1e-4,
            accuracy: f64::INFINITY,
            end_time: None,
            max_time: 60.0,
            record_interval: None,
            memory: u64::MAX,
            linear: LinearSolver::Auto,
        }
    }
}

impl Solver for Transient {
    fn name(&self) -> &'static str {
        "transient"
    }

    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution {
        let mut state = State::at_rest(problem.body());
        if let Some(start) = start {
            state.positions = start.to_vec();
        }
        self.follow(problem, state, observer)
    }
}

impl Transient {
    /// Integrates the motion of a problem from a state.
    pub fn follow(&self, problem: &Problem, start: State, observer: &mut Observer<'_>) -> Solution {
        match Motion::from_state(problem.clone(), self, start) {
            Ok(mut motion) => {
                motion.run.reach = Reach::near_rest(problem);
                motion.go(self, observer)
            }
            Err((error, run)) => refused(run.state, run.problem.memory(), error),
        }
    }
}

fn refused(state: State, memory: Memory, error: FactorError) -> Solution {
    Solution {
        memory,
        state,
        status: error.into(),
        residual: f64::INFINITY,
        steps: 0,
        back_offs: 0,
        breakdown: None,
    }
}

/// A problem in motion by implicit steps that converge: contact settled, pressures of fluids and friction of tendons
/// found with the positions.
///
/// # Example
///
/// ```
/// use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, LiveStatus, Load, Mesh, Problem, Stepper};
/// use voxsoft_statics::{Motion, Transient};
/// use voxsoft_voxel::{Grid, tet_mesh};
///
/// let mut grid = Grid::empty([4, 1, 1], [0.0; 3], 0.01, u64::MAX)?;
/// grid.fill_box([0.0; 3], [0.04, 0.01, 0.01], 1);
/// let tets = tet_mesh(&grid, u64::MAX)?;
/// let mesh = Mesh {
///     tet_part: vec![0; tets.tets.len()],
///     tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
///     tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
///     vertices: tets.vertices,
///     ..Mesh::default()
/// };
/// let rubber = HyperelasticMaterial::neo_hookean(60e3, 0.49, 1070.0)?;
/// let body = Body::new(&mesh, &[rubber])?;
/// let wall = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][0] < 1e-9);
/// let loads = vec![Load::gravity([0.0, 0.0, -9.81])];
/// let problem = Problem::new(body, vec![Clamp::fixed(wall.collect())], loads, None)?;
/// let mut motion = Motion::new(problem, Transient::default()).unwrap();
/// assert_eq!(motion.advance(5).status, LiveStatus::Moving);
/// assert!((motion.state().time - 0.05).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type Motion = Integrator<Newton>;

impl Motion {
    /// Starts at rest, to be advanced step by step; the end time and the recording of the settings are not used.
    ///
    /// # Errors
    ///
    /// A tangent that takes more memory than the settings allow.
    pub fn new(problem: Problem, settings: Transient) -> Result<Self, Status> {
        let start = State::at_rest(problem.body());
        Self::from_state(problem, &settings, start).map_err(|(error, _)| error.into())
    }

    /// Adds a parameter by which the motion is differentiated from the present state on, with contact of a kind; its
    /// neighbors, which [`Self::command_variation`] commands, are at `offset` from its value. Returns its number.
    pub fn vary<C: RecordedContact>(&mut self, offset: f64) -> usize {
        self.search.add_variation::<C>(&self.run, offset)
    }

    /// Forgets all parameters of derivatives.
    pub fn forget_variations(&mut self) {
        self.search.forget_variations();
    }

    /// Replaces courses of inputs of a neighbor of a parameter, which otherwise keeps those it had.
    ///
    /// # Errors
    ///
    /// A parameter or an input that there is not.
    pub fn command_variation(
        &mut self,
        parameter: usize,
        side: Side,
        inputs: &[(Input, History)],
    ) -> Result<(), ProblemError> {
        self.search.command_variation(parameter, side, inputs)
    }

    /// First-order change of the state by a parameter.
    ///
    /// # Errors
    ///
    /// A parameter that there is not, a singular tangent, or contact that does not settle to the first order.
    pub fn slopes(&self, parameter: usize) -> Result<Slopes, AdjointError> {
        self.search.slopes(parameter)
    }

    /// Starts from a state; without memory for the tangent the run is returned.
    fn from_state(
        problem: Problem,
        settings: &Transient,
        start: State,
    ) -> Result<Self, (FactorError, Box<Run>)> {
        let own = ImplicitSettings {
            step: settings.step,
            damping: settings.damping,
            retardation: settings.retardation,
            tolerance: settings.tolerance,
            accuracy: settings.accuracy,
            memory: settings.memory,
            linear: settings.linear,
        };
        let mut run = Run::new(problem, own, start);
        match Newton::new(&mut run) {
            Ok(search) => Ok(Self::begun(run, search)),
            Err(error) => Err((error, Box::new(run))),
        }
    }

    fn go(mut self, settings: &Transient, observer: &mut Observer<'_>) -> Solution {
        let mut recorded = -1i64;
        loop {
            let run = &self.run;
            let residual = run.residual();
            let slot = settings.record_interval;
            let slot = slot.map_or(-1, |each| {
                (run.state.time / each + SAME_TIME).floor() as i64
            });
            let progress = Progress {
                problem: &run.problem,
                steps: run.steps,
                time: run.state.time,
                positions: &run.state.positions,
                velocities: &run.state.velocities,
                residual,
                record: slot > recorded,
            };
            recorded = recorded.max(slot);
            if let ControlFlow::Break(()) = observer(&progress) {
                return self.ended(Status::Cancelled, residual, None);
            }
            if let Some((status, residual)) = self.end(settings, residual) {
                return self.ended(status, residual, None);
            }
            let end = settings.end_time.unwrap_or(f64::INFINITY);
            let each = settings.record_interval;
            let record = each.map_or(f64::INFINITY, |each| (recorded + 1) as f64 * each);
            let mut asker = |progress: Option<&Progress<'_>>| {
                progress.is_none_or(|progress| observer(progress).is_continue())
            };
            if let Err(stop) = self.take_step(end.min(record), &mut asker) {
                let place = self.run.place_of(&stop);
                let (status, place) = match stop {
                    Stop::Memory(bytes) => (Status::OutOfMemory(bytes), None),
                    Stop::Cancelled => (Status::Cancelled, None),
                    Stop::Lost | Stop::Coarse | Stop::Gone(_) => (Status::Diverged, Some(place)),
                };
                return self.ended(status, residual, place);
            }
        }
    }

    /// Status and residual of a run that ends at its state, given the residual there.
    fn end(&self, settings: &Transient, residual: f64) -> Option<(Status, f64)> {
        let time = self.run.state.time;
        if let Some(end) = settings.end_time {
            return (time >= end * (1.0 - 1e-12)).then_some((Status::EndTime, residual));
        }
        if let (residual, true) = self.rest(residual) {
            return Some((Status::AtRest, residual));
        }
        (time >= settings.max_time).then_some((Status::NotAtRest, residual))
    }

    fn ended(self, status: Status, residual: f64, breakdown: Option<Breakdown>) -> Solution {
        let run = self.run;
        Solution {
            memory: run.problem.memory(),
            state: run.state,
            status,
            residual,
            steps: run.steps,
            back_offs: run.back_offs,
            breakdown,
        }
    }
}
