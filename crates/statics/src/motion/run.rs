//! State of a motion between two steps, and a step to be found.

use voxsoft_solid::breakdown::{Breakdown, Reach};
use voxsoft_solid::loads::grabs::{Grabs, shortest_edge};
use voxsoft_solid::vector::{Vec3, axpy, sub};
use voxsoft_solid::{Damping, Grab, LiveStatus, Past, Problem, State, Velocities};

use super::scheme::{Stage, Start};
use crate::linear::options::LinearSolver;

/// Settings of a motion by implicit steps.
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
    /// Allowed error of a step, as the root of the mean square over all mass, in shortest edges of the body; steps with
    /// more are halved, down to an eighth. Infinite for steps that are never halved for it.
    pub accuracy: f64,
    /// Solver of the linear systems.
    pub linear: LinearSolver,
    /// Most bytes of the tangent.
    pub memory: u64,
}

impl Default for ImplicitSettings {
    fn default() -> Self {
        Self {
            step: 1.0 / 60.0,
            damping: Damping::Critical,
            retardation: 0.0,
            tolerance: 1e-4,
            accuracy: f64::INFINITY,
            linear: LinearSolver::Auto,
            memory: u64::MAX,
        }
    }
}

impl ImplicitSettings {
    /// Damping rate of the first step in 1/s.
    fn first_rate(&self) -> f64 {
        match self.damping {
            Damping::Rate(rate) => rate,
            Damping::Critical => 0.0,
        }
    }
}

/// Forces and energies at a state.
#[derive(Default, Clone)]
pub struct Now {
    /// Internal forces: all but loads, N.
    pub internal: Vec<Vec3>,
    /// Viscous part of these, N; empty without viscous stress, or where nobody asks.
    pub viscous: Vec<Vec3>,
    /// Loads, grabs included, N.
    pub external: Vec<Vec3>,
    /// Reactions of supports, inertia included, N; empty where nobody asks.
    pub reactions: Vec<Vec3>,
    /// Elastic energy in J.
    pub elastic: f64,
    /// Kinetic energy in J.
    pub kinetic: f64,
}

/// A motion between two steps.
pub struct Run {
    /// Problem without inertia.
    pub problem: Problem,
    pub settings: ImplicitSettings,
    pub grabs: Grabs,
    pub state: State,
    pub now: Now,
    /// State one step ago.
    pub before: Option<State>,
    /// Stage of the motion that comes next.
    pub stage: Stage,
    /// Present rate of damping in 1/s.
    pub damping_rate: f64,
    /// Length of the next step in s: that of the settings, or halved.
    pub step: f64,
    /// Successful steps since the last halving.
    pub good: u32,
    pub steps: u64,
    pub back_offs: u32,
    pub residual: f64,
    /// Estimated distance to rest along the last step, m.
    pub remaining: f64,
    pub status: LiveStatus,
    pub breakdown: Option<Breakdown>,
    pub reach: Reach,
    pub shortest_edge: f64,
}

impl Run {
    /// Starts a motion of a problem from a state.
    pub fn new(problem: Problem, settings: ImplicitSettings, start: State) -> Self {
        let problem = problem.with_held_loads();
        let mut run = Self {
            grabs: Grabs::new(&problem),
            now: Now::default(),
            before: None,
            stage: Stage::First,
            damping_rate: 0.0,
            step: settings.step,
            good: 0,
            steps: 0,
            back_offs: 0,
            residual: f64::INFINITY,
            remaining: 0.0,
            status: LiveStatus::Moving,
            breakdown: None,
            reach: Reach::of(&problem),
            shortest_edge: shortest_edge(&problem),
            state: State::at_rest(problem.body()),
            problem,
            settings,
        };
        run.start_from(start);
        run
    }

