//! Advance of a player over time: steps, frames, and states taken over from solvers.

use voxsoft_solid::loads::grabs::still_state;
use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Ask, LiveStatus, Look, Method, ProblemError, State};

use crate::clock::Clock;
use crate::event::{Event, Mode, finite};
use crate::player::{Numbers, Player};
use crate::sentences::{at_rest, diverged, out_of_memory};

/// Time between two frames in s, which is also the longest implicit step.
pub const FRAME_TIME: f64 = 1.0 / 60.0;

/// Period of the reports of plot rows and of numbers, in s.
const TELL_EVERY: [f64; 2] = [1.0 / 15.0, 0.1];

/// Limits of the look-ahead at a motion: simulated seconds, and vertices times steps of the explicit and the implicit
/// method, about 0.05 s of work.
const LONGEST_LOOK: f64 = 1.0;
const MOST_WORK: [usize; 2] = [1_000_000, 4_000];

/// Rounding error allowed in the number of steps due.
const ROUNDING: f64 = 1e-6;

/// Result of a solver's search for equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    /// Positions of the vertices in m; those of objects may be left out.
    pub positions: Vec<Vec3>,
    /// Position of the center of each object in m, and its rotation from its first pose.
    pub poses: Vec<(Vec3, Mat3)>,
    /// Mode to show: at rest, diverged, or paused.
    pub mode: Mode,
    /// Sentence on the result.
    pub sentence: String,
    /// Relative residual force, dimensionless.
    pub residual: f64,
    /// Elastic energy in J.
    pub elastic: f64,
    /// Time of the state in s; `None` is the present.
    pub time: Option<f64>,
}

impl Player {
    /// Advances by `seconds` of wall-clock time at the pace, or as far as a wall-clock `budget` (s) allows; returns the
    /// events.
    ///
    /// Fractions of a step are carried over to the next call: in slow motion no step may be due yet, and then there is
    /// no frame either.
    pub fn advance(&mut self, seconds: f64, budget: f64, clock: &dyn Clock) -> Vec<Event> {
        if self.mode != Mode::Playing {
            return Vec::new();
        }
        let mut moment = None;
        if let Some(look) = self.take_steps(seconds, budget, clock) {
            self.speed.mark(look.time, clock.now());
            self.take_frame(look);
            moment = self.moment();
        } else {
            let time = self.stepper.state().time;
            self.speed.mark(time, clock.now());
        }
        let (now, moving) = (clock.now(), self.mode == Mode::Playing);
        let [rows, stat] = std::array::from_fn(|which| {
            let due = !moving || now - self.reported[which] >= TELL_EVERY[which];
            if due {
                self.reported[which] = now;
            }
            due
        });
        let rows = rows.then(|| self.plots.news(self.topology)).flatten();
        let stat = stat.then(|| Event::Stat(self.stat()));
        let rows = rows.map(Event::Plot);
        moment.into_iter().chain(rows).chain(stat).collect()
    }

    /// Takes the steps that are due.
    fn take_steps(&mut self, seconds: f64, budget: f64, clock: &dyn Clock) -> Option<Look> {
        let pace = self.pace.factor();
        if self.stepper.method() == Method::Implicit {
            self.stepper.prefer_step(FRAME_TIME * pace);
        }
        self.due += seconds * pace / self.stepper.step();
        if self.steps_left.is_some() {
            self.due = self.due.max(1.0); // a single-step frame is taken at once
        }
        let wanted = (self.due + ROUNDING).floor();
        if wanted < 1.0 {
            return None;
        }
        self.due -= wanted;
        let began = clock.now();
        let mut taken = 0_u32;
        let mut go_on = |ask| {
            if ask == Ask::Within {
                return !clock.canceled();
            }
            taken += 1;
            !clock.canceled() && clock.now() - began < budget
        };
        let look = self.stepper.advance_while(wanted as u32, &mut go_on);
        self.numbers = Numbers {
            steps: look.substeps,
            step_ms: match taken {
                0 => self.numbers.step_ms,
                _ => 1e3 * (clock.now() - began) / f64::from(taken),
            },
            residual: finite(look.residual),
            elastic: finite(look.elastic),
            kinetic: finite(look.kinetic),
            unsettled: !look.settled,
        };
        Some(look)
    }

