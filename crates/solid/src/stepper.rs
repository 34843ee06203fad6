//! What moves a problem through time while someone changes its loads and pulls at it.

use crate::breakdown::Breakdown;
use crate::hands::Grab;
use crate::vector::Vec3;
use crate::{Problem, ProblemError, State};

/// How motion is damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Velocities decay with this rate in 1/s.
    Rate(f64),
    /// Critical for the slowest motion seen, estimated as the run goes: comes to rest soonest, says
    /// nothing about the real motion.
    Critical,
}

/// Whether a run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LiveStatus {
    /// The body moves.
    Moving,
    /// Nothing moves until something is changed: further steps cost nothing.
    AtRest,
    /// The step was backed off as far as allowed and the body still flew apart. The state is the last good
    /// one and stays until something is changed.
    Diverged,
}

/// What a look at a run shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Whether it goes on.
    pub status: LiveStatus,
    /// The time of the run in s.
    pub time: f64,
    /// The length of a step in s.
    pub substep: f64,
    /// Steps taken since the start, repeated ones counted.
    pub substeps: u64,
    /// How often the step was halved.
    pub back_offs: u32,
    /// The residual force without units, grabs counted as loads.
    pub residual: f64,
    /// The elastic energy in J.
    pub elastic: f64,
    /// The kinetic energy in J.
    pub kinetic: f64,
    /// Where and when it broke down, for [`LiveStatus::Diverged`].
    pub breakdown: Option<Breakdown>,
    /// Whether the last step was solved to its end; what touches may ask for more than there is time for.
    pub settled: bool,
}

/// When a run asks whether to go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// Within a step, which is given up if the answer is no.
    Within,
    /// After a step.
    After,
}

/// How a run goes from one step to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// By many short steps, whose length the highest frequency decides.
    Explicit,
    /// By steps of any length, each of which solves for its end.
    Implicit,
}

/// A problem in motion, whatever the method.
pub trait Stepper: Send {
    /// How it steps.
    fn method(&self) -> Method;

    /// The problem, with the loads as they are now.
    fn problem(&self) -> &Problem;

    /// The state at the end of the last advance.
    fn state(&self) -> &State;

    /// The length of a step in s.
    fn step(&self) -> f64;

    /// Asks for steps of another length in s; a method whose stability decides keeps its own.
    fn prefer_step(&mut self, seconds: f64);

    /// Takes as many steps, fewer if it comes to rest or diverges, or as soon as `go_on` says no.
    fn advance_while(&mut self, steps: u32, go_on: &mut dyn FnMut(Ask) -> bool) -> Look;

    /// Takes as many steps, fewer if it comes to rest or diverges.
    fn advance(&mut self, steps: u32) -> Look {
        self.advance_while(steps, &mut |_| true)
    }

    /// Makes a load `factor` times its final value, at once and for good; `None` gives it its own history
    /// back.
    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError>;

    /// Pulls a vertex toward a point (m) by a spring of the given stiffness (N/m), any above zero. A grab
    /// of the same number takes a new target and a new stiffness, or a new vertex.
    fn grab(
        &mut self,
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), ProblemError>;

    /// Lets go; whether there was such a grab.
    fn release(&mut self, number: u32) -> bool;

    /// All grabs with their numbers.
    fn grabs(&self) -> &[(u32, Grab)];

    /// Back to the rest pose at time zero. Grabs are let go; loads stay as they were set.
    fn reset(&mut self);

    /// Goes on from other positions (m), without velocity, at `time` (s). Grabs are let go.
    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError>;
}
