use std::collections::BTreeMap;
use std::sync::Arc;

use voxsoft_frames::Display;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, ProblemError, Stepper};
use voxsoft_xpbd::Dynamics;

use crate::command::Command;
use crate::control::Control;
use crate::event::{Event, Mode, Refusal};
use crate::pace::{Pace, RealTimeFactor};
use crate::plots::{Plots, Probe};
use crate::recording::{Recorded, Recording};
use crate::stepper::stepper;
use crate::touching::Touching;

/// Body number, controls and probes of a problem, beside its mechanics.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cast {
    /// Number of the body, which frames and events carry.
    pub topology: u32,
    /// Controls that can be changed while time runs.
    pub controls: Vec<Control>,
    /// Probes whose displacements are plotted.
    pub probes: Vec<Probe>,
}

/// A grab as requested.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Held {
    pub(crate) vertex: usize,
    /// Rigid object that is held instead, and its vertices relative to its center when grabbed.
    pub(crate) object: Option<(usize, [Vec3; 4])>,
    pub(crate) target: Vec3,
    pub(crate) stiffness: f64,
}

/// Numbers of the last step; energies in J.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Numbers {
    pub(crate) steps: u64,
    pub(crate) step_ms: f64,
    pub(crate) residual: Option<f64>,
    pub(crate) elastic: Option<f64>,
    pub(crate) kinetic: Option<f64>,
    pub(crate) unsettled: bool,
}

/// Player of a live problem: executes commands, advances over time and reports events.
pub struct Player {
    pub(crate) stepper: Box<dyn Stepper>,
    pub(crate) surface: Display,
    pub(crate) touching: Option<Touching>,
    pub(crate) topology: u32,
    pub(crate) controls: Vec<Control>,
    /// The value of each control now.
    pub(crate) loads: Vec<f64>,
    pub(crate) held: BTreeMap<u32, Held>,
    pub(crate) mode: Mode,
    pub(crate) sentence: String,
    pub(crate) wants_play: bool,
    /// Frames until time stops; `None` for no limit.
    pub(crate) steps_left: Option<u32>,
    pub(crate) pace: Pace,
    pub(crate) speed: RealTimeFactor,
    /// Fraction of a step that is carried over to the next frame.
    pub(crate) due: f64,
    /// True once a solver's state was taken over.
    pub(crate) solved: bool,
    pub(crate) numbers: Numbers,
    pub(crate) tolerance: f64,
    pub(crate) frame: u64,
    pub(crate) recording: Recording,
    pub(crate) shown: Option<Arc<Recorded>>,
    pub(crate) plots: Plots,
    /// Clock times (s) of the last reports of rows and of numbers.
    pub(crate) reported: [f64; 2],
}

impl Player {
    /// Makes a player at the rest pose and time zero, with a surface for display.
    pub fn new(problem: Problem, settings: Dynamics, surface: Display, cast: Cast) -> Self {
        let tolerance = settings.tolerance;
        Self {
            stepper: stepper(problem, settings),
            surface,
            touching: None,
            topology: cast.topology,
            loads: cast.controls.iter().map(|one| one.value).collect(),
            controls: cast.controls,
            held: BTreeMap::new(),
            mode: Mode::Paused,
            sentence: String::new(),
            wants_play: false,
            steps_left: None,
            pace: Pace::default(),
            speed: RealTimeFactor::default(),
            due: 0.0,
            solved: false,
            numbers: Numbers::default(),
            tolerance,
            frame: 0,
            recording: Recording::default(),
            shown: None,
            plots: Plots::of(cast.probes),
            reported: [f64::NEG_INFINITY; 2],
        }
    }

    /// Adds the names and objects of contact, for reports of contact.
    #[must_use]
    pub fn with_touching(mut self, touching: Touching) -> Self {
        self.touching = Some(touching);
        self
    }

    /// Executes a command and returns its events.
    pub fn command(&mut self, command: Command) -> Result<Vec<Event>, Refusal> {
        match command {
            Command::Play => self.on_play(),
            Command::Pause => return Ok(self.on_pause()),
            Command::Step { n } => self.on_step(n),
            Command::Reset => return Ok(self.on_reset()),
            Command::Pace { factor } => self.on_pace(factor)?,
            Command::Load {
                index,
                value,
                factor,
            } => self.on_load(index, value, factor)?,
            Command::Grab {
                id,
                vertex,
                object: None,
                target,
                stiffness,
            } => self.on_grab(id, vertex, target, stiffness)?,
            Command::Grab {
                id,
                object: Some(object),
                target,
                stiffness,
                ..
            } => self.on_hold_object(id, object, target, stiffness)?,
            Command::Release { id } => self.on_release(id),
            Command::Seek { frame, time } => self.on_seek(frame, time)?,
            Command::Live => self.on_live(),
            Command::Pick { vertex } => return Ok(vec![Event::Picked(self.picked(vertex)?)]),
            Command::Probe { vertex } => return self.on_probe(vertex),
        }
        Ok(vec![Event::Stat(self.stat())])
    }

    fn on_play(&mut self) {
        self.on_live();
        self.wants_play = true;
        self.look_ahead();
        self.run();
    }

    fn on_pause(&mut self) -> Vec<Event> {
        self.wants_play = false;
        if self.moving() {
            self.hold(String::new());
        }
        let rows = self.plots.news(self.topology).map(Event::Plot);
        rows.into_iter().chain([Event::Stat(self.stat())]).collect()
    }

    fn on_step(&mut self, n: u32) {
        self.on_live();
        self.wants_play = false;
        self.look_ahead();
        self.run();
        self.steps_left = Some(n);
    }

