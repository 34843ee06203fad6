//! Motion by implicit steps, whichever search finds their ends.
//!
//! A step begins from the state and the one before it ([`crate::motion::scheme`]), a search predicts and finds its end
//! ([`InnerSearch`]), and it is accepted, or taken again: by backward Euler if the search asks for that, at half the
//! length if it fails.

use voxsoft_solid::breakdown::Breakdown;
use voxsoft_solid::vector::{Vec3, dot, scale, sub};
use voxsoft_solid::{Damping, Load, Problem, Progress, State, Velocities};

use super::run::{Now, Run, Step};
use super::scheme::{FIRST_PART, SECOND_OVER_FIRST, Stage, Start};
use crate::linear::error::FactorError;
use crate::path::equilibrium::Failure;

/// Speed of an anchor, in shortest edges per second: one edge in a step of 1/60 s. If the simulation is slower than
/// real time, a hand is faster than life, and steps in which it drags a vertex across several voxels cost three times
/// as many moves, which slows it further. At 240 the PneuNet template stayed at 0.16 of real time under a hand that
/// turns once a second; at 60 it runs at 0.47.
const ANCHOR_SPEED: f64 = 60.0;
/// Most halvings of a step before a run counts as diverged.
const MAX_BACK_OFFS: u32 = 10;
/// Successful steps after which a halved one is doubled again.
const PATIENCE: u32 = 3;
/// Most parts into which the error of a step divides it: an impact has an error that falls with the step alone.
const MOST_PARTS: f64 = 8.0;
/// Error of a step over the distance of its end from the extrapolation with the acceleration: 2/9 h³ x‴ of the
/// second-order formula over that and 5/12 h³ x‴ of the extrapolation, for equal steps.
const ERROR_OVER_DISTANCE: f64 = 8.0 / 23.0;
/// Part of the allowed error below which a step is doubled: its error grows with the cube of its length.
const SMALL_ERROR: f64 = 1.0 / 8.0;
/// Relative distance from the next record within which a step is extended to it.
pub(super) const SAME_TIME: f64 = 1e-9;

/// Asks within a step whether to go on, with the progress of a search that has one to tell.
pub type Asker<'a> = dyn FnMut(Option<&Progress<'_>>) -> bool + 'a;

/// Reasons why a step was not taken.
pub enum Stop {
    /// Its end was not found.
    Lost,
    /// Its error is larger than allowed.
    Coarse,
    /// A body has moved too far away.
    Gone(Breakdown),
    /// The tangent takes more memory than available, in bytes.
    Memory(u64),
    /// The caller asked to stop.
    Cancelled,
}

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Memory(bytes) => Self::Memory(bytes),
            Failure::Cancelled => Self::Cancelled,
            Failure::Lost | Failure::Singular | Failure::Stalled | Failure::Turned(_) => Self::Lost,
        }
    }
}

impl From<FactorError> for Stop {
    fn from(error: FactorError) -> Self {
        Failure::from(error).into()
    }
}

/// Search for the end of a step, with its own memory of the last ones.
pub trait InnerSearch: Send + 'static {
    /// True if a step that failed is taken again without its past: from a body whose acceleration is unknown.
    const FORGETS: bool;

    /// Its own copy of the problem, if it has one, whose loads follow those of the run.
    fn copy(&mut self) -> Option<&mut Problem> {
        None
    }

    /// Starts over from the state of the run; `at_rest` if that is the rest pose at time zero.
    fn start(&mut self, run: &mut Run, at_rest: bool);

    /// Takes over the memory that the problem of the run has got after a start.
    fn resume(&mut self, _run: &mut Run) {}

    /// Takes note of a change of loads or grabs.
    fn wake(&self, _run: &mut Run) {}

    /// Tests whether the next step may look back at the state before.
    fn may_look_back(&self) -> bool {
        true
    }

    /// Finds the positions at the end of a step.
    fn solve(
        &mut self,
        run: &mut Run,
        step: &Step,
        asker: &mut Asker<'_>,
    ) -> Result<Vec<Vec3>, Stop>;

    /// Forces and energies at the end of the step that was solved last.
    fn look(&mut self, run: &Run, step: &Step, next: &State) -> Now;

    /// Tests whether a step that has looked back has to be taken again by backward Euler.
    fn takes_again(&mut self, run: &Run, outcome: &Result<(State, Now), Stop>) -> bool;

    /// Tests whether the motion has variations, which take each step too.
    fn varies(&self) -> bool {
        false
    }

    /// Takes a step that was found, before it is accepted, for the variations of the motion.
    fn vary(
        &mut self,
        _run: &mut Run,
        _step: &Step,
        _next: &State,
        _asker: &mut Asker<'_>,
    ) -> Result<(), Stop> {
        Ok(())
    }

    /// Accepts contact at the end of a step; `false` if it is not sound.
    fn accept_contact(&mut self, problem: &mut Problem, next: &State) -> bool;

    /// Accepts the end of a step, after loads and materials have.
    fn accept(&mut self, run: &mut Run, next: &State);

    /// Takes over the forces and energies of the state that was left.
    fn leave(&mut self, _run: &Run, _then: Now) {}

    /// Relative residual of the equilibrium that a body at rest is in, given that of all forces at the state.
    fn residual_at_rest(&self, run: &Run, residual: f64) -> f64;

    /// Tests whether gas and liquid are at rest.
    fn fluid_is_at_rest(&self, _run: &Run) -> bool {
        true
    }

    /// Tests whether the last step was found to its tolerance.
    fn settled(&self) -> bool {
        true
    }
}

