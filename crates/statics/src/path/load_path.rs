//! Load path in progress: its state, its accepted points, and its end.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Contact, Observer, Progress, Status};

use crate::linear::error::FactorError;
use crate::path::equilibrium::{Equilibrium, Failure};
use crate::path::load_parameter::LoadParameter;
use crate::path::settings::{Answer, Control, PathPoint, Settings};

/// Most iterations of a step after which the next one may grow.
pub(crate) const EASY: u32 = 6;
/// Step of the load, or of the growth of a volume, across a snap.
pub(crate) const SNAP: f64 = 0.0125;

/// Most cuts on a path of steps to unstable states, before such a state is accepted: one that remains after that lies
/// past a bifurcation, not beside the path.
pub(crate) const UNSTABLE_CUTS: u32 = 5;

/// End of a path.
pub(crate) struct Ending {
    status: Status,
    limit: Option<f64>,
    /// See [`Answer::reached`].
    reached: f64,
}

impl Ending {
    pub fn status(&self) -> Status {
        self.status
    }

    /// See [`Answer::reached`].
    pub fn reached(&self) -> f64 {
        self.reached
    }

    pub fn new(status: Status, limit: Option<f64>, reached: f64) -> Self {
        Self {
            status,
            limit,
            reached,
        }
    }
}

/// Load path in progress.
pub(crate) struct Path<'a, 'b> {
    pub equilibrium: Equilibrium,
    pub positions: Vec<Vec3>,
    pub point: LoadParameter,
    pub points: Vec<PathPoint>,
    /// Load factors at which it snapped ([`crate::path::snap`]).
    pub snaps: Vec<f64>,
    pub observer: &'a mut Observer<'b>,
    /// True while the points are only a look ahead, not to be recorded.
    pub looking: bool,
}

pub(crate) fn status_of(failure: Failure) -> Status {
    match failure {
        Failure::Lost | Failure::Stalled | Failure::Turned(_) => Status::NotConverged,
        Failure::Singular => Status::Mechanism,
        Failure::Memory(bytes) => Status::OutOfMemory(bytes),
        Failure::Cancelled => Status::Cancelled,
    }
}

impl Path<'_, '_> {
    /// Tests whether the problem has contact.
    pub fn touches(&self) -> bool {
        self.equilibrium.problem.contact().is_some()
    }

    /// Changes the memory of contact.
    pub fn with_contact(&mut self, act: impl FnOnce(&mut dyn Contact)) {
        if let Some(contact) = self.equilibrium.problem.contact_mut() {
            act(contact);
        }
    }

    /// Tests whether snaps are allowed: with contact, if the path is not recorded.
    pub fn may_snap(&self) -> bool {
        let contact = self.equilibrium.problem.contact();
        contact.is_some_and(|contact| !contact.is_recorded())
    }

    pub(crate) fn answer(mut self, ending: Ending, settings: &Settings) -> Answer {
        // Load and volume control have tested each point; arc length knows only if the load has turned.
        let stable = match (self.points.last(), settings.control) {
            (Some(last), _) if !matches!(settings.control, Control::ArcLength { .. }) => {
                last.stable
            }
            _ => self.equilibrium.is_stable(&self.positions, self.point),
        };
        let residual = self
            .equilibrium
            .forces(&self.positions, self.point)
            .relative();
        Answer {
            memory: self.equilibrium.problem.memory(),
            status: ending.status,
            factor: self.point.pressure,
            dead_factor: self.point.dead,
            time: self.point.time,
            reached: ending.reached,
            residual,
            iterations: self.equilibrium.iterations,
            back_offs: self.equilibrium.back_offs,
            limit: ending.limit,
            stable,
            positions: self.positions,
            path: self.points,
            snaps: self.snaps,
        }
    }

    pub fn accept(
        &mut self,
        positions: Vec<Vec3>,
        point: LoadParameter,
        iterations: u32,
        residual: f64,
    ) {
        let problem = &mut self.equilibrium.problem;
        if let Some(contact) = problem.contact_mut() {
            contact.accept(&positions);
        }
        problem.accept_loads(&positions, &point.factor_of());
        if let Some(fluid) = problem.fluid_mut() {
            let instant = fluid.instant(&point.factor_of());
            fluid.take_rest(&positions, instant);
        }
        self.positions = positions;
        self.point = point;
        self.points.push(PathPoint {
            factor: point.pressure,
            iterations,
            residual,
            stable: true,
        });
        // The observer sees each converged point; a request to stop is handled at the next iteration.
        let _ = (self.observer)(&Progress {
            problem: &self.equilibrium.problem,
            steps: u64::from(self.equilibrium.iterations),
            time: point.pressure,
            residual,
            positions: &self.positions,
            velocities: &[],
            record: !self.looking,
        });
    }
}

impl From<FactorError> for Status {
    fn from(error: FactorError) -> Self {
        status_of(error.into())
    }
}