    fn on_reset(&mut self) -> Vec<Event> {
        self.stepper.reset();
        for load in 0..self.stepper.problem().loads().len() {
            let own = self.stepper.set_load(load, None);
            own.expect("a load of the problem takes its own history back");
        }
        self.loads = self.controls.iter().map(|one| one.value).collect();
        self.held.clear();
        (self.due, self.solved, self.numbers) = (0.0, false, Numbers::default());
        (self.wants_play, self.pace.rest_in) = (false, None);
        (self.shown, self.frame) = (None, 0);
        self.recording.clear();
        self.plots.clear();
        self.stand(Mode::Paused, String::new());
        let reported = [Event::Plot(self.whole_plot()), Event::Stat(self.stat())];
        self.moment().into_iter().chain(reported).collect()
    }

    fn on_pace(&mut self, factor: Option<f64>) -> Result<(), Refusal> {
        if factor.is_some_and(|factor| !(factor > 0.0 && factor <= 1.0)) {
            return Err(Refusal::new("pace", "must be above 0 and up to 1", ""));
        }
        self.pace.chosen = factor;
        self.pace.choices += 1;
        self.speed.restart();
        Ok(())
    }

    fn on_load(
        &mut self,
        index: usize,
        value: Option<f64>,
        factor: Option<f64>,
    ) -> Result<(), Refusal> {
        let count = self.controls.len();
        let control = self.controls.get(index);
        let control = control.ok_or_else(|| {
            let what = format!("there are {count} loads, from 0");
            Refusal::new("load", what, "")
        })?;
        let factor = control.factor(value, factor)?;
        let refused = |error: ProblemError| Refusal::new("load", error, "");
        for &load in &control.loads {
            let set = self.stepper.set_load(load as usize, Some(factor));
            set.map_err(refused)?;
        }
        self.loads[index] = factor * control.value;
        self.wake();
        Ok(())
    }

    fn on_grab(
        &mut self,
        id: u32,
        vertex: usize,
        target: Vec3,
        stiffness: f64,
    ) -> Result<(), Refusal> {
        let of_body = self.vertex(vertex)?;
        if target.iter().any(|x| !x.is_finite()) {
            return Err(Refusal::new("grab", "the target is not a point", ""));
        }
        self.on_live();
        self.stepper
            .grab(id, of_body, target, stiffness)
            .map_err(|error| Refusal::new("grab", error, ""))?;
        let held = Held {
            vertex,
            object: None,
            target,
            stiffness,
        };
        self.held.insert(id, held);
        self.wake();
        Ok(())
    }

    fn on_release(&mut self, id: u32) {
        match self.held.remove(&id) {
            Some(Held {
                object: Some(_), ..
            }) => self.let_go_of_object(id),
            _ => {
                self.stepper.release(id);
            }
        }
        self.wake();
    }

    fn on_seek(&mut self, number: u64, time: Option<f64>) -> Result<(), Refusal> {
        let found = match time {
            Some(time) => self.recording.at_time(time),
            None => self.recording.at(number),
        };
        let refusal = || Refusal::new("seek", "no frame is stored yet", "press play first");
        let found = found.ok_or_else(refusal)?;
        self.wants_play = false;
        let last = self.recording.last();
        let sentence = format!("Frame {} of {last}", found.number);
        self.stand(Mode::Past, sentence);
        self.shown = Some(found);
        Ok(())
    }

    pub(crate) fn on_live(&mut self) {
        if self.shown.take().is_some() {
            self.stand(Mode::Paused, String::new());
        }
    }

    fn on_probe(&mut self, vertex: usize) -> Result<Vec<Event>, Refusal> {
        let of_body = self.vertex(vertex)?;
        let probe = Probe::at(format!("vertex {vertex}"), of_body);
        self.plots.add(probe);
        Ok(vec![Event::Plot(self.whole_plot())])
    }

    /// Pauses with a sentence for the reason: a load or a grab that wakes the body lets time run again if play was
    /// requested.
    pub fn hold(&mut self, sentence: String) {
        self.shown = None;
        self.stand(Mode::Paused, sentence);
    }

    /// Plays on when this body replaces another one that was playing: time runs, without a look-ahead.
    pub fn resume(&mut self) {
        self.wants_play = true;
        self.run();
    }

    /// Stops until the next play command, with a sentence for the reason.
    pub fn halt(&mut self, sentence: String) {
        self.wants_play = false;
        self.hold(sentence);
    }

    /// Lets time run.
    pub(crate) fn run(&mut self) {
        self.stand(Mode::Playing, String::new());
        self.steps_left = None;
        self.speed.restart();
    }

    pub(crate) fn stand(&mut self, mode: Mode, sentence: String) {
        (self.mode, self.sentence) = (mode, sentence);
    }

    /// Wakes a body at rest after a load or a grab has changed, and runs time again if play was requested; drops the
    /// slow pace of the look-ahead.
    pub(crate) fn wake(&mut self) {
        self.pace.rest_in = None;
        if self.mode == Mode::AtRest {
            self.stand(Mode::Paused, String::new());
        }
        if self.wants_play && self.mode == Mode::Paused {
            self.run();
        }
    }

    /// Vertex of the body at a point of the surface.
    pub(crate) fn vertex(&self, point: usize) -> Result<u32, Refusal> {
        let found = self.surface.vertices().get(point).copied();
        let refusal = || Refusal::new("vertex", format!("{point} is not on the surface"), "");
        found.ok_or_else(refusal)
    }
}
