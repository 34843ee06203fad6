//! Implicit dynamics with contact.
//!
//! The end of a step is an equilibrium of the body, its loads and its contact with the forces of inertia, by the
//! second-order backward difference formula ([`crate::implicit::scheme`]):
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
mod step;

use std::ops::ControlFlow;
use std::sync::Arc;

use voxsoft_solid::breakdown::{Breakdown, travel_limit};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Damping, Load, Memory, Observer, Problem, Progress, Solution, Solver, State, Status, Term,
};

use self::energy::Now;
use crate::equilibrium::{Equilibrium, Failure};
use crate::implicit::scheme::{FIRST_PART, SECOND_OVER_FIRST, Stage};
use crate::inertia::Inertia;
use crate::settings::LinearSolver;
use crate::system::{FactorError, Means};

/// Most halvings of a step before a run counts as diverged.
const MAX_BACK_OFFS: u32 = 10;
/// Successful steps after which a halved one is doubled again.
const PATIENCE: u32 = 3;
/// Relative distance from the next record within which a step is extended to it.
const SAME_TIME: f64 = 1e-9;

/// Settings of implicit dynamics with contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transient {
    /// Length of a step in s.
    pub step: f64,
    /// Damping of all motion.
    pub damping: Damping,
    /// Tolerance of rest: of the relative residual force, and of the kinetic energy over the elastic energy.
    pub tolerance: f64,
    /// End time in s, reached exactly; `None` runs to rest.
    pub end_time: Option<f64>,
    /// Time in s after which a run that does not come to rest is given up.
    pub max_time: f64,
    /// Time between two records in s, which steps do not exceed.
    pub record_interval: Option<f64>,
    /// Most bytes of the tangent.
    pub memory: u64,
}

impl Default for Transient {
    fn default() -> Self {
        Self {
            step: 0.01,
            damping: Damping::Rate(0.0),
            tolerance: 1e-4,
            end_time: None,
            max_time: 60.0,
            record_interval: None,
            memory: u64::MAX,
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
        let inertia = Arc::new(Inertia::new(problem.body().masses()));
        let mut problem = problem.clone().with_held_loads();
        if let Some(contact) = problem.contact_mut() {
            contact.start(&start.positions);
        }
        problem.start_loads();
        problem.begin(start.time);
        problem.start_fluid(&start.positions, Some(start.time));
        let moving = problem
            .clone()
            .with_term(Arc::clone(&inertia) as Arc<dyn Term>);
        let moving = moving.expect("inertia has the vertices of its body");
        let means = Means {
            solver: LinearSolver::Auto,
            memory: self.memory,
        };
        let equilibrium = match Equilibrium::new(moving, means) {
            Ok(equilibrium) => equilibrium,
            Err(error) => return refused(start, problem.memory(), error),
        };
        let run = Run {
            travel_limit: travel_limit(&problem),
            problem,
            settings: self,
            equilibrium: Equilibrium {
                inertia: Some(&inertia),
                ..equilibrium
            },
            inertia: &inertia,
            now: Now::default(),
            before: None,
            stage: Stage::First,
            begun: None,
            damping_rate: match self.damping {
                Damping::Rate(rate) => rate,
                Damping::Critical => 0.0,
            },
            step: self.step,
            good: 0,
            steps: 0,
            back_offs: 0,
            state: start,
        };
        run.go(observer)
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

struct Run<'a> {
    /// Problem without inertia, which that of `equilibrium` has.
    problem: Problem,
    settings: &'a Transient,
    equilibrium: Equilibrium<'a>,
    inertia: &'a Inertia,
    state: State,
    now: Now,
    /// State one step ago.
    before: Option<State>,
    stage: Stage,
    /// Forces and energies at the beginning of the step of which the state is the first stage.
    begun: Option<Now>,
    damping_rate: f64,
    step: f64,
    /// Successful steps since the last halving.
    good: u32,
    steps: u64,
    back_offs: u32,
    travel_limit: f64,
}

impl Run<'_> {
    fn go(mut self, observer: &mut Observer<'_>) -> Solution {
        let mut recorded = -1i64;
        self.now = self.look_at(&self.state);
        loop {
            let residual = self.residual();
            let slot = self.settings.record_interval;
            let slot = slot.map_or(-1, |each| {
                (self.state.time / each + SAME_TIME).floor() as i64
            });
            let progress = Progress {
                problem: &self.problem,
                steps: self.steps,
                time: self.state.time,
                positions: &self.state.positions,
                velocities: &self.state.velocities,
                residual,
                record: slot > recorded,
            };
            recorded = recorded.max(slot);
            if let ControlFlow::Break(()) = observer(&progress) {
                return self.ended(Status::Cancelled, residual, None);
            }
            match self.settings.end_time {
                Some(end) if self.state.time >= end * (1.0 - 1e-12) => {
                    return self.ended(Status::EndTime, residual, None);
                }
                None if self.is_at_rest(residual) => {
                    return self.ended(Status::AtRest, residual, None);
                }
                None if self.state.time >= self.settings.max_time => {
                    return self.ended(Status::NotAtRest, residual, None);
                }
                _ => {}
            }
            if let Err(failure) = self.take_step(recorded, observer) {
                return match failure {
                    Stop::Gone(place) => self.ended(Status::Diverged, residual, Some(place)),
                    Stop::Failed(Failure::Memory(bytes)) => {
                        self.ended(Status::OutOfMemory(bytes), residual, None)
                    }
                    Stop::Failed(Failure::Cancelled) => {
                        self.ended(Status::Cancelled, residual, None)
                    }
                    Stop::Failed(_) => {
                        let State {
                            positions, time, ..
                        } = &self.state;
                        let place = Breakdown::farthest(&self.problem, positions, *time);
                        self.ended(Status::Diverged, residual, Some(place))
                    }
                };
            }
        }
    }

    fn ended(self, status: Status, residual: f64, breakdown: Option<Breakdown>) -> Solution {
        Solution {
            memory: self.problem.memory(),
            state: self.state,
            status,
            residual,
            steps: self.steps,
            back_offs: self.back_offs,
            breakdown,
        }
    }

    /// Takes one step, halved repeatedly if a whole one fails.
    fn take_step(&mut self, recorded: i64, observer: &mut Observer<'_>) -> Result<(), Stop> {
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
            self.go_back();
            let hopeless = matches!(
                failure,
                Stop::Failed(Failure::Memory(_) | Failure::Cancelled)
            );
            self.step = whole / 2.0;
            if self.stage == Stage::Second {
                self.stage = Stage::Later;
                self.begun = None;
            }
            if hopeless || self.step < least {
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
            self.go_back();
        }
        let (next, found) = self.find(step, None, observer)?;
        self.accept(next, found)
    }

    /// Resets the memory of contact to the last accepted state.
    fn go_back(&mut self) {
        if let Some(contact) = self.problem.contact_mut() {
            contact.go_back();
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
        self.equilibrium.problem.remember_but_contact(&self.problem);
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

/// Reasons for an early end of a run.
enum Stop {
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
