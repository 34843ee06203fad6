//! Interactive run that continues between calls, with changes of loads and grabs.

use std::any::Any;

use voxsoft_solid::breakdown::{Breakdown, Reach};
use voxsoft_solid::loads::grabs::{Grabs, checked_state, loads_end, shortest_edge, still_state};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{
    Ask, Grab, History, Input, LiveStatus, Look, Memory, Method, Problem, ProblemError, State,
    Stepper, elastic,
};

use super::stiff_inertia::StiffInertia;
use super::{Arrays, Dynamics, Subject, Window, arrays_of, at_rest, strips_of, substeps_of};
use crate::outcome::{BLOW_UP_EXCESS, MAX_BACK_OFFS, excess_in_motion};

/// Substeps between two checks for rest and breakdown.
const LOOK: u32 = 64;

/// Largest travel of an anchor in a substep, in shortest edges: a jump of the target then takes some dozen substeps,
/// invisible milliseconds, and inverts no element.
const ANCHOR_TRAVEL: f64 = 0.05;

/// Most halvings of the substep because the residual has stopped to fall: a trembling target or a rattling floor looks
/// the same, and more halvings would only make the run slow.
const MAX_STUCK: u32 = 3;

/// Interactive run of a problem by explicit substeps.
///
/// Takes the substeps of [`super::simulate`] and has its equilibrium; ignores `end_time`, `max_time` and
/// `record_interval` of the settings.
///
/// # Example
///
/// ```
/// use voxsoft_solid::{Body, Clamp, LatticeMaterial, LiveStatus, Load, Mesh, Problem, Stepper};
/// use voxsoft_xpbd::{Dynamics, Live};
///
/// let mesh = Mesh {
///     vertices: vec![[0.0; 3], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]],
///     tets: vec![[0, 1, 2, 3]],
///     tet_part: vec![0],
///     tet_block: vec![0],
///     ..Mesh::default()
/// };
/// let rubber = LatticeMaterial::from_moduli(25e3, 100e3, 1070.0)?;
/// let body = Body::new(&mesh, &[rubber])?;
/// let problem = Problem::new(body, vec![Clamp::fixed(vec![0, 1, 2])], vec![Load::gravity([0.0, 0.0, -9.81])], None)?;
/// let mut live = Live::new(problem, Dynamics::default());
/// while live.advance(100).status == LiveStatus::Moving {}
/// live.grab(0, 3, [0.0, 0.0, 0.02], 1.0)?;
/// assert_eq!(live.advance(1).status, LiveStatus::Moving);
/// assert!(live.state().positions[3][2] > 0.009);
/// # Ok::<(), voxsoft_solid::ProblemError>(())
/// ```
pub struct Live {
    problem: Problem,
    settings: Dynamics,
    grabs: Grabs,
    arrays: Box<dyn Arrays + Send>,
    /// Last good state, from the last check.
    state: State,
    first_substep: f64,
    substep: f64,
    substeps: u64,
    back_offs: u32,
    stuck: u32,
    window: Window,
    residual: f64,
    status: LiveStatus,
    breakdown: Option<Breakdown>,
    reach: Reach,
    shortest_edge: f64,
}

impl Live {
    /// Makes a run that starts at the rest pose.
    pub fn new(problem: Problem, settings: Dynamics) -> Self {
        let subject = Subject {
            problem: &problem,
            settings: &settings,
            grabs: &[],
        };
        let strips = strips_of(subject);
        let stiff = StiffInertia::of(&problem, &settings);
        let substeps = substeps_of(subject, strips.as_ref(), stiff.as_ref());
        let substep = settings.time_step / f64::from(substeps);
        let mut arrays = arrays_of(subject, strips, stiff);
        let state = State::at_rest(problem.body());
        arrays.load(&state);
        Self {
            grabs: Grabs::new(&problem),
            arrays,
            state,
            first_substep: substep,
            substep,
            substeps: 0,
            back_offs: 0,
            stuck: 0,
            window: Window::default(),
            residual: f64::INFINITY,
            status: LiveStatus::Moving,
            breakdown: None,
            reach: Reach::of(&problem),
            shortest_edge: shortest_edge(&problem),
            problem,
            settings,
        }
    }

    fn take_substep(&mut self) {
        let pulls = self.grabs.follow(ANCHOR_TRAVEL * self.shortest_edge);
        self.problem.begin(self.arrays.time() + self.substep);
        let subject = Subject {
            problem: &self.problem,
            settings: &self.settings,
            grabs: &pulls,
        };
        self.arrays.substep(subject, self.substep);
        self.substeps += 1;
    }

