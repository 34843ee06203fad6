//! Motion in progress: its steps, and the change from one state to the next.

use std::sync::Arc;

use voxsoft_solid::breakdown::{Breakdown, travel_limit};
use voxsoft_solid::loads::grabs::{Grabs, shortest_edge};
use voxsoft_solid::{Damping, LiveStatus, Load, Observer, Problem, State, Status, Term, Viscosity};

use super::Transient;
use super::energy::Now;
use crate::inertia::Inertia;
use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;
use crate::linear::options::LinearSolver;
use crate::motion::implicit::ANCHOR_SPEED;
use crate::motion::implicit::scheme::{FIRST_PART, SECOND_OVER_FIRST, Stage};
use crate::path::equilibrium::{Equilibrium, Failure};

/// Most halvings of a step before a run counts as diverged.
const MAX_BACK_OFFS: u32 = 10;
/// Successful steps after which a halved one is doubled again.
const PATIENCE: u32 = 3;
/// Relative distance from the next record within which a step is extended to it.
pub(super) const SAME_TIME: f64 = 1e-9;

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
pub struct Motion {
    /// Problem without inertia, which that of `equilibrium` has.
    pub(super) problem: Problem,
    pub(super) settings: Transient,
    pub(super) equilibrium: Equilibrium,
    pub(super) inertia: Arc<Inertia>,
    pub(super) grabs: Grabs,
    pub(super) viscosity: Option<Viscosity>,
    pub(super) state: State,
    pub(super) now: Now,
    /// State one step ago.
    pub(super) before: Option<State>,
    pub(super) stage: Stage,
    /// Forces and energies at the beginning of the step of which the state is the first stage.
    pub(super) begun: Option<Now>,
    pub(super) damping_rate: f64,
    pub(super) step: f64,
    /// Successful steps since the last halving.
    good: u32,
    pub(super) steps: u64,
    pub(super) back_offs: u32,
    pub(super) travel_limit: f64,
    pub(super) shortest_edge: f64,
    pub(super) residual: f64,
    pub(super) status: LiveStatus,
    pub(super) breakdown: Option<Breakdown>,
}

impl Motion {
    /// Starts at rest, to be advanced step by step; the end time and the recording of the settings are not used.
    ///
    /// # Errors
    ///
    /// A tangent that takes more memory than the settings allow.
    pub fn new(problem: Problem, settings: Transient) -> Result<Self, Status> {
        let settings = Transient {
            end_time: None,
            record_interval: None,
            ..settings
        };
        let start = State::at_rest(problem.body());
        let made = Self::from_state(problem, settings, start);
        made.map_err(|(error, ..)| error.into())
    }

    /// Starts from a state; without memory for the tangent the problem and the state are returned.
    pub(super) fn from_state(
        problem: Problem,
        settings: Transient,
        start: State,
    ) -> Result<Self, (FactorError, Box<Problem>, State)> {
        let inertia = Arc::new(Inertia::new(problem.body().masses()));
        let mut problem = problem.with_held_loads();
        begin_at(&mut problem, &start);
        let equilibrium = match moving(&problem, &inertia, settings.memory) {
            Ok(equilibrium) => equilibrium,
            Err(error) => return Err((error, Box::new(problem), start)),
        };
        let mut motion = Self {
            travel_limit: travel_limit(&problem),
            shortest_edge: shortest_edge(&problem),
            grabs: Grabs::new(&problem),
            viscosity: Viscosity::of_viscous(problem.body(), settings.retardation),
            problem,
            equilibrium,
            inertia,
            now: Now::default(),
            before: None,
            stage: Stage::First,
            begun: None,
            damping_rate: initial_rate(settings.damping),
            step: settings.step,
            good: 0,
            steps: 0,
            back_offs: 0,
            state: start,
            settings,
            residual: f64::INFINITY,
            status: LiveStatus::Moving,
            breakdown: None,
        };
        motion.now = motion.look_at(&motion.state);
        Ok(motion)
    }

    /// Goes on from another state, with a memory as at the start.
    pub(super) fn start_from(&mut self, start: State) {
        self.inertia.pull(&[]);
        if let Some(viscosity) = &mut self.viscosity {
            viscosity.restart();
            self.problem.set_within(None);
        }
        begin_at(&mut self.problem, &start);
        // A tangent of the size of the last one fits in memory too.
        if let Ok(equilibrium) = moving(&self.problem, &self.inertia, self.settings.memory) {
            self.equilibrium = equilibrium;
        }
        self.state = start;
        self.before = None;
        self.stage = Stage::First;
        self.begun = None;
        self.damping_rate = initial_rate(self.settings.damping);
        (self.step, self.good) = (self.settings.step, 0);
        self.residual = f64::INFINITY;
        self.wake();
    }

    /// Wakes the run after a change of loads or grabs: the body may move again.
    pub(super) fn wake(&mut self) {
        if self.status == LiveStatus::Diverged {
            self.step = self.settings.step;
        }
        self.status = LiveStatus::Moving;
        self.breakdown = None;
        // A load acts with its new value for all of the next step, whose work counts in the balance of energy.
        self.now = self.look_at(&self.state);
    }