/// Gives the loads of a run, and of the copy of its search, the velocities of a step.
fn begin_motion(run: &mut Run, copy: Option<&mut Problem>, step: &Step) {
    if !run.problem.feels_motion() {
        return;
    }
    let near = run.extrapolated(step.length, None);
    for problem in std::iter::once(&mut run.problem).chain(copy) {
        let velocities = || Velocities {
            rate: step.start.rate,
            from: step.start.positions.clone(),
        };
        problem.begin_motion(velocities, &near);
    }
}

/// A problem in motion by implicit steps whose ends a search finds.
pub struct Integrator<S> {
    pub(super) run: Run,
    pub(super) search: S,
}

impl<S: InnerSearch> Integrator<S> {
    /// Continues a run that has just begun.
    pub(super) fn begun(run: Run, search: S) -> Self {
        let mut new = Self { run, search };
        new.search.wake(&mut new.run);
        new
    }

    /// Goes on from another state, with a memory as at the start.
    pub(super) fn start_from(&mut self, start: State, at_rest: bool) {
        self.run.start_from(start);
        self.search.start(&mut self.run, at_rest);
        self.search.wake(&mut self.run);
        if !self.run.now.external.is_empty() {
            self.run.residual = self.run.residual();
        }
    }

    /// Wakes the run after a change of loads or grabs: the body may move again.
    pub(super) fn wake(&mut self) {
        self.run.wake();
        self.search.wake(&mut self.run);
    }

    /// Takes a whole step that does not pass the time `limit` (s), the first one of a motion in its two stages.
    pub(super) fn take_whole_step(
        &mut self,
        limit: f64,
        asker: &mut Asker<'_>,
    ) -> Result<(), Stop> {
        loop {
            self.take_step(limit, asker)?;
            if self.run.stage != Stage::Second {
                return Ok(());
            }
            // Both stages count as one step.
            self.run.steps -= 1;
        }
    }

    /// Takes one step or stage that does not pass the time `limit` (s), halved repeatedly if a whole one fails.
    pub(super) fn take_step(&mut self, limit: f64, asker: &mut Asker<'_>) -> Result<(), Stop> {
        let least = self.run.settings.step * 0.5f64.powi(MAX_BACK_OFFS as i32);
        loop {
            self.run.steps += 1;
            let (whole, length) = self.next_step(limit);
            let stop = match self.try_step(length, asker) {
                Ok(error) => {
                    self.lengthen(error);
                    return Ok(());
                }
                Err(stop) => stop,
            };
            self.run.rollback();
            if let Stop::Memory(_) | Stop::Cancelled = stop {
                return Err(stop);
            }
            self.shorten(whole);
            if let Stop::Coarse = stop {
                continue;
            }
            if self.run.step < least {
                return Err(stop);
            }
            self.run.back_offs += 1;
        }
    }

    /// Length of the next step, which does not pass the time `limit` (s), and of its next stage.
    fn next_step(&self, limit: f64) -> (f64, f64) {
        let run = &self.run;
        if let (Stage::Second, Some(before)) = (run.stage, &run.before) {
            let second = SECOND_OVER_FIRST * (run.state.time - before.time);
            return (second, second);
        }
        let left = limit - run.state.time;
        // Two steps of equal length rather than one with a rest.
        let parts = (left / run.step - SAME_TIME).ceil().max(1.0);
        let whole = if left.is_finite() {
            left / parts
        } else {
            run.step
        };
        let begins = run.stage == Stage::First;
        (whole, if begins { FIRST_PART * whole } else { whole })
    }

    /// Doubles a halved step after some successful ones, if the error of the last, as a part of the allowed one, lets it.
    fn lengthen(&mut self, error: f64) {
        let run = &mut self.run;
        run.good += 1;
        if error <= SMALL_ERROR && run.good >= PATIENCE && run.step < run.settings.step {
            run.step = (2.0 * run.step).min(run.settings.step);
            run.good = 0;
        }
    }

    /// Halves a step that failed at the length `whole` (s).
    fn shorten(&mut self, whole: f64) {
        let run = &mut self.run;
        run.good = 0;
        if S::FORGETS {
            run.step /= 2.0;
            run.before = None;
            run.stage = Stage::Later;
            return;
        }
        run.step = whole / 2.0;
        if run.stage == Stage::Second {
            run.stage = Stage::Later;
        }
    }

