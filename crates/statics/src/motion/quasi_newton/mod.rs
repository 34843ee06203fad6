//! Quick search for the end of a step: motion of rubber while a user pulls at it.
//!
//! A step of a frame's length is the minimum of a potential, because the second-order backward difference formula
//! ([`crate::motion::scheme`]) makes the equation of motion at its end
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
mod factorized;
mod floor;
mod guess;
mod inverse;
mod lagged;
mod line;
mod minimize;
mod objective;
mod pairs;
mod preconditioned;
mod pressures;
mod search;
mod turns;

use voxsoft_solid::element::hex8::Tangent;
use voxsoft_solid::vector::{Vec3, add, axpy};
use voxsoft_solid::{Body, Problem, State};

use self::contact::{DEEP_ROUNDS, FACING_ROUNDS, patience, stiffens, touches};
use self::lagged::Lagged;
use self::minimize::{End, Search, Tolerance};
use self::objective::{Goal, Objective, Value};
use self::pairs::QuasiNewtonMemory;
use self::pressures::Pressures;
use super::integrator::{Asker, Integrator, Stop};
use super::run::{ImplicitSettings, Run};
use super::stepper::STEPS;
use crate::linear::options::LinearOptions;

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
/// Rounds of a step in which vertices may touch the floor or leave it.
const FLOOR_ROUNDS: u32 = 3;

/// Quasi-Newton steps with a lagged tangent.
pub struct QuasiNewton {
    /// Tangent, created at the first step, which reports errors.
    lagged: Option<Lagged>,
    memory: QuasiNewtonMemory,
    pressures: Pressures,
    /// Potential, energy and forces at the end of the step that was solved last.
    found: Value,
    /// Vertices that the floor carries.
    carried: Vec<bool>,
    /// True if the last step was minimized to its tolerance.
    settled: bool,
    /// True if any sample was pressed during the last step, at its end or on the way there.
    met: bool,
    /// True if contact pairs have changed beyond the sparsity pattern of the tangent.
    pattern_changed: bool,
    /// Moves that the present factor has cost beyond those of a fresh one.
    excess: f64,
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
pub type Implicit = Integrator<QuasiNewton>;

impl Implicit {
    /// Starts at the rest pose.
    pub fn new(problem: Problem, settings: ImplicitSettings) -> Self {
        let start = State::at_rest(problem.body());
        let step = settings.step.clamp(STEPS[0], STEPS[1]);
        let run = Run::new(problem, ImplicitSettings { step, ..settings }, start);
        let search = QuasiNewton::new(run.problem.body());
        Self::begun(run, search)
    }
}

impl QuasiNewton {
    fn new(body: &Body) -> Self {
        Self {
            lagged: None,
            memory: QuasiNewtonMemory::default(),
            pressures: Pressures::new(body),
            found: Value::default(),
            carried: vec![false; body.rest().len()],
            settled: true,
            met: false,
            pattern_changed: false,
            excess: 0.0,
        }
    }