    /// Goes on from another state, with a memory as at the start.
    pub fn start_from(&mut self, start: State) {
        self.problem.start_viscosity(self.settings.retardation);
        if let Some(contact) = self.problem.contact_mut() {
            contact.reset(&start.positions);
        }
        self.problem.start_loads();
        self.problem.begin(start.time);
        let (positions, velocities) = (&start.positions, &start.velocities);
        let moving = || Velocities::of(positions, velocities, 1.0 / self.settings.step);
        self.problem.begin_motion(moving, positions);
        self.state = start;
        self.now = Now::default();
        self.before = None;
        self.stage = Stage::First;
        self.damping_rate = self.settings.first_rate();
        (self.step, self.good) = (self.settings.step, 0);
        (self.residual, self.remaining) = (f64::INFINITY, 0.0);
        self.wake();
    }

    /// Last steps, of a run that has taken one.
    pub fn past(&self) -> Past {
        Past {
            before: self.before.clone(),
            damping_rate: self.damping_rate,
            step: self.step,
            good: self.good,
            within: self.problem.body().hex8_term().within().map(<[_]>::to_vec),
            internal: self.now.internal.clone(),
            viscous: self.now.viscous.clone(),
            external: self.now.external.clone(),
            reactions: self.now.reactions.clone(),
            elastic: self.now.elastic,
            residual: self.residual,
            at_rest: self.status == LiveStatus::AtRest,
        }
    }

    /// Takes over the last steps of another run of the problem, which has led to the state.
    pub fn take_past(&mut self, past: &Past) {
        self.before.clone_from(&past.before);
        self.stage = Stage::Later;
        self.damping_rate = past.damping_rate;
        (self.step, self.good) = (past.step.min(self.settings.step), past.good);
        self.problem.set_within(past.within.clone());
        self.take_forces(past);
    }

    /// Takes over the forces of another run at the state, and whether it is at rest there.
    pub fn take_forces(&mut self, past: &Past) {
        self.now = Now {
            internal: past.internal.clone(),
            viscous: past.viscous.clone(),
            external: past.external.clone(),
            reactions: past.reactions.clone(),
            elastic: past.elastic,
            kinetic: self.state.kinetic_energy(self.problem.body().masses()),
        };
        self.residual = past.residual;
        if past.at_rest {
            self.status = LiveStatus::AtRest;
        }
    }

    /// Wakes the run after a change of loads or grabs: the body may move again.
    pub fn wake(&mut self) {
        if self.status == LiveStatus::Diverged {
            self.step = self.settings.step;
            self.back_offs = 0;
        }
        self.status = LiveStatus::Moving;
        self.breakdown = None;
    }

    /// Resets the memory of contact to the last accepted state.
    pub fn rollback(&mut self) {
        if let Some(contact) = self.problem.contact_mut() {
            contact.rollback();
        }
    }

    /// Extrapolates the motion over `step` seconds: with its acceleration since the state `before`, if that is given.
    pub fn extrapolated(&self, step: f64, before: Option<&State>) -> Vec<Vec3> {
        let mut positions = self.state.positions.clone();
        for (x, v) in positions.iter_mut().zip(&self.state.velocities) {
            axpy(x, step, *v);
        }
        if let Some(before) = before {
            let ratio = 0.5 * step * step / (self.state.time - before.time);
            let velocities = self.state.velocities.iter().zip(&before.velocities);
            for (x, (v, old)) in positions.iter_mut().zip(velocities) {
                axpy(x, ratio, sub(*v, *old));
            }
        }
        positions
    }
}

/// A step to be found.
pub struct Step {
    /// Length in s.
    pub length: f64,
    /// Time at the end in s.
    pub time: f64,
    /// True for the formula of second order, which looks back at the state before.
    pub second_order: bool,
    pub start: Start,
    /// Sum of its rate and the damping rate, 1/s.
    pub braked: f64,
    /// Grabs with their anchors at the end of the step.
    pub grabs: Vec<Grab>,
}

impl Step {
    /// Inertia per mass `κ` in 1/s².
    pub fn inertia(&self) -> f64 {
        self.start.rate * self.braked
    }
}
