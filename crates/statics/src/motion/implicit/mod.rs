//! Implicit dynamics: motion of rubber while a user pulls at it.
//!
//! A step of a frame's length is the minimum of a potential, because the second-order backward difference formula
//! ([`scheme`]) makes the equation of motion at its end
//!
//! ```text
//! M (a + c v) = f(x)   ⇔   x = argmin  κ/2 |x − y|²_M + E(x) − W(x),   κ = σ (σ + c),   y = x̂ + v̂/(σ + c),
//! ```
//!
//! with the rate of damping `c`. A line search on the potential makes sudden loads and strong pulls harmless, and a
//! rest has `a = v = 0`, so that it is the equilibrium whatever the step. The minimum is found by quasi-Newton steps
//! ([`minimize`]) with a factor of the tangent that serves many steps ([`lagged`]); it is renewed once the extra moves
//! with an old one have cost as much.

mod contact;
mod floor;
mod guess;
mod lagged;
mod line;
mod minimize;
mod objective;
mod pressures;
mod quasi_newton;
mod rest;
pub(crate) mod scheme;
mod step;
mod stepper;
mod turns;

use voxsoft_solid::breakdown::{Breakdown, travel_limit};
use voxsoft_solid::element::hex8::Tangent;
use voxsoft_solid::loads::grabs::{Grabs, shortest_edge};
use voxsoft_solid::vector::{Vec3, add, axpy};
use voxsoft_solid::{Ask, Damping, LiveStatus, Problem, State, Viscosity};

use self::contact::{DEEP_ROUNDS, FACING_ROUNDS};
use self::lagged::Lagged;
use self::minimize::{End, Search, Tolerance};
use self::objective::{Goal, Objective, Value};
use self::pressures::Pressures;
use self::quasi_newton::QuasiNewtonMemory;
use self::scheme::Stage;
pub(crate) use self::stepper::STEPS;
use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;
use crate::linear::options::LinearSolver;

/// Most moves of one search; another follows with a fresh tangent.
const MOST_MOVES: u32 = 8;
/// Most searches of one step, after which it counts as failed.
const MOST_SEARCHES: u32 = 30;
/// Tolerance of the last move of a search, as a part of the shortest edge; the second one, with contact, is a hundredth
/// of its clearance.
const MOVE_OF_EDGE: f64 = 1e-9;
const MOVE_IN_CONTACT: f64 = 1e-5;
/// Most moves of one search with contact, and the factor on its tolerance after them. Changes of the active set are not
/// in the factor.
const MOST_MOVES_IN_CONTACT: u32 = 12;
const ROUGH: f64 = 10.0;
/// Most tangents of one step with contact: it then ends at its present state, unless standing still has a lower
/// potential, and reports that it has not settled.
const SEARCHES_IN_CONTACT: u32 = 6;
/// Largest ratio of the inertia of a step to that of the factor, or its inverse.
const INERTIA_RANGE: f64 = 1.5;
/// Speed of an anchor, in shortest edges per second: one edge in a step of 1/60 s. If the simulation is slower than
/// real time, a hand is faster than life, and steps in which it drags a vertex across several voxels cost three times
/// as many moves, which slows it further. At 240 the PneuNet template stayed at 0.16 of real time under a hand that
/// turns once a second; at 60 it runs at 0.47.
pub(crate) const ANCHOR_SPEED: f64 = 60.0;
/// Most halvings of a step before a run counts as diverged.
const MAX_BACK_OFFS: u32 = 10;
/// Successful steps after which a halved one is doubled again.
const PATIENCE: u32 = 3;
/// Direct factorization of the tangent, whatever its size.
const LINEAR_OPTIONS: LinearOptions = LinearOptions {
    solver: LinearSolver::Direct,
    memory: u64::MAX,
};
/// Rounds of a step in which vertices may touch the floor or leave it.
const FLOOR_ROUNDS: u32 = 3;

/// Settings of an [`Implicit`] run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImplicitSettings {
    /// Length of a step in s.
    pub step: f64,
    /// Damping of all motion.
    pub damping: Damping,
    /// Retardation time in s of Kelvin–Voigt damping: the deviatoric stress of a hyperelastic voxel becomes
    /// `s + τ ds/dt`.
    pub retardation: f64,
    /// Tolerance of rest: of the relative residual force, and of the kinetic energy over the elastic energy.
    pub tolerance: f64,
}

impl Default for ImplicitSettings {
    fn default() -> Self {
        Self {
            step: 1.0 / 60.0,
            damping: Damping::Critical,
            retardation: 0.0,
            tolerance: 1e-4,
        }
    }
}

