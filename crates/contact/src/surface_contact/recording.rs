//! Recorded contact that can be retraced along its path.

use voxsoft_solid::vector::{Vec3, add, axpy, dot, norm, sub};
use voxsoft_solid::{Contact, Moment, RecordedContact};

use super::state::{ContactState, Facing, Held, Recording, Regime, SampleMemory};
use super::{CREEP, SurfaceContact};
use crate::gap::normal;

/// Smallest cosine between the normal at an edge and that of the triangle there for which the facing turns with the
/// triangle: 0.08 degrees. Surfaces in contact are so near that the normal to the closest point is rounded to 10⁻⁵.
const FLUSH: f64 = 1.0 - 1e-6;

/// Friction bound that counts as nothing, as a part of the largest one.
const NOTHING: f64 = 1e-4;

impl ContactState {
    /// Records an equilibrium before its correction, if the path is recorded.
    pub fn keep_moment(&mut self, positions: &[Vec3]) {
        let extrapolated = self.extrapolated.take();
        if let Some(recording) = &mut self.recording {
            recording.pending.push(Moment {
                positions: positions.to_vec(),
                settled: false,
                memory: Held {
                    now: self.now.clone(),
                    facing: self.facing.clone(),
                    stick: self.stick,
                    extrapolated,
                    precise: true,
                    regimes: Vec::new(),
                },
            });
        }
    }

    /// Marks contact as settled at the last equilibrium, and if it is as precise as asked for.
    pub fn settle_moment(&mut self, precise: bool) {
        let pending = self
            .recording
            .as_mut()
            .map(|recording| &mut recording.pending);
        if let Some(last) = pending.and_then(|pending| pending.last_mut()) {
            last.settled = true;
            last.memory.precise = precise;
        }
    }

    /// Accepts the moments recorded since the last accepted state as a step of the path.
    pub fn keep_step(&mut self) {
        if let Some(recording) = &mut self.recording {
            recording.accepted.append(&mut recording.pending);
        }
    }

    /// Drops the moments recorded since the last accepted state.
    pub fn drop_step(&mut self) {
        if let Some(recording) = &mut self.recording {
            recording.pending.clear();
        }
    }
}

impl RecordedContact for SurfaceContact {
    type Memory = Held;

    fn moment(&self, positions: &[Vec3]) -> Moment<Held> {
        let state = &self.state;
        let mut moment = Moment {
            positions: positions.to_vec(),
            settled: true,
            memory: Held {
                now: state.now.clone(),
                facing: state.facing.clone(),
                stick: state.stick,
                extrapolated: None,
                precise: true,
                regimes: self.regimes_at(positions),
            },
        };
        self.turn_with_planes(&mut moment);
        moment
    }

    fn record(&mut self) {
        self.state.recording = Some(Recording::default());
    }

    fn take_recorded(&mut self) -> Vec<Moment<Held>> {
        let recording = self.state.recording.take();
        let mut moments = recording.map_or_else(Vec::new, |recording| recording.accepted);
        for moment in &mut moments {
            self.turn_with_planes(moment);
        }
        moments
    }

    fn recall(&mut self, moment: &Moment<Held>) -> bool {
        self.face_as(moment);
        self.change(|contact, state| {
            state.now.clone_from(&moment.memory.now);
            state.retraces = true;
            let pairs = contact.pairs_of_stiffness(state, &moment.positions);
            let before = state.pattern.len();
            state.pattern.extend(pairs);
            state.pattern.len() > before
        })
    }

    fn face_as(&mut self, moment: &Moment<Held>) {
        let state = &mut self.state;
        state.facing.clone_from(&moment.memory.facing);
        state.stick = moment.memory.stick;
    }

    fn begin_step(group: &mut [&mut Self], positions: &[Vec<Vec3>], moment: &Moment<Held>) {
        let given = parts_since(moment);
        for (contact, positions) in group.iter_mut().zip(positions) {
            contact.state.given_since.clone_from(&given);
            contact.face_as(moment);
            contact.anchor_as(moment, positions);
            let memories = contact.state.now.iter_mut();
            for (memory, regime) in memories.zip(&moment.memory.regimes) {
                memory.regime = Some(*regime);
            }
        }
        bring_all_around(group, moment);
    }

