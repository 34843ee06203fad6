use std::ops::ControlFlow;

use voxsoft_solid::{Breakdown, State};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Residual force and speed fell below the tolerance.
    AtRest,
    /// The end time was reached, as asked.
    EndTime,
    /// A trial showed that the body comes to rest slowly, see [`crate::relaxation::Trial`].
    Slow,
    /// Steps or time ran out before the body came to rest.
    NotAtRest,
    /// The step was backed off as far as allowed and the body still flew apart.
    Diverged,
    /// The observer asked to stop.
    Cancelled,
}

/// The answer of a run: the last good state and how it was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The last good state.
    pub state: State,
    /// How the run ended.
    pub status: Status,
    /// The residual force without units, see [`voxsoft_solid::balance::Balance`].
    pub residual: f64,
    /// Substeps (dynamics) or steps (relaxation) taken, repeated ones counted.
    pub steps: u64,
    /// How often the step was halved.
    pub back_offs: u32,
    /// The last substep in s; zero for relaxation, which has no physical time.
    pub substep: f64,
    /// Where and when it broke down, for [`Status::Diverged`].
    pub breakdown: Option<Breakdown>,
}

/// What an observer is told now and then.
#[derive(Debug)]
pub struct Progress<'a> {
    /// Steps so far.
    pub steps: u64,
    /// The current state.
    pub state: &'a State,
    /// The residual force without units.
    pub residual: f64,
    /// Whether the state falls on the recording grid of [`crate::Dynamics::record_interval`].
    pub record: bool,
}

/// Called now and then during a run; `Break` cancels it.
pub type Observer<'a> = dyn FnMut(&Progress<'_>) -> ControlFlow<()> + 'a;

/// How often the step may be halved before a run counts as diverged.
pub(crate) const MAX_BACK_OFFS: u32 = 10;

/// A residual this many times the loads and reactions is no motion that they could cause. Unstable
/// steps pass 1e3 within a few dozen steps; the sound transients in the tests stay under 10.
pub(crate) const BLOW_UP_EXCESS: f64 = 300.0;
