//! Interface of steppers, which move a problem through time while its caller changes loads and pulls at it.

use std::any::Any;

use crate::breakdown::Breakdown;
use crate::loads::grabs::Grab;
use crate::vector::Vec3;
use crate::{History, Input, Memory, Problem, ProblemError, State};

/// Damping of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Velocities decay with this rate in 1/s.
    Rate(f64),
    /// Critical damping of the slowest motion seen, estimated during the run: comes to rest soonest, but the motion is
    /// not the real one.
    Critical,
}

/// Status of a live run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LiveStatus {
    /// The body moves.
    Moving,
    /// Nothing moves until loads or grabs change: further steps cost nothing.
    AtRest,
    /// The step was reduced as far as allowed and the body still blew up. The state is the last good one and stays
    /// until loads or grabs change.
    Diverged,
    /// A step takes about this many bytes, which is more memory than there is. The state stays until loads or grabs
    /// change.
    OutOfMemory(u64),
}

/// Summary of a run after an advance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// The status of the run.
    pub status: LiveStatus,
    /// The time of the run in s.
    pub time: f64,
    /// The length of a step in s.
    pub substep: f64,
    /// Steps taken since the start, repeated ones counted.
    pub substeps: u64,
    /// Number of times that the step was halved.
    pub back_offs: u32,
    /// The relative residual, without unit, grabs counted as loads.
    pub residual: f64,
    /// The elastic energy in J.
    pub elastic: f64,
    /// The kinetic energy in J.
    pub kinetic: f64,
    /// Place and time of the breakdown, for [`LiveStatus::Diverged`].
    pub breakdown: Option<Breakdown>,
    /// Set if the last step converged; contact may need more iterations than there is time for.
    pub settled: bool,
}

/// Moment at which a run asks whether to continue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// Within a step, which is abandoned if the answer is no.
    Within,
    /// After a step.
    After,
}

/// Time integration method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Explicit: many short steps, limited by the highest frequency.
    Explicit,
    /// Implicit: steps of any length, each of which solves for its end.
    Implicit,
}

/// A problem in motion, whatever the method.
pub trait Stepper: Send + Any {
    /// Access to the concrete stepper, to be downcast by callers that know its type.
    fn as_any(&mut self) -> &mut dyn Any;

    /// The time integration method.
    fn method(&self) -> Method;

    /// The problem, with the loads as they are now.
    fn problem(&self) -> &Problem;

    /// The state at the end of the last advance.
    fn state(&self) -> &State;

    /// The length of a step in s.
    fn step(&self) -> f64;

    /// Requests steps of another length in s; a method limited by stability keeps its own.
    fn prefer_step(&mut self, seconds: f64);

    /// Takes up to so many steps, fewer if it comes to rest or diverges, or as soon as `go_on` returns `false`.
    fn advance_while(&mut self, steps: u32, go_on: &mut dyn FnMut(Ask) -> bool) -> Look;

    /// Takes steps until a time (s), which the last one meets exactly unless stability sets their length; fewer if it
    /// comes to rest or diverges, or as soon as `go_on` returns `false`.
    fn advance_to(&mut self, time: f64, go_on: &mut dyn FnMut(Ask) -> bool) -> Look;

    /// Takes up to so many steps, fewer if it comes to rest or diverges.
    fn advance(&mut self, steps: u32) -> Look {
        self.advance_while(steps, &mut |_| true)
    }

    /// Sets a load to `factor` times its final value, at once and for good; `None` restores its own history.
    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError>;

    /// Replaces the courses of inputs over time, from the next step on. After an error some may have been replaced.
    fn command(&mut self, inputs: &[(Input, History)]) -> Result<(), ProblemError>;

    /// Pulls a vertex toward a point (m) by a spring of the given stiffness (N/m), any above zero. A grab
    /// of the same number takes a new target and a new stiffness, or a new vertex.
    fn grab(
        &mut self,
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), ProblemError>;

    /// Releases a grab; returns whether it existed.
    fn release(&mut self, number: u32) -> bool;

    /// All grabs with their numbers.
    fn grabs(&self) -> &[(u32, Grab)];

    /// Resets to the rest pose at time zero. Grabs are released; loads stay as they were set.
    fn reset(&mut self);

    /// Continues from other positions (m), without velocity, at `time` (s). Grabs are released.
    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError>;

    /// The memory at the state: that of the problem, and the past of a motion whose next step depends on it.
    fn memory(&self) -> Memory {
        self.problem().memory()
    }

    /// Continues from another state, velocities included, with the memory ([`Stepper::memory`]) that a stepper of the
    /// same problem had there: to the same bits each time. Grabs are released; loads stay as they are set.
    fn resume(&mut self, state: State, memory: &Memory) -> Result<(), ProblemError>;
}