    fn follow_on(
        group: &mut [&mut Self],
        positions: &[Vec<Vec3>],
        moment: &Moment<Held>,
        next: Option<&Moment<Held>>,
    ) {
        let given = next.map_or_else(Vec::new, parts_since);
        for (contact, positions) in group.iter_mut().zip(positions) {
            contact.state.given_since.clone_from(&given);
            contact.follow_to(positions, moment.settled);
            if moment.settled
                && let Some(ratio) = next.and_then(|next| next.memory.extrapolated)
            {
                contact.extrapolate(ratio);
            }
        }
        if let Some(next) = next {
            bring_all_around(group, next);
        }
    }
}

/// Parts of the step that remained for all samples of a moment when they came into contact.
fn parts_since(moment: &Moment<Held>) -> Vec<f64> {
    let memories = moment.memory.now.iter();
    memories.map(|memory| memory.since).collect()
}

/// Shifts the multipliers and anchors of contacts so that their mean is that of a moment.
fn bring_all_around(group: &mut [&mut SurfaceContact], moment: &Moment<Held>) {
    let mut states: Vec<_> = group.iter_mut().map(|contact| &mut contact.state).collect();
    for (sample, own) in moment.memory.now.iter().enumerate() {
        let mut of_sample: Vec<&mut SampleMemory> = states
            .iter_mut()
            .map(|state| &mut state.now[sample])
            .collect();
        bring_around(&mut of_sample, own);
    }
}

/// Shifts the multipliers of contacts at perturbed values so that their mean is that of the unperturbed one: only their
/// differences are followed, and nothing drifts.
fn bring_around(around: &mut [&mut SampleMemory], own: &SampleMemory) {
    let part = 1.0 / around.len() as f64;
    let mut mean = SampleMemory::default();
    let mut weights = [0.0; 3];
    let mut along = 0.0;
    let anchored = own.anchor.filter(|own| {
        let same =
            |memory: &&mut SampleMemory| memory.anchor.is_some_and(|anchor| anchor.0 == own.0);
        around.iter().all(same)
    });
    for memory in around.iter() {
        mean.normal += part * memory.normal;
        mean.bound += part * memory.bound;
        axpy(&mut mean.friction, part, memory.friction);
        axpy(&mut mean.plane, part, memory.plane);
        along += part * memory.along;
        axpy(
            &mut weights,
            part,
            memory.anchor.map_or([0.0; 3], |anchor| anchor.1),
        );
    }
    for memory in around {
        memory.normal += own.normal - mean.normal;
        memory.bound += own.bound - mean.bound;
        memory.friction = add(memory.friction, sub(own.friction, mean.friction));
        memory.plane = add(memory.plane, sub(own.plane, mean.plane));
        memory.anchor = match (anchored, memory.anchor) {
            (Some(own), Some((triangle, now))) => Some((triangle, add(now, sub(own.1, weights)))),
            _ => own.anchor,
        };
        memory.along = match anchored {
            Some(_) => memory.along + own.along - along,
            None => own.along,
        };
    }
}

impl SurfaceContact {
    /// Takes first anchors of samples that have come into contact by a moment, from the way to `positions` (m).
    fn anchor_as(&mut self, moment: &Moment<Held>, positions: &[Vec3]) {
        let points = self.points_at(positions);
        let samples = moment.memory.now.iter().zip(&moment.memory.facing);
        for (sample, (own, facing)) in samples.enumerate() {
            if own.anchor.is_none() || self.state.now[sample].anchor.is_some() {
                continue;
            }
            let meeting = facing.and_then(|facing| self.meeting(sample as u32, facing, &points));
            if let Some(meeting) = meeting {
                let (anchor, along, since) = self.first_anchor(&self.state, &meeting, &points);
                let memory = &mut self.state.now[sample];
                (memory.anchor, memory.along, memory.since) = (Some(anchor), along, since);
            }
        }
    }

    /// Regime of each sample at `positions` (m). Friction that is [`NOTHING`] has no direction to the first order.
    fn regimes_at(&self, positions: &[Vec3]) -> Vec<Regime> {
        let state = &self.state;
        let points = self.points_at(positions);
        let bounds = state.now.iter().map(|memory| memory.bound);
        let least = NOTHING * bounds.fold(0.0, f64::max);
        let of_sample = |(sample, memory): (usize, &SampleMemory)| Regime {
            pressed: false,
            slips: self
                .friction(state, sample as u32, &points)
                .filter(|_| memory.bound > least)
                .map(|friction| friction.found.slips),
        };
        let mut regimes: Vec<Regime> = state.now.iter().enumerate().map(of_sample).collect();
        self.each_contact(state, positions, |meeting, normal, _| {
            regimes[meeting.sample as usize].pressed = normal.pressure > 0.0;
        });
        regimes
    }

