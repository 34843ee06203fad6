//! What brings a problem to where it was asked to go, by whatever method.

use std::ops::ControlFlow;

use crate::vector::Vec3;
use crate::{Breakdown, Memory, Problem, State};

/// How a solution ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Equilibrium under all that was asked.
    AtRest,
    /// The end time was reached, as asked.
    EndTime,
    /// A trial showed that the body comes to rest slowly.
    Slow,
    /// Steps or time ran out before the body came to rest.
    NotAtRest,
    /// The step was backed off as far as allowed and the body still flew apart.
    Diverged,
    /// The load path has a limit: no equilibrium near it carries more.
    LimitReached,
    /// No equilibrium was found for the smallest step, and no limit explains it.
    NotConverged,
    /// The tangent stays singular: a part of the body moves freely.
    Mechanism,
    /// The tangent takes more memory than there is: about this many bytes, or zero where only the
    /// allocation showed it.
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

/// What an observer is shown now and then.
#[derive(Debug)]
pub struct Progress<'a> {
    /// The problem with its memory there.
    pub problem: &'a Problem,
    /// Steps or iterations so far.
    pub steps: u64,
    /// The time in s; for statics, which knows none, the load factor.
    pub time: f64,
    /// The current positions in m.
    pub positions: &'a [Vec3],
    /// The current velocities in m/s; none for statics.
    pub velocities: &'a [Vec3],
    /// The residual force without units.
    pub residual: f64,
    /// Whether this is to be recorded: an instant of the recording, or a converged point of a load path.
    pub record: bool,
}

/// Called now and then during a solution; `Break` cancels it.
pub type Observer<'a> = dyn FnMut(&Progress<'_>) -> ControlFlow<()> + 'a;

/// The last good state and how it was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The last good state.
    pub state: State,
    /// The memory of the problem there, besides contact.
    pub memory: Memory,
    /// How it ended.
    pub status: Status,
    /// The residual force without units, see [`crate::balance::Balance::relative_residual`].
    pub residual: f64,
    /// Steps or iterations taken, repeated ones counted.
    pub steps: u64,
    /// How often a step was cut.
    pub back_offs: u32,
    /// Where and when it broke down, for [`Status::Diverged`].
    pub breakdown: Option<Breakdown>,
}

/// A way to the answer; its settings are the solver.
///
/// [`crate::conformance::check_solver`] holds every solver to what is promised here.
pub trait Solver {
    /// What it is called.
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
