//! Implicit dynamics with contact.
//!
//! The end of a step is an equilibrium of the body, its loads and its contact with the forces of inertia, by the
//! second-order backward difference formula ([`crate::motion::implicit::scheme`]):
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
mod motion;
mod step;
mod stepper;

use std::ops::ControlFlow;

use voxsoft_solid::breakdown::Breakdown;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Damping, Memory, Observer, Problem, Progress, Solution, Solver, State, Status,
};

pub use self::motion::Motion;
use self::motion::{SAME_TIME, Stop};
use crate::linear::error::FactorError;
use crate::path::equilibrium::Failure;

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
            retardation: 0.0,
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
        match Motion::from_state(problem.clone(), *self, start) {
            Ok(motion) => motion.go(observer),
            Err((error, problem, start)) => refused(start, problem.memory(), error),
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

impl Motion {
    fn go(mut self, observer: &mut Observer<'_>) -> Solution {
        let mut recorded = -1i64;
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
}