    /// Corrects the multipliers, or accepts the state if contact has `settled`.
    fn follow_to(&mut self, positions: &[Vec3], settled: bool) {
        if !settled {
            (self.state.now, _) = self.corrected(&self.state, positions);
            return;
        }
        let points = self.points_at(positions);
        let moved = self.carried_on(&self.state, positions);
        let state = &mut self.state;
        state.accepted_points = points;
        let mut moved = moved;
        moved.iter_mut().for_each(|memory| memory.regime = None);
        state.before = std::mem::replace(&mut state.accepted, moved.clone());
        state.now = moved;
    }

    /// Tests whether another contact has the same surfaces, at any positions.
    pub fn has_surfaces_of(&self, other: &Self) -> bool {
        let sizes = |contact: &Self| {
            let surfaces = contact.description.surfaces.iter();
            surfaces.map(|s| s.points.len()).collect::<Vec<_>>()
        };
        self.triangles == other.triangles && sizes(self) == sizes(other)
    }

    /// Tests whether contact has settled to the requested precision in all recorded steps.
    pub fn recorded_precisely(&self) -> bool {
        let state = &self.state;
        let mut moments = state
            .recording
            .iter()
            .flat_map(|recording| &recording.accepted);
        moments.all(|moment| moment.memory.precise)
    }

    /// Largest fraction of the pressure between surfaces with friction that slips, of the recorded steps: by more than
    /// the tolerance of creep.
    pub fn recorded_slip(&self) -> f64 {
        let state = &self.state;
        let moments = state
            .recording
            .iter()
            .flat_map(|recording| &recording.accepted);
        let steps = moments.filter(|moment| moment.settled);
        steps.map(|moment| self.slip_at(moment)).fold(0.0, f64::max)
    }

    /// Largest fraction of the pressure between surfaces with friction on samples that came into contact after the
    /// first of the recorded steps.
    pub fn recorded_touching_later(&self) -> f64 {
        let state = &self.state;
        let moments = state
            .recording
            .iter()
            .flat_map(|recording| &recording.accepted);
        let mut steps = moments.filter(|moment| moment.settled);
        let Some(first) = steps.next() else {
            return 0.0;
        };
        let later = |moment: &Moment<Held>| {
            let (mut pressed, mut late) = (0.0, 0.0);
            for (then, now) in first.memory.now.iter().zip(&moment.memory.now) {
                if now.bound > 0.0 {
                    pressed += now.normal;
                    late += if then.bound > 0.0 { 0.0 } else { now.normal };
                }
            }
            if pressed > 0.0 { late / pressed } else { 0.0 }
        };
        steps.map(later).fold(0.0, f64::max)
    }

    fn slip_at(&self, moment: &Moment<Held>) -> f64 {
        let state = ContactState {
            now: moment.memory.now.clone(),
            stick: moment.memory.stick,
            ..ContactState::default()
        };
        let points = self.points_at(&moment.positions);
        let (mut pressed, mut slipping) = (0.0, 0.0);
        self.each_friction(&state, &moment.positions, |sample, friction| {
            let (triangle, weights) = friction.anchor;
            let memory = &state.now[sample as usize];
            let mut slip = self.place(sample, friction.along, &points);
            for (weight, corner) in weights.iter().zip(self.corners(triangle, &points)) {
                axpy(&mut slip, -weight, corner);
            }
            let away = dot(slip, memory.plane);
            axpy(&mut slip, -away, memory.plane);
            pressed += memory.normal;
            if friction.found.slips && norm(slip) > CREEP * self.description.voxel {
                slipping += memory.normal;
            }
        });
        if pressed > 0.0 {
            slipping / pressed
        } else {
            0.0
        }
    }

    /// Replaces an edge within a flat surface by the plane of its triangle as the face that a sample meets, whose
    /// normal turns with the triangle: along a path the normal at an edge is found anew with each correction.
    fn turn_with_planes(&self, moment: &mut Moment<Held>) {
        let points = self.points_at(&moment.positions);
        for facing in moment.memory.facing.iter_mut().flatten() {
            if let Facing::Edge(triangle, _, outward) = *facing
                && dot(normal(self.corners(triangle, &points)), outward) > FLUSH
            {
                *facing = Facing::Plane(triangle);
            }
        }
    }
}