    /// Checks the present state: keeps it if it is good, else goes back to the last good one with half the substep.
    fn look(&mut self) {
        let mut now = self.state.clone();
        self.arrays.store(&mut now);
        self.problem.begin(now.time);
        let pulls: Vec<Grab> = self.grabs.all().iter().map(|(_, grab)| *grab).collect();
        let subject = Subject {
            problem: &self.problem,
            settings: &self.settings,
            grabs: &pulls,
        };
        let balance = self.arrays.balance(subject, &now);
        let broken = self.reach.find(&self.problem, &now.positions, now.time);
        let excess = excess_in_motion(&self.problem, &balance);
        if broken.is_some() || excess.is_nan() || excess > BLOW_UP_EXCESS {
            self.arrays.load(&self.state);
            if self.back_offs < MAX_BACK_OFFS {
                self.halve();
            } else {
                let place = broken.unwrap_or_else(|| {
                    Breakdown::farthest(&self.problem, &now.positions, now.time)
                });
                self.status = LiveStatus::Diverged;
                self.breakdown = Some(place);
            }
            return;
        }
        self.residual = balance.relative_residual();
        self.state = now;
        let tolerance = self.settings.tolerance;
        let settled = self.grabs.arrived() && self.state.time >= loads_end(&self.problem);
        if settled && at_rest(&self.problem, &self.state, self.residual, tolerance) {
            self.status = LiveStatus::AtRest;
        } else if settled
            && self.window.stuck(
                self.state.time,
                self.arrays.damping_rate(),
                self.residual,
                tolerance,
            )
            && self.stuck < MAX_STUCK
            && self.back_offs < MAX_BACK_OFFS
        {
            self.stuck += 1;
            self.halve();
        }
    }

    fn halve(&mut self) {
        self.back_offs += 1;
        self.substep /= 2.0;
        self.window = Window::default();
    }

    /// Resumes motion after a change; after a breakdown, with the first substep.
    fn wake(&mut self) {
        if self.status == LiveStatus::Diverged {
            self.substep = self.first_substep;
            (self.back_offs, self.stuck) = (0, 0);
        }
        self.status = LiveStatus::Moving;
        self.breakdown = None;
        self.window = Window::default();
    }

    fn start_from(&mut self, state: State) {
        self.arrays.load(&state);
        self.state = state;
        self.residual = f64::INFINITY;
        self.wake();
    }
}

impl Stepper for Live {
    fn as_any(&mut self) -> &mut dyn Any {
        self
    }

    fn method(&self) -> Method {
        Method::Explicit
    }

    fn problem(&self) -> &Problem {
        &self.problem
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn step(&self) -> f64 {
        self.substep
    }

    /// Ignores the request, as stability decides the substep.
    fn prefer_step(&mut self, _: f64) {}

    fn advance_while(&mut self, steps: u32, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        let mut left = steps;
        let mut more = true;
        while more && left > 0 && self.status == LiveStatus::Moving {
            let mut taken = 0;
            while more && taken < left.min(LOOK) {
                self.take_substep();
                taken += 1;
                more = go_on(Ask::After);
            }
            left -= taken;
            self.look();
        }
        let elastic = elastic::energy(self.problem.body(), &self.state.positions);
        Look {
            status: self.status,
            time: self.state.time,
            substep: self.substep,
            substeps: self.substeps,
            back_offs: self.back_offs,
            residual: self.residual,
            elastic,
            kinetic: self.state.kinetic_energy(self.problem.body().masses()),
            breakdown: self.breakdown,
            settled: true,
        }
    }

    fn advance_to(&mut self, time: f64, go_on: &mut dyn FnMut(Ask) -> bool) -> Look {
        let steps = ((time - self.arrays.time()) / self.substep).round();
        self.advance_while(steps.max(0.0) as u32, go_on)
    }

    fn set_load(&mut self, load: usize, factor: Option<f64>) -> Result<(), ProblemError> {
        self.grabs.set_load(&mut self.problem, load, factor)?;
        self.arrays.renew_loads(&self.problem);
        self.wake();
        Ok(())
    }

    fn command(&mut self, inputs: &[(Input, History)]) -> Result<(), ProblemError> {
        for (input, course) in inputs {
            self.problem.command(*input, course.clone())?;
        }
        self.arrays.renew_loads(&self.problem);
        self.wake();
        Ok(())
    }

    fn grab(
        &mut self,
        number: u32,
        vertex: u32,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), ProblemError> {
        let positions = &self.state.positions;
        self.grabs
            .grab(positions, number, vertex, target, stiffness)?;
        self.wake();
        Ok(())
    }

    fn release(&mut self, number: u32) -> bool {
        let released = self.grabs.release(number);
        if released {
            self.wake();
        }
        released
    }

    fn grabs(&self) -> &[(u32, Grab)] {
        self.grabs.all()
    }

    fn reset(&mut self) {
        self.grabs.release_all();
        self.substep = self.first_substep;
        (self.substeps, self.back_offs, self.stuck) = (0, 0, 0);
        self.start_from(State::at_rest(self.problem.body()));
    }

    fn seek(&mut self, positions: Vec<Vec3>, time: f64) -> Result<(), ProblemError> {
        let state = still_state(&self.problem, positions, time)?;
        self.grabs.release_all();
        self.start_from(state);
        Ok(())
    }

    fn resume(&mut self, state: State, memory: &Memory) -> Result<(), ProblemError> {
        let state = checked_state(&self.problem, state)?;
        self.grabs.release_all();
        self.problem.remember(memory);
        // Anew, as the old arrays keep the damping and viscous stress of another motion.
        let subject = Subject {
            problem: &self.problem,
            settings: &self.settings,
            grabs: &[],
        };
        let stiff = StiffInertia::of(&self.problem, &self.settings);
        self.arrays = arrays_of(subject, strips_of(subject), stiff);
        self.substep = self.first_substep;
        (self.back_offs, self.stuck) = (0, 0);
        self.start_from(state);
        Ok(())
    }
}