    /// Takes a step by the second-order formula, or again by backward Euler if the search asks for that; returns its
    /// error as a part of the allowed one.
    fn try_step(&mut self, length: f64, asker: &mut Asker<'_>) -> Result<f64, Stop> {
        if self.run.before.is_some() && self.search.may_look_back() {
            let outcome = self.find(length, true, asker);
            if !self.search.takes_again(&self.run, &outcome) {
                let (next, found) = outcome?;
                return self.accept(next, found, true, asker);
            }
            self.run.rollback();
        }
        let (next, found) = self.find(length, false, asker)?;
        self.accept(next, found, false, asker)
    }

    /// Error of a step as a part of the allowed one; zero where the past does not tell it.
    fn error(&self, next: &State, length: f64) -> f64 {
        let run = &self.run;
        let (Stage::Later, Some(before)) = (run.stage, &run.before) else {
            return 0.0;
        };
        if run.settings.accuracy.is_infinite() {
            return 0.0;
        }
        let expected = run.extrapolated(length, Some(before));
        let masses = run.problem.body().masses();
        let mut sum = 0.0;
        for ((x, y), mass) in next.positions.iter().zip(&expected).zip(masses) {
            let off = sub(*x, *y);
            sum += mass * dot(off, off);
        }
        let all: f64 = masses.iter().sum();
        ERROR_OVER_DISTANCE * (sum / all).sqrt() / (run.settings.accuracy * run.shortest_edge)
    }

    /// The step of a length (s) from the state, by the second-order formula or by backward Euler.
    fn step_of(&self, length: f64, second_order: bool) -> Step {
        let run = &self.run;
        let before = run.before.as_ref().filter(|_| second_order);
        let start = Start::new(&run.state, before, length, run.stage);
        let travel = ANCHOR_SPEED * length * run.shortest_edge;
        Step {
            length,
            time: run.state.time + length,
            second_order,
            braked: start.rate + run.damping_rate,
            grabs: run.grabs.clone().follow(travel),
            start,
        }
    }

    /// Finds the end of a step from the state, by the second-order formula or by backward Euler.
    fn find(
        &mut self,
        length: f64,
        second_order: bool,
        asker: &mut Asker<'_>,
    ) -> Result<(State, Now), Stop> {
        let step = self.step_of(length, second_order);
        let time = step.time;
        let run = &mut self.run;
        run.problem.begin(time);
        begin_motion(run, self.search.copy(), &step);
        let positions = self.search.solve(run, &step, asker)?;
        let pairs = positions.iter().zip(&step.start.positions);
        let velocities = pairs.map(|(x, from)| scale(step.start.rate, sub(*x, *from)));
        let next = State {
            velocities: velocities.collect(),
            positions,
            time,
        };
        let place = run.reach.find(&run.problem, &next.positions, time);
        if let Some(place) = place {
            return Err(Stop::Gone(place));
        }
        let found = self.search.look(run, &step, &next);
        Ok((next, found))
    }

    /// Accepts the end of a step, if it is accurate and contact is sound there; returns its error as a part of the allowed
    /// one.
    fn accept(
        &mut self,
        next: State,
        found: Now,
        second_order: bool,
        asker: &mut Asker<'_>,
    ) -> Result<f64, Stop> {
        let length = next.time - self.run.state.time;
        let error = self.error(&next, length);
        if error > 1.0 && length > self.run.settings.step * (1.0 + SAME_TIME) / MOST_PARTS {
            return Err(Stop::Coarse);
        }
        if self.search.varies() {
            let step = self.step_of(length, second_order);
            self.search.vary(&mut self.run, &step, &next, asker)?;
        }
        let run = &mut self.run;
        if !self.search.accept_contact(&mut run.problem, &next) {
            return Err(Stop::Lost);
        }
        let factor_of = |load: &Load| load.history.at(next.time);
        run.problem.accept_loads(&next.positions, &factor_of);
        let step = next.time - run.state.time;
        run.problem.end_viscosity(&next.positions, step);
        self.search.accept(run, &next);
        run.grabs.follow(ANCHOR_SPEED * step * run.shortest_edge);
        if run.settings.damping == Damping::Critical {
            run.damping_rate = 2.0 * run.frequency(&next, &found);
        }
        run.remaining = run.remaining_after(&next, &found);
        let left = std::mem::replace(&mut run.state, next);
        // The first stage is of first order, and not used as a previous state by later steps.
        if run.stage != Stage::Second {
            run.before = Some(left);
        }
        let then = std::mem::replace(&mut run.now, found);
        self.search.leave(run, then);
        run.stage = match run.stage {
            Stage::First => Stage::Second,
            Stage::Second | Stage::Later => Stage::Later,
        };
        Ok(error)
    }
}
