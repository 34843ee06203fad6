//! Load path: adaptive steps that grow and are cut back, and the diagnosis of a path that cannot continue.

use std::sync::Arc;

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Contact, Memory, Observer, Problem, Progress, Status, Term};

use crate::along::Along;
use crate::control;
use crate::equilibrium::{Equilibrium, Failure};
use crate::loose::Loose;
use crate::point::Point;
use crate::settings::{Answer, Control, LinearSolver, PathPoint, Settings};
use crate::settle::AtLoad;
use crate::step_length::StepLength;
use crate::system::{FactorError, Means};
use crate::volume;

/// Most iterations of a step after which the next one may grow.
pub(crate) const EASY: u32 = 6;
/// Most iterations of an easy step with contact, every correction of which takes some of them.
const EASY_WITH_CONTACT: u32 = 15;
/// Largest step, as a part of the load, that is repeated with a line search before it is cut: a mixed iteration that
/// fails is mostly helped by a shorter step.
const SAFE_STEP: f64 = 0.05;
/// Rotation of a voxel (rad) in the linear prediction beyond which a first step seldom converges, at a cost of some ten
/// iterations.
const LARGEST_TURN: f64 = 1.0;
/// Rotation of the step that is taken instead, rad.
const GOOD_TURN: f64 = 0.5;
/// Longest step of a path-dependent problem: with friction, or bonds that may break.
const LONGEST_OF_WAY: f64 = 0.05;
/// Longest step if only loads are path-dependent: the contact of a tendon is found from one state to the next, and
/// slides on in the same sense under loads that grow together.
const LONGEST_OF_LOADS: f64 = 0.25;

/// Longest step along the path of a problem, as a part of all of it.
pub(crate) fn longest_step(problem: &Problem) -> f64 {
    match problem.contact() {
        Some(contact) if contact.depends_on_way() => LONGEST_OF_WAY,
        _ if problem.depends_on_way() => LONGEST_OF_LOADS,
        _ => 1.0,
    }
}
/// Longest step with fluids, whose work is integrated by the trapezoidal rule: it is then accurate to some parts in a
/// thousand.
const LONGEST_OF_WORK: f64 = 0.125;
/// Step of the load, or of the growth of a volume, across a snap.
pub(crate) const SNAP: f64 = 0.0125;
/// Largest remaining path, in steps, that is taken as one last step.
const LAST: f64 = 1.1;

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
    pub point: Point,
    pub points: Vec<PathPoint>,
    /// Load factors at which it snapped ([`crate::snap`]).
    pub snaps: Vec<f64>,
    pub observer: &'a mut Observer<'b>,
    /// True while the points are only a look ahead, not to be recorded.
    pub looking: bool,
}

/// Starting guess of an equilibrium.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Start {
    /// Positions in m.
    pub positions: Vec<Vec3>,
    /// Pressures in the hyperelastic voxels in Pa, positive in tension, in the order of [`voxsoft_solid::Bricks`];
    /// `None` for those of the positions.
    pub pressures: Option<Vec<f64>>,
}

