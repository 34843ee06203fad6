//! The load path: steps that grow and back off, and what to say when there is no way on.

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use crate::control;
use crate::equilibrium::{Equilibrium, Failure, Found};
use crate::point::Point;
use crate::settings::{Answer, Control, Observer, PathPoint, Progress, Settings, Status};
use crate::system::FactorError;

/// A step that took no more iterations than this lets the next one grow.
const EASY: u32 = 6;
/// Steps up to this part of the load are tried again with a line search before they are cut: a quick
/// way that fails is mostly helped by a shorter step.
const SAFE_STEP: f64 = 0.05;
/// How often the floor may change its mind at one point.
const FLOOR_ROUNDS: usize = 40;

/// A path under way.
pub(crate) struct Path<'a, 'b> {
    pub equilibrium: Equilibrium<'a>,
    pub positions: Vec<Vec3>,
    pub point: Point,
    pub points: Vec<PathPoint>,
    pub observer: &'a mut Observer<'b>,
    /// Whether the points are only a look ahead, not to be recorded.
    pub looking: bool,
}

/// Finds the equilibrium under the final values of all loads and motions, from `start` (positions in m)
/// or from rest.
pub fn solve(
    problem: &Problem,
    start: Option<&[Vec3]>,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Answer {
    let rest = problem.body().rest();
    let positions = start.unwrap_or(rest).to_vec();
    let equilibrium = match Equilibrium::new(problem) {
        Ok(equilibrium) => equilibrium,
        Err(error) => return refused(positions, error),
    };
    let mut path = Path {
        equilibrium,
        positions,
        point: Point::all(0.0),
        points: Vec::new(),
        observer,
        looking: false,
    };
    let (status, limit) = match settings.control {
        Control::Load => path.follow_load(settings, start.is_some()),
        Control::ArcLength { steps } => control::follow_arc(&mut path, settings, steps),
        Control::Volume { ratio, steps } => {
            control::follow_volume(&mut path, settings, ratio, steps)
        }
    };
    path.answer(status, limit)
}

fn refused(positions: Vec<Vec3>, error: FactorError) -> Answer {
    Answer {
        positions,
        status: match error {
            FactorError::Memory => Status::OutOfMemory,
            FactorError::NotPositive | FactorError::Singular => Status::Mechanism,
        },
        factor: 0.0,
        residual: f64::INFINITY,
        iterations: 0,
        back_offs: 0,
        path: Vec::new(),
        limit: None,
        stable: false,
    }
}

pub(crate) fn status_of(failure: Failure) -> Status {
    match failure {
        Failure::Lost => Status::NotConverged,
        Failure::Singular => Status::Mechanism,
        Failure::Memory => Status::OutOfMemory,
        Failure::Cancelled => Status::Cancelled,
    }
}

impl Path<'_, '_> {
    fn answer(mut self, status: Status, limit: Option<f64>) -> Answer {
        let stable = self.equilibrium.is_stable(&self.positions, self.point);
        let residual = self
            .equilibrium
            .forces(&self.positions, self.point)
            .relative();
        Answer {
            status,
            factor: self.point.pressure,
            residual,
            iterations: self.equilibrium.iterations,
            back_offs: self.equilibrium.back_offs,
            limit,
            stable,
            positions: self.positions,
            path: self.points,
        }
    }

    /// Newton at a point, with the floor settled; on failure nothing has moved.
    pub fn settle(
        &mut self,
        trial: Vec<Vec3>,
        point: Point,
        settings: &Settings,
        safe: bool,
    ) -> Result<Found, Failure> {
        let mut positions = trial;
        let mut iterations = 0;
        for _ in 0..FLOOR_ROUNDS {
            let found =
                self.equilibrium
                    .newton(&mut positions, point, settings, safe, self.observer)?;
            iterations += found.iterations;
            if !self.equilibrium.update_floor(&positions, point)? {
                self.accept(positions, point, iterations, found.residual);
                return Ok(Found {
                    iterations,
                    residual: found.residual,
                });
            }
        }
        Err(Failure::Lost)
    }

    pub fn accept(&mut self, positions: Vec<Vec3>, point: Point, iterations: u32, residual: f64) {
        self.positions = positions;
        self.point = point;
        self.points.push(PathPoint {
            factor: point.pressure,
            iterations,
            residual,
            stable: true,
        });
        // A converged point is worth telling; whether to stop is asked at the next iteration.
        let _ = (self.observer)(&Progress {
            iterations: self.equilibrium.iterations,
            factor: point.pressure,
            residual,
            positions: &self.positions,
            converged: !self.looking,
        });
    }

    /// Load control. From a given start the full load is tried first.
    fn follow_load(&mut self, settings: &Settings, warm: bool) -> (Status, Option<f64>) {
        let mut step = if warm {
            1.0
        } else {
            settings.first_step.clamp(settings.least_step, 1.0)
        };
        let cold = self.equilibrium.problem.body().rest().to_vec();
        loop {
            let now = self.point.pressure;
            let next = (now + step).min(1.0);
            let trial = self.positions.clone();
            match self.settle(trial, Point::all(next), settings, step <= SAFE_STEP) {
                Ok(found) => {
                    if next == 1.0 {
                        return (Status::AtRest, None);
                    }
                    if found.iterations <= EASY {
                        step *= 2.0;
                    }
                }
                Err(failure @ (Failure::Lost | Failure::Singular)) => {
                    self.equilibrium.back_offs += 1;
                    if self.points.is_empty() && warm {
                        self.positions.clone_from(&cold);
                    }
                    step = (next - now) / 4.0;
                    if step < settings.least_step {
                        let limit = control::look_for_limit(self, settings);
                        let status = limit.map_or(status_of(failure), |_| Status::LimitReached);
                        return (status, limit);
                    }
                }
                Err(failure) => return (status_of(failure), None),
            }
        }
    }
}

impl From<FactorError> for Status {
    fn from(error: FactorError) -> Self {
        status_of(error.into())
    }
}