    /// Takes one step, halved repeatedly if a whole one fails.
    pub(super) fn take_step(
        &mut self,
        recorded: i64,
        observer: &mut Observer<'_>,
    ) -> Result<(), Stop> {
        let least = self.settings.step * 0.5f64.powi(MAX_BACK_OFFS as i32);
        loop {
            self.steps += 1;
            let (whole, step) = self.next_step(recorded);
            let failure = match self.try_step(step, observer) {
                Ok(()) => {
                    self.good += 1;
                    if self.good >= PATIENCE && self.step < self.settings.step {
                        self.step = (2.0 * self.step).min(self.settings.step);
                        self.good = 0;
                    }
                    return Ok(());
                }
                Err(failure) => failure,
            };
            self.rollback();
            if let Stop::Failed(Failure::Memory(_) | Failure::Cancelled) = failure {
                return Err(failure);
            }
            self.step = whole / 2.0;
            if self.stage == Stage::Second {
                self.stage = Stage::Later;
                self.begun = None;
            }
            if self.step < least {
                return Err(failure);
            }
            self.back_offs += 1;
            self.good = 0;
        }
    }

    /// Length of the next step, which does not exceed the end or the next record, and of its next stage.
    fn next_step(&self, recorded: i64) -> (f64, f64) {
        if let (Stage::Second, Some(before)) = (self.stage, &self.before) {
            let second = SECOND_OVER_FIRST * (self.state.time - before.time);
            return (second, second);
        }
        let end = self.settings.end_time.unwrap_or(f64::INFINITY);
        let each = self.settings.record_interval;
        let record = each.map_or(f64::INFINITY, |each| (recorded + 1) as f64 * each);
        let left = end.min(record) - self.state.time;
        // Two steps of equal length rather than one with a rest.
        let parts = (left / self.step - SAME_TIME).ceil().max(1.0);
        let whole = if left.is_finite() {
            left / parts
        } else {
            self.step
        };
        let begins = self.stage == Stage::First;
        (whole, if begins { FIRST_PART * whole } else { whole })
    }

    /// Takes a step by the second-order formula, or again by backward Euler if that one gains energy.
    fn try_step(&mut self, step: f64, observer: &mut Observer<'_>) -> Result<(), Stop> {
        if self.before.is_some() {
            let before = self.before.take();
            let outcome = self.find(step, before.as_ref(), observer);
            self.before = before;
            let (next, found) = outcome?;
            if !self.gains_energy(&next, &found) {
                return self.accept(next, found);
            }
            self.rollback();
        }
        let (next, found) = self.find(step, None, observer)?;
        self.accept(next, found)
    }

    /// Resets the memory of contact to the last accepted state.
    fn rollback(&mut self) {
        if let Some(contact) = self.problem.contact_mut() {
            contact.rollback();
        }
    }

    fn accept(&mut self, next: State, found: Now) -> Result<(), Stop> {
        if let Some(contact) = self.problem.contact_mut() {
            contact.accept(&next.positions);
        }
        let factor_of = |load: &Load| load.history.at(next.time);
        self.problem.accept_loads(&next.positions, &factor_of);
        if let Some(fluid) = self.problem.fluid_mut() {
            if self.stage == Stage::Second {
                fluid.take_stage(&next.positions);
            } else {
                fluid.take_step(&next.positions);
            }
        }
        if let Some(viscosity) = &mut self.viscosity {
            let step = next.time - self.state.time;
            viscosity.end(self.problem.body(), &next.positions, step);
        }
        self.equilibrium.problem.remember_but_contact(&self.problem);
        let step = next.time - self.state.time;
        self.grabs.follow(ANCHOR_SPEED * step * self.shortest_edge);
        if self.settings.damping == Damping::Critical {
            self.damping_rate = 2.0 * self.frequency(&next, &found);
        }
        let left = std::mem::replace(&mut self.state, next);
        // The first stage is of first order, and not used as a previous state by later steps.
        if self.stage != Stage::Second {
            self.before = Some(left);
        }
        let then = std::mem::replace(&mut self.now, found);
        self.begun = (self.stage == Stage::First).then_some(then);
        self.stage = match self.stage {
            Stage::First => Stage::Second,
            Stage::Second | Stage::Later => Stage::Later,
        };
        Ok(())
    }
}

/// Clears the memory of a problem for a motion from `start`.
fn begin_at(problem: &mut Problem, start: &State) {
    if let Some(contact) = problem.contact_mut() {
        contact.reset(&start.positions);
    }
    problem.start_loads();
    problem.begin(start.time);
    problem.start_fluid(&start.positions, Some(start.time));
}

/// Equilibrium of a problem with the forces of inertia.
fn moving(
    problem: &Problem,
    inertia: &Arc<Inertia>,
    memory: u64,
) -> Result<Equilibrium, FactorError> {
    let moving = problem
        .clone()
        .with_term(Arc::clone(inertia) as Arc<dyn Term>);
    let moving = moving.expect("inertia has the vertices of its body");
    let options = LinearOptions {
        solver: LinearSolver::Auto,
        memory,
    };
    Ok(Equilibrium {
        inertia: Some(Arc::clone(inertia)),
        ..Equilibrium::new(moving, options)?
    })
}

fn initial_rate(damping: Damping) -> f64 {
    match damping {
        Damping::Rate(rate) => rate,
        Damping::Critical => 0.0,
    }
}

/// Reasons for an early end of a run.
pub(super) enum Stop {
    /// The end of a step was not found.
    Failed(Failure),
    /// A body has moved too far away.
    Gone(Breakdown),
}

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl From<FactorError> for Stop {
    fn from(error: FactorError) -> Self {
        Self::Failed(error.into())
    }
}