/// A problem in motion by implicit steps.
///
/// # Example
///
/// ```
/// use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, LiveStatus, Load, Mesh, Problem, Stepper};
/// use voxsoft_statics::{Implicit, ImplicitSettings};
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
/// let mut run = Implicit::new(problem, ImplicitSettings::default());
/// while run.advance(10).status == LiveStatus::Moving {}
/// assert!(run.state().time < 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Implicit {
    problem: Problem,
    settings: ImplicitSettings,
    grabs: Grabs,
    /// Tangent, created at the first step, which reports errors.
    lagged: Option<Lagged>,
    memory: QuasiNewtonMemory,
    pressures: Pressures,
    viscosity: Option<Viscosity>,
    state: State,
    /// State one step ago, for the prediction of the next one.
    before: Option<State>,
    /// Stage of the motion that comes next.
    stage: Stage,
    /// Potential, energy and forces at the state.
    value: Value,
    /// Vertices that the floor carries.
    carried: Vec<bool>,
    /// True if the last step was minimized to its tolerance.
    settled: bool,
    /// True if any sample was pressed during the last step, at its end or on the way there.
    met: bool,
    /// True if contact pairs have changed beyond the sparsity pattern of the tangent.
    pattern_changed: bool,
    damping_rate: f64,
    step: f64,
    steps: u64,
    back_offs: u32,
    /// Successful steps since the last halving.
    good: u32,
    /// Moves that the present factor has cost beyond those of a fresh one.
    excess: f64,
    residual: f64,
    status: LiveStatus,
    breakdown: Option<Breakdown>,
    travel_limit: f64,
    shortest_edge: f64,
}

/// Reasons why a step was not taken.
enum Failure {
    /// No minimum was found.
    Lost,
    /// The caller asked to stop.
    Cancelled,
}

impl From<FactorError> for Failure {
    fn from(_: FactorError) -> Self {
        Self::Lost
    }
}

impl Implicit {
    /// Starts at the rest pose.
    pub fn new(problem: Problem, settings: ImplicitSettings) -> Self {
        let problem = problem.with_held_loads();
        let state = State::at_rest(problem.body());
        Self {
            grabs: Grabs::new(&problem),
            lagged: None,
            memory: QuasiNewtonMemory::default(),
            pressures: Pressures::new(problem.body()),
            viscosity: Viscosity::of_viscous(problem.body(), settings.retardation),
            before: None,
            stage: Stage::First,
            value: Value::default(),
            carried: vec![false; state.positions.len()],
            settled: true,
            met: false,
            pattern_changed: false,
            damping_rate: initial_rate(settings.damping),
            step: settings.step.clamp(STEPS[0], STEPS[1]),
            steps: 0,
            back_offs: 0,
            good: 0,
            excess: 0.0,
            residual: f64::INFINITY,
            status: LiveStatus::Moving,
            breakdown: None,
            travel_limit: travel_limit(&problem),
            shortest_edge: shortest_edge(&problem),
            state,
            problem,
            settings,
        }
    }