    /// Records the new state as a frame, and updates the mode.
    fn take_frame(&mut self, look: Look) {
        self.record();
        match look.status {
            LiveStatus::Moving => {}
            LiveStatus::AtRest => self.stand(Mode::AtRest, at_rest(look.time, self.tolerance)),
            LiveStatus::Diverged => {
                let place = look.breakdown.map(|breakdown| breakdown.rest);
                self.wants_play = false;
                self.stand(Mode::Diverged, diverged(look.time, place));
            }
            LiveStatus::OutOfMemory(bytes) => {
                self.wants_play = false;
                self.stand(Mode::Diverged, out_of_memory(bytes));
            }
        }
        if let Some(left) = &mut self.steps_left {
            *left -= 1;
            if *left == 0 {
                self.steps_left = None;
                if self.moving() {
                    self.hold(String::new());
                }
            }
        }
    }

    /// Records the present state as a frame and a row of the plots.
    fn record(&mut self) {
        let state = self.stepper.state().clone();
        self.record_state(&state);
    }

    fn record_state(&mut self, state: &State) {
        self.frame += 1;
        let (loads, grabs) = (self.loads.clone(), self.grabs());
        self.recording.keep(self.frame, state, loads, grabs);
        let Numbers {
            residual,
            elastic,
            kinetic,
            ..
        } = self.numbers;
        let numbers = [finite(state.time), residual, elastic, kinetic];
        let rest = self.stepper.problem().body().rest();
        self.plots.record(numbers, rest, &state.positions);
    }

    /// Simulates ahead, without display, to find how soon the body comes to rest from its unloaded shape; the pace is
    /// then slow enough for the motion to be seen.
    pub(crate) fn look_ahead(&mut self) {
        if self.numbers.steps > 0 || self.solved {
            return;
        }
        self.pace.rest_in = None;
        if !self.held.is_empty() {
            return;
        }
        self.stepper.reset(); // the first displayed shape may be another one
        if self.stepper.method() == Method::Implicit {
            self.stepper.prefer_step(FRAME_TIME * self.pace.factor());
        }
        let most = MOST_WORK[usize::from(self.stepper.method() == Method::Implicit)];
        let work = most / self.stepper.problem().body().rest().len().max(1);
        let steps = (LONGEST_LOOK / self.stepper.step()).round() as usize;
        let look = self.stepper.advance(work.min(steps) as u32);
        self.stepper.reset();
        self.pace.rest_in = (look.status == LiveStatus::AtRest).then_some(look.time);
    }

    /// Shows positions (m) of all vertices at time zero first; play starts from the unloaded shape.
    pub fn show_first(&mut self, positions: Vec<Vec3>) -> Result<(), ProblemError> {
        let positions = self.completed(positions, &[]);
        self.stepper.seek(positions, 0.0)
    }

    /// Completes positions with those of objects, at the given poses, else their first ones.
    fn completed(&self, positions: Vec<Vec3>, poses: &[(Vec3, Mat3)]) -> Vec<Vec3> {
        let rest = self.stepper.problem().body().rest();
        match &self.touching {
            Some(touching) => touching.completed(rest, positions, poses),
            None => positions,
        }
    }

    /// Records a motion found by a solver as frames: times (s) with positions (m) of all vertices.
    pub fn take_motion(&mut self, motion: Vec<(f64, Vec<Vec3>)>) -> Result<(), ProblemError> {
        self.held.clear();
        self.shown = None;
        self.numbers = Numbers::default();
        for (time, positions) in motion {
            let positions = self.completed(positions, &[]);
            let state = still_state(self.stepper.problem(), positions, time)?;
            self.solved = true;
            self.record_state(&state);
        }
        Ok(())
    }

    /// Takes over a state found by a solver; releases all grabs, as no solver knows them.
    pub fn go_to_rest(&mut self, rest: Rest) -> Result<Vec<Event>, ProblemError> {
        let time = rest.time.unwrap_or(self.stepper.state().time);
        let positions = self.completed(rest.positions, &rest.poses);
        self.stepper.seek(positions, time)?;
        self.held.clear();
        self.shown = None;
        self.solved = true;
        self.numbers.residual = finite(rest.residual);
        self.numbers.elastic = finite(rest.elastic);
        self.numbers.kinetic = Some(0.0);
        self.record();
        self.stand(rest.mode, rest.sentence);
        let rows = self.plots.news(self.topology).map(Event::Plot);
        Ok(rows.into_iter().chain([Event::Stat(self.stat())]).collect())
    }
}