/// Finds the equilibrium under the final values of all loads and motions, from a start or from rest.
pub fn solve(
    problem: &Problem,
    start: Option<&Start>,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Answer {
    let loose = match settings.control {
        Control::Load | Control::Time { .. } | Control::Volume { .. } => Loose::find(problem),
        // Loose components come to rest under a fixed load, and past a limit no equilibrium is stable under one.
        Control::ArcLength { .. } => None,
    };
    let Some(loose) = loose else {
        return follow(problem, start, settings, observer, None);
    };
    let dampers = Arc::clone(&loose.dampers) as Arc<dyn Term>;
    let damped = problem.clone().with_term(dampers);
    let damped = damped.expect("dampers have the vertices of the body");
    follow(&damped, start, settings, observer, Some(&loose))
}

/// Follows the path of a problem, in which dampers hold loose components.
fn follow(
    problem: &Problem,
    start: Option<&Start>,
    settings: &Settings,
    observer: &mut Observer<'_>,
    loose: Option<&Loose>,
) -> Answer {
    let mut problem = problem.clone();
    let rest = problem.body().rest().to_vec();
    let positions = start.map_or(&rest, |start| &start.positions).clone();
    let solver = match settings.control {
        Control::Load | Control::Time { .. } => settings.linear,
        // Divergence of contact is detected by the signs of pivots.
        Control::Volume { .. } if problem.contact().is_none() => settings.linear,
        Control::ArcLength { .. } | Control::Volume { .. } => LinearSolver::Direct,
    };
    let means = Means {
        solver,
        memory: settings.memory,
    };
    let along = Along::of(settings.control);
    let goes_on = matches!(along, Along::Time { .. });
    if !goes_on {
        if let Some(contact) = problem.contact_mut() {
            contact.start(&positions);
        }
        problem.start_loads();
        problem.start_fluid(&rest, None);
    }
    let memory = problem.memory();
    let equilibrium = match Equilibrium::new(problem, means) {
        Ok(equilibrium) => Equilibrium {
            precision: (settings.tolerance / Settings::default().tolerance).min(1.0),
            ..equilibrium
        },
        Err(error) => return refused(positions, memory, error),
    };
    let mut path = Path {
        equilibrium: Equilibrium {
            has_loose: loose.is_some(),
            opening: start.and_then(|start| start.pressures.clone()),
            ..equilibrium
        },
        positions,
        point: along.at(0.0),
        points: Vec::new(),
        snaps: Vec::new(),
        observer,
        looking: false,
    };
    let ending = match settings.control {
        Control::Load | Control::Time { .. } => {
            let warm = start.is_some() && !goes_on;
            path.follow_load(settings, along, warm, loose)
        }
        Control::ArcLength { steps } => control::follow_arc(&mut path, settings, steps),
        Control::Volume { ratio, steps } => {
            let growth = (ratio, steps);
            volume::follow_volume(&mut path, settings, growth, start.is_some(), loose)
        }
    };
    loose.inspect(|loose| loose.let_go(&path.positions));
    path.answer(ending, settings)
}

fn refused(positions: Vec<Vec3>, memory: Memory, error: FactorError) -> Answer {
    Answer {
        memory,
        positions,
        status: match error {
            FactorError::Memory(bytes) => Status::OutOfMemory(bytes),
            FactorError::Cancelled => Status::Cancelled,
            FactorError::NotPositive | FactorError::Singular | FactorError::Stalled => {
                Status::Mechanism
            }
        },
        factor: 0.0,
        dead_factor: 0.0,
        time: f64::INFINITY,
        reached: 0.0,
        residual: f64::INFINITY,
        iterations: 0,
        back_offs: 0,
        path: Vec::new(),
        snaps: Vec::new(),
        limit: None,
        stable: false,
    }
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

    fn answer(mut self, ending: Ending, settings: &Settings) -> Answer {
        // Load and volume control have tested each point; arc length knows only if the load has turned.
        let stable = match (self.points.last(), settings.control) {
            (Some(last), Control::Load | Control::Time { .. } | Control::Volume { .. }) => {
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

    pub fn accept(&mut self, positions: Vec<Vec3>, point: Point, iterations: u32, residual: f64) {
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

    /// Limit just ahead, if there is one. Beyond it the tangent is indefinite, which takes a direct factor.
    fn look_ahead(&mut self, settings: &Settings) -> Option<f64> {
        let equilibrium = &mut self.equilibrium;
        if equilibrium.system.is_iterative() {
            equilibrium.go_on_directly().ok()?;
        }
        control::look_for_limit(self, settings)
    }

    /// Load control. From a given start the full load is tried first.
    pub fn follow_load(
        &mut self,
        settings: &Settings,
        along: Along,
        warm: bool,
        loose: Option<&Loose>,
    ) -> Ending {
        let first = if warm {
            1.0
        } else {
            settings.first_step.clamp(settings.least_step, 1.0)
        };
        let cold = self.equilibrium.problem.body().rest().to_vec();
        let longest = match settings.control {
            _ if !self.equilibrium.problem.depends_on_way() => 1.0,
            Control::Time { longest, .. } => longest,
            _ => longest_step(&self.equilibrium.problem),
        };
        let longest = match self.equilibrium.problem.fluid() {
            Some(_) => f64::min(longest, LONGEST_OF_WORK),
            None => longest,
        };
        let easy = if self.touches() {
            EASY_WITH_CONTACT
        } else {
            EASY
        };
        let mut length = StepLength::new(first, longest);
        let mut cuts = 0;
        let mut last = f64::INFINITY;
        let mut now = 0.0;
        let mut limit = None;
        self.equilibrium.largest_turn = (!warm).then_some(LARGEST_TURN);
        loop {
            let step = length.get();
            let next = if now + LAST * step < 1.0 {
                now + step
            } else {
                1.0
            };
            let point = along.at(next);
            let mut trial = self.positions.clone();
            self.with_contact(|contact| contact.extrapolate((next - now) / last));
            loose.inspect(|loose| loose.hold(&self.positions, next - now));
            let safe = step <= SAFE_STEP;
            let mut search = AtLoad {
                point,
                safe,
                can_be_cut: step >= 2.0 * settings.least_step,
            };
            let found = self
                .equilibrium
                .settle(&mut trial, &mut search, settings, self.observer);
            let failure = match found {
                Ok(found) => {
                    let stable = self.equilibrium.is_stable(&trial, point);
                    if stable || cuts == UNSTABLE_CUTS {
                        // Under dead loads alone only the end is a point of the path.
                        self.looking = match along {
                            Along::All { .. } | Along::Time { .. } => {
                                loose.is_some() && next == 1.0
                            }
                            Along::Dead => next < 1.0,
                        };
                        if limit.is_none() && !warm && loose.is_none() && found.iterations > EASY {
                            limit = self.crossed_limit(&trial, point, along, settings);
                        }
                        self.accept(trial, point, found.iterations, found.residual);
                        if let Some(point) = self.points.last_mut() {
                            point.stable = stable;
                        }
                        last = next - now;
                        now = next;
                        if next == 1.0 {
                            return self.end(along, loose, limit, settings);
                        }
                        length.succeeded(found.iterations <= easy);
                        continue;
                    }
                    // A long step may reach a branch that the path does not lead to.
                    cuts += 1;
                    Failure::Lost
                }
                Err(Failure::Turned(turn)) => {
                    self.with_contact(|contact| contact.go_back());
                    length.set((step * GOOD_TURN / turn).max(settings.least_step));
                    continue;
                }
                Err(failure) => failure,
            };
            self.with_contact(|contact| contact.go_back());
            if !matches!(failure, Failure::Lost | Failure::Singular) {
                return Ending::new(status_of(failure), None, now);
            }
            self.equilibrium.back_offs += 1;
            if self.points.is_empty() && warm {
                self.positions.clone_from(&cold);
                self.with_contact(|contact| contact.start(&cold));
            }
            length.failed(next - now);
            if length.get() < settings.least_step {
                let point = along.at((now + SNAP).min(1.0));
                if self.may_snap()
                    && self.snap(
                        &mut AtLoad {
                            point,
                            safe: true,
                            can_be_cut: false,
                        },
                        settings,
                    )
                {
                    length.set(SNAP);
                    last = f64::INFINITY;
                    now = (now + SNAP).min(1.0);
                    if now < 1.0 {
                        continue;
                    }
                    return self.end(along, loose, limit, settings);
                }
                // Contact makes corners in the path, which no tangent predicts; and the pressure of chambers is not
                // proportional to the load, so that no direction leads ahead.
                let fluid = self.equilibrium.problem.fluid();
                let plain = !self.touches() && fluid.is_none();
                let limit = if plain && along.has_factor() {
                    self.look_ahead(settings)
                } else {
                    None
                };
                // A body that was held at an earlier equilibrium does not move freely: contact diverged.
                let failure = match failure {
                    Failure::Singular if self.touches() && now > 0.0 => Failure::Lost,
                    other => other,
                };
                let status = limit.map_or(status_of(failure), |_| Status::LimitReached);
                return Ending::new(status, limit, now);
            }
        }
    }

    /// End of load control, at the full load.
    fn end(
        &mut self,
        along: Along,
        loose: Option<&Loose>,
        limit: Option<f64>,
        settings: &Settings,
    ) -> Ending {
        match (along, loose) {
            (Along::All { .. } | Along::Time { .. }, Some(loose)) => {
                let mut search = AtLoad {
                    point: self.point,
                    safe: true,
                    can_be_cut: false,
                };
                self.release(loose, &mut search, settings)
            }
            (Along::All { .. } | Along::Time { .. }, None) => {
                self.snaps.extend(limit);
                Ending::new(Status::AtRest, limit, 1.0)
            }
            (Along::Dead, _) => {
                self.looking = false;
                let before = self.points.len().saturating_sub(1);
                self.points.drain(..before);
                Ending::new(Status::AtRest, None, 1.0)
            }
        }
    }
}

impl From<FactorError> for Status {
    fn from(error: FactorError) -> Self {
        status_of(error.into())
    }
}
