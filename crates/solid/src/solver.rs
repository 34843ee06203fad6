//! Interface of solvers, whatever their method.

use std::ops::ControlFlow;

use crate::vector::Vec3;
use crate::{Breakdown, Memory, Problem, State};

/// Outcome of a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Equilibrium under all loads and motions.
    AtRest,
    /// The prescribed end time was reached.
    EndTime,
    /// A trial showed that the body comes to rest slowly.
    Slow,
    /// Steps or time ran out before the body came to rest.
    NotAtRest,
    /// The step was reduced as far as allowed and the body still blew up.
    Diverged,
    /// The load path has a limit point: no equilibrium near it carries more.
    LimitReached,
    /// No equilibrium was found for the smallest step, and no limit point explains it.
    NotConverged,
    /// The tangent stiffness stays singular: a part of the body moves freely.
    Mechanism,
    /// The tangent stiffness takes more memory than there is: about this many bytes, or zero where only the allocation
    /// showed it.
    OutOfMemory(u64),
    /// The observer asked to stop.
    Cancelled,
}

impl Status {
    /// Its name, which everything outside the core uses.
    pub fn name(self) -> &'static str {
        match self {
            Self::AtRest => "at-rest",
            Self::EndTime => "end-time",
            Self::Slow => "slow",
            Self::NotAtRest => "not-at-rest",
            Self::Diverged => "diverged",
            Self::LimitReached => "limit-reached",
            Self::NotConverged => "not-converged",
            Self::Mechanism => "mechanism",
            Self::OutOfMemory(_) => "out-of-memory",
            Self::Cancelled => "cancelled",
        }
    }
}

/// State of a solution in progress, as passed to an observer.
#[derive(Debug)]
pub struct Progress<'a> {
    /// The problem with its present memory.
    pub problem: &'a Problem,
    /// Steps or iterations so far.
    pub steps: u64,
    /// The time in s; for statics, the load factor.
    pub time: f64,
    /// The current positions in m.
    pub positions: &'a [Vec3],
    /// The current velocities in m/s; none for statics.
    pub velocities: &'a [Vec3],
    /// The relative residual, without unit.
    pub residual: f64,
    /// Set if this state is to be recorded: an instant of the recording, or a converged point of a load path.
    pub record: bool,
}

/// Called now and then during a solution; `Break` cancels it.
pub type Observer<'a> = dyn FnMut(&Progress<'_>) -> ControlFlow<()> + 'a;

/// Result of a solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The last good state.
    pub state: State,
    /// The memory of the problem at that state, besides contact.
    pub memory: Memory,
    /// The outcome.
    pub status: Status,
    /// The relative residual, without unit, see [`crate::balance::Balance::relative_residual`].
    pub residual: f64,
    /// Steps or iterations taken, repeated ones counted.
    pub steps: u64,
    /// Number of step reductions.
    pub back_offs: u32,
    /// Place and time of the breakdown, for [`Status::Diverged`].
    pub breakdown: Option<Breakdown>,
}

/// A solver with its settings.
///
/// [`crate::conformance::check_solver`] checks these contracts for every solver.
pub trait Solver {
    /// The name of the solver.
    fn name(&self) -> &'static str;

    /// Solves from `start`, positions in m, or from the rest pose. A state whose status is
    /// [`Status::AtRest`] is an equilibrium under the final values of all loads and motions.
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution;
}