    /// Minimizes the potential of a step.
    fn minimize(
        &mut self,
        run: &mut Run,
        goal: Goal<'_>,
        asker: &mut Asker<'_>,
    ) -> Result<(Vec<Vec3>, Value), Stop> {
        let Goal { inertia, .. } = goal;
        let (mut positions, mut value, mut bound) = self.first_guess(run, goal);
        self.settled = true;
        self.met = touches(&run.problem, &positions);
        let mut rounds = 0;
        let mut searches = 0;
        let mut fresh = false;
        let (least, most, rough) = patience(run);
        loop {
            if !self.lagged.as_ref().is_some_and(Lagged::is_assembled) {
                self.assemble(run, &positions, goal, Tangent::Exact)?;
                fresh = true;
            }
            let springs = self.springs(run, inertia, goal.grabs);
            let lagged = self.lagged.as_mut().expect("assembled above");
            if !lagged.serves(inertia, INERTIA_RANGE) || !lagged.patch(&springs) {
                if !asker(None) {
                    return Err(Stop::Cancelled);
                }
                if !lagged.factorize(inertia, &springs)? {
                    // Indefinite by compression or swelling: without the geometric stiffness it is positive definite.
                    let (time, within) = (goal.time, goal.within);
                    let tangent = Tangent::Stressless;
                    lagged.assemble(&run.problem, &positions, time, within, tangent);
                    lagged.factorize_lifted(inertia, &springs)?;
                }
                self.memory.clear();
            }
            if !value.potential.is_finite() {
                return Err(Stop::Lost);
            }
            let mut search = Search {
                objective: Objective {
                    problem: &run.problem,
                    goal,
                },
                lagged,
                memory: &mut self.memory,
                carried: &self.carried,
                tolerance: Tolerance {
                    from: &run.state.positions,
                    free: goal.free,
                    least,
                    rough,
                },
            };
            let (end, moves) = search.run(&mut positions, &mut value, most, asker);
            self.met |= touches(&run.problem, &positions);
            if !fresh {
                self.excess += f64::from(moves.saturating_sub(2));
            }
            match end {
                End::Cancelled => return Err(Stop::Cancelled),
                End::Found | End::Rough => {
                    if end == End::Rough {
                        self.excess = f64::INFINITY;
                    }
                    rounds += 1;
                    let changed = self.touch_floor(&run.problem, &mut positions, &value);
                    if changed {
                        let problem = &run.problem;
                        Objective { problem, goal }.evaluate(&positions, &mut value);
                    }
                    let mut faced = self.faces_other(run, goal, &positions, &mut value)
                        && rounds <= FACING_ROUNDS;
                    if rounds <= DEEP_ROUNDS {
                        faced |= stiffens(run, goal, &positions, &mut value);
                    }
                    if faced {
                        self.met = true;
                        bound = self.stay_where_better(run, goal, &mut positions, &mut value);
                    }
                    if !(changed && rounds <= FLOOR_ROUNDS || faced) {
                        break;
                    }
                    continue;
                }
                End::Slow | End::Stuck => {}
            }
            searches += 1;
            let contact = run.problem.contact().is_some();
            let hopeless = searches > SEARCHES_IN_CONTACT || (fresh && end == End::Stuck);
            if contact && hopeless {
                self.settled = false;
                self.met = true;
                self.faces_other(run, goal, &positions, &mut value);
                if value.potential <= bound {
                    break;
                }
                return Err(Stop::Lost);
            }
            if searches > MOST_SEARCHES || (fresh && end == End::Stuck) {
                return Err(Stop::Lost);
            }
            self.faces_other(run, goal, &positions, &mut value);
            self.assemble(run, &positions, goal, Tangent::Stressless)?;
            fresh = true;
        }
        if self.excess > self.lagged.as_ref().map_or(0.0, Lagged::factor_cost) {
            // A fresh tangent for the next step.
            self.assemble(run, &positions, goal, Tangent::Exact)?;
        }
        Ok((positions, value))
    }

    /// Assembles the tangent at `positions`, for which the facing of contact is up to date.
    fn assemble(
        &mut self,
        run: &Run,
        positions: &[Vec3],
        goal: Goal<'_>,
        tangent: Tangent,
    ) -> Result<(), Stop> {
        let problem = &run.problem;
        let options = LinearOptions {
            solver: run.settings.linear,
            memory: run.settings.memory,
        };
        let lagged = match &mut self.lagged {
            Some(lagged) if !self.pattern_changed => lagged,
            lagged => lagged.insert(Lagged::new(problem, options)?),
        };
        self.pattern_changed = false;
        lagged.assemble(problem, positions, goal.time, goal.within, tangent);
        self.excess = 0.0;
        Ok(())
    }

    /// Translates a body without any support until all forces on it account for its momentum: the search ends before
    /// they do to the last digit.
    fn keep_momentum(&self, run: &Run, inertia: f64, positions: &mut [Vec3], value: &Value) {
        let held = run.problem.held().as_flattened().contains(&true);
        if held || self.carried.contains(&true) || !run.grabs.all().is_empty() {
            return;
        }
        let left = value.net.iter().fold([0.0; 3], |sum, f| add(sum, *f));
        let part = 1.0 / (inertia * run.problem.body().total_mass());
        for x in positions {
            axpy(x, part, left);
        }
    }
}
