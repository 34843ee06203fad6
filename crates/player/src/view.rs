//! Views of a player: numbers, displayed frame, contacts, plots and grabs.

use std::borrow::Cow;

use voxsoft_frames::{Display, Field, FrameHead, frame_flag, name_of};
use voxsoft_solid::vector::{Vec3, norm, sub};
use voxsoft_solid::{Problem, State};

use crate::event::{
    Event, GrabState, Mode, MomentOf, Picked, Plot, Refusal, Shown, Stat, Value, finite,
};
use crate::player::Player;
use crate::sentences::UNSETTLED;

impl Player {
    /// Present numbers of the player.
    pub fn stat(&self) -> Stat {
        let moving = self.moving();
        Stat {
            topology: self.topology,
            state: self.mode,
            sentence: match self.sentence.as_str() {
                "" if moving && self.numbers.unsettled => UNSETTLED.to_owned(),
                "" if moving => self.pace.words(),
                sentence => sentence.to_owned(),
            },
            time: self.time(),
            step_ms: self.numbers.step_ms,
            substeps: self.numbers.steps,
            real_time_factor: if moving { self.speed.value() } else { 0.0 },
            pace: self.pace.factor(),
            pace_chosen: self.pace.chosen,
            pace_choices: self.pace.choices,
            residual: self.numbers.residual,
            elastic: self.numbers.elastic,
            kinetic: self.numbers.kinetic,
            frame: self.frame(),
            first_frame: self.recording.first(),
            last_frame: self.recording.last(),
            frames_stored: self.recording.len(),
            bytes_stored: self.recording.bytes(),
            loads: self.loads.clone(),
            grabs: self.grabs(),
        }
    }

    /// Mode: time runs, or the reason why not.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// True while time runs.
    pub fn moving(&self) -> bool {
        self.mode == Mode::Playing
    }

    /// True if play was requested, so that time runs again once a load or a grab wakes the body.
    pub fn wants_play(&self) -> bool {
        self.wants_play
    }

    /// The problem, with the loads as they are now.
    pub fn problem(&self) -> &Problem {
        self.stepper.problem()
    }

    /// Number of the displayed frame.
    pub fn frame(&self) -> u64 {
        self.shown.as_ref().map_or(self.frame, |shown| shown.number)
    }

    /// Time of the displayed frame in s.
    pub fn time(&self) -> f64 {
        let now = || self.stepper.state().time;
        self.shown.as_ref().map_or_else(now, |shown| shown.time)
    }

    /// The displayed frame, with its loads and grabs.
    pub fn shown(&self) -> Shown {
        let (loads, grabs) = match &self.shown {
            Some(shown) => (shown.loads.clone(), shown.grabs.clone()),
            None => (self.loads.clone(), self.grabs()),
        };
        Shown {
            frame: self.frame(),
            time: self.time(),
            loads,
            grabs,
        }
    }

    /// True while the body still has its unloaded shape.
    pub fn unloaded(&self) -> bool {
        self.numbers.steps == 0 && !self.solved
    }

    /// State of the displayed frame; a recorded one has zero velocities.
    pub fn state(&self) -> Cow<'_, State> {
        match &self.shown {
            Some(shown) => Cow::Owned(shown.state()),
            None => Cow::Borrowed(self.stepper.state()),
        }
    }

    /// Packs the topology message of the display.
    pub fn topology(&self) -> Vec<u8> {
        let body = self.stepper.problem().body();
        self.surface.topology(body, self.topology)
    }

    /// Packs the message of the displayed frame, on the surface or on another display of the same body. `seq` is the
    /// number of the last command that the reader sent.
    pub fn pack_frame(&self, field: Field, seq: u32, display: Option<&Display>) -> Vec<u8> {
        let flags = match self.mode {
            Mode::Playing => 0,
            Mode::Paused | Mode::Past => frame_flag::PAUSED,
            Mode::AtRest => frame_flag::PAUSED | frame_flag::AT_REST,
            Mode::Diverged => frame_flag::PAUSED | frame_flag::DIVERGED,
        };
        let head = FrameHead {
            topology: self.topology,
            frame: self.frame() as u32,
            seq,
            flags,
        };
        let body = self.stepper.problem().body();
        let display = display.unwrap_or(&self.surface);
        display.frame(body, &self.state(), field, head)
    }

    /// Present contacts and poses of objects; none without contact.
    pub fn moment(&self) -> Option<Event> {
        let touching = self.touching.as_ref()?;
        let state = self.stepper.state();
        let problem = self.stepper.problem();
        let moment = touching.moment((self.frame, state.time), problem, &state.positions);
        let topology = self.topology;
        Some(Event::Moment(MomentOf { topology, moment }))
    }

    /// Returns all rows of the plots, to replace those that a reader has.
    pub fn whole_plot(&self) -> Plot {
        self.plots.whole(self.topology)
    }

    /// Active grabs with their forces.
    pub fn grabs(&self) -> Vec<GrabState> {
        let positions = &self.stepper.state().positions;
        let asked = |id: u32| self.held.get(&id);
        let grabs = self.stepper.grabs().iter();
        let grabs = grabs.filter_map(|(id, grab)| Some((*id, grab, asked(*id)?)));
        let of_body = grabs.map(|(id, grab, asked)| {
            let position = positions[grab.vertex as usize];
            GrabState {
                id,
                vertex: asked.vertex,
                object: None,
                target: grab.target,
                stiffness: asked.stiffness,
                force: grab.force(position),
                stretch: norm(sub(grab.anchor, position)),
            }
        });
        let of_objects = self.held.iter();
        let of_objects = of_objects.filter_map(|(id, held)| self.hold_of(*id, held));
        of_body.chain(of_objects).collect()
    }

    pub(crate) fn picked(&self, point: usize) -> Result<Picked, Refusal> {
        let vertex = self.vertex(point)? as usize;
        let body = self.stepper.problem().body();
        let state = self.state();
        let values = Field::ALL.map(|field| {
            let called = name_of(field);
            Value {
                field: field as u16,
                name: called.name,
                value: finite(self.surface.values(body, &state, field)[point]),
                unit: called.unit,
            }
        });
        let position: Vec3 = state.positions[vertex];
        Ok(Picked {
            vertex: point,
            rest: body.rest()[vertex],
            position,
            values: values.into(),
        })
    }
}