    /// Minimizes the potential of a step.
    fn minimize(
        &mut self,
        goal: Goal<'_>,
        go_on: &mut dyn FnMut(Ask) -> bool,
    ) -> Result<(Vec<Vec3>, Value), Failure> {
        let Goal { inertia, .. } = goal;
        let (mut positions, mut value, mut bound) = self.first_guess(goal);
        self.settled = true;
        self.met = self.touches(&positions);
        let mut rounds = 0;
        let mut searches = 0;
        let mut fresh = false;
        let (least, most, rough) = self.patience();
        loop {
            if !self.lagged.as_ref().is_some_and(Lagged::is_assembled) {
                self.assemble(&positions, goal, Tangent::Exact)?;
                fresh = true;
            }
            let springs = self.springs(inertia, goal.grabs);
            let lagged = self.lagged.as_mut().expect("assembled above");
            if !lagged.serves(inertia, INERTIA_RANGE) || !lagged.patch(&springs) {
                if !go_on(Ask::Within) {
                    return Err(Failure::Cancelled);
                }
                if !lagged.factorize(inertia, &springs)? {
                    // Indefinite by compression or swelling: without the geometric stiffness it is positive definite.
                    let (time, within) = (goal.time, goal.within);
                    let tangent = Tangent::Stressless;
                    lagged.assemble(&self.problem, &positions, time, within, tangent);
                    lagged.factorize_lifted(inertia, &springs)?;
                }
                self.memory.clear();
            }
            if !value.potential.is_finite() {
                return Err(Failure::Lost);
            }
            let mut search = Search {
                objective: Objective {
                    problem: &self.problem,
                    goal,
                },
                lagged,
                memory: &mut self.memory,
                carried: &self.carried,
                tolerance: Tolerance {
                    from: &self.state.positions,
                    free: goal.free,
                    least,
                    rough,
                },
            };
            let (end, moves) = search.run(&mut positions, &mut value, most, go_on);
            self.met |= self.touches(&positions);
            if !fresh {
                self.excess += f64::from(moves.saturating_sub(2));
            }
            match end {
                End::Cancelled => return Err(Failure::Cancelled),
                End::Found | End::Rough => {
                    if end == End::Rough {
                        self.excess = f64::INFINITY;
                    }
                    rounds += 1;
                    let changed = self.touch_floor(&mut positions, &value);
                    if changed {
                        let problem = &self.problem;
                        Objective { problem, goal }.evaluate(&positions, &mut value);
                    }
                    let mut faced =
                        self.faces_other(goal, &positions, &mut value) && rounds <= FACING_ROUNDS;
                    if rounds <= DEEP_ROUNDS {
                        faced |= self.stiffens(goal, &positions, &mut value);
                    }
                    if faced {
                        self.met = true;
                        bound = self.stay_where_better(goal, &mut positions, &mut value);
                    }
                    if !(changed && rounds <= FLOOR_ROUNDS || faced) {
                        break;
                    }
                    continue;
                }
                End::Slow | End::Stuck => {}
            }
            searches += 1;
            let contact = self.problem.contact().is_some();
            let hopeless = searches > SEARCHES_IN_CONTACT || (fresh && end == End::Stuck);
            if contact && hopeless {
                self.settled = false;
                self.met = true;
                self.faces_other(goal, &positions, &mut value);
                if value.potential <= bound {
                    break;
                }
                return Err(Failure::Lost);
            }
            if searches > MOST_SEARCHES || (fresh && end == End::Stuck) {
                return Err(Failure::Lost);
            }
            self.faces_other(goal, &positions, &mut value);
            self.assemble(&positions, goal, Tangent::Stressless)?;
            fresh = true;
        }
        if self.excess > self.lagged.as_ref().map_or(0.0, Lagged::factor_cost) {
            // A fresh tangent for the next step.
            self.assemble(&positions, goal, Tangent::Exact)?;
        }
        Ok((positions, value))
    }

    /// Assembles the tangent at `positions`, for which the facing of contact is up to date.
    fn assemble(
        &mut self,
        positions: &[Vec3],
        goal: Goal<'_>,
        tangent: Tangent,
    ) -> Result<(), Failure> {
        let problem = &self.problem;
        let lagged = match &mut self.lagged {
            Some(lagged) if !self.pattern_changed => lagged,
            lagged => lagged.insert(Lagged::new(problem, LINEAR_OPTIONS)?),
        };
        self.pattern_changed = false;
        lagged.assemble(problem, positions, goal.time, goal.within, tangent);
        self.excess = 0.0;
        Ok(())
    }

    /// Translates a body without any support until all forces on it account for its momentum: the search ends before
    /// they do to the last digit.
    fn keep_momentum(&self, inertia: f64, positions: &mut [Vec3], value: &Value) {
        let held = self.problem.held().as_flattened().contains(&true);
        if held || self.carried.contains(&true) || !self.grabs.all().is_empty() {
            return;
        }
        let left = value.net.iter().fold([0.0; 3], |sum, f| add(sum, *f));
        let part = 1.0 / (inertia * self.problem.body().total_mass());
        for x in positions {
            axpy(x, part, left);
        }
    }

    /// Wakes the run after a change: the body may move again.
    fn wake(&mut self) {
        if self.status == LiveStatus::Diverged {
            self.step = self.settings.step;
            self.back_offs = 0;
        }
        self.status = LiveStatus::Moving;
        self.breakdown = None;
    }

    fn start_from(&mut self, state: State) {
        self.pressures = Pressures::at(self.problem.body(), &state.positions);
        self.state = state;
        self.before = None;
        self.stage = Stage::First;
        self.met = false;
        if let Some(contact) = self.problem.contact_mut() {
            contact.reset(&self.state.positions);
        }
        self.problem.start_loads();
        self.value = Value::default();
        self.carried.fill(false);
        if let Some(viscosity) = &mut self.viscosity {
            viscosity.restart();
        }
        self.damping_rate = initial_rate(self.settings.damping);
        self.residual = f64::INFINITY;
        self.memory.clear();
        // The tangent is that of the state from which the next step starts, independent of earlier ones.
        if let Some(lagged) = &mut self.lagged {
            lagged.forget();
        }
        self.excess = 0.0;
        self.wake();
    }
}

fn initial_rate(damping: Damping) -> f64 {
    match damping {
        Damping::Rate(rate) => rate,
        Damping::Critical => 0.0,
    }
}
