//! Contact along a load path: contact search, corrections of multipliers, motion of anchors.

use std::any::Any;
use std::collections::BTreeSet;

use voxsoft_solid::vector::{Vec3, norm, scale, sub};
use voxsoft_solid::{Contact, ContactMemory, Precision};

use super::state::{BeforePrediction, ContactState, Facing, Hold, Recording, SampleMemory};
use super::{
    APART, BOUND, CREEP, DEEPEST, LOOKS, LOST, PATIENCE, PRECISE, STICK, STIFFER, STRAYED,
    SurfaceContact, listing, predicted,
};
use crate::gap;
use crate::threads;

/// Largest ratio of pairs in the sparsity pattern to pairs with stiffness, if these are [`MANY`]. Sliding samples pass
/// many triangles, and a diverging iteration any.
const WASTE: usize = 2;
const MANY: usize = 100;
/// Largest extrapolation of multipliers, in steps.
const LONGEST_EXTRAPOLATION: f64 = 2.0;

impl Contact for SurfaceContact {
    fn boxed(&self) -> Box<dyn Contact> {
        Box::new(self.clone())
    }

    fn found_by(&self) -> &dyn Any {
        self
    }

    fn found_by_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn memory(&self) -> ContactMemory {
        ContactMemory::new(self.state.clone())
    }

    fn remember(&mut self, memory: &ContactMemory) {
        if let Some(state) = memory.get::<ContactState>() {
            self.state.clone_from(state);
        }
    }

    fn read_memory(&self, bytes: &[u8]) -> Option<ContactMemory> {
        ContactMemory::read::<ContactState>(bytes)
    }

    fn visit_bonded(&self, visit: &mut dyn FnMut(u32)) {
        for (_, tie) in self.ties() {
            for side in [&tie.first, &tie.second] {
                side.vertices.iter().for_each(|&vertex| visit(vertex));
            }
        }
    }

    fn reset(&mut self, positions: &[Vec3]) {
        self.change(|contact, state| {
            let points = contact.points_at(positions);
            let nothing = vec![SampleMemory::default(); contact.samples.len()];
            let untouched = vec![Hold::default(); contact.ties().count()];
            *state = ContactState {
                accepted_points: points.clone(),
                accepted_facing: vec![None; contact.samples.len()],
                accepted: nothing.clone(),
                before: nothing.clone(),
                now: nothing,
                accepted_holds: untouched.clone(),
                holds: untouched,
                stick: STICK[0],
                off: f64::INFINITY,
                crept: f64::INFINITY,
                recording: state.recording.is_some().then(Recording::default),
                ..ContactState::default()
            };
            contact.list_from_accepted(state, points);
            contact.face(state, positions, true);
        })
    }

    fn follow(&mut self, positions: &[Vec3]) -> bool {
        self.change(|contact, state| {
            let points = contact.points_at(positions);
            if !(contact.farthest_from_listed(state, &points) <= listing::REACH / 2.0) {
                contact.list(state, points);
                state.listed_at_rest = false;
            }
            let all = state.looks > 0;
            state.looks = state.looks.saturating_sub(1);
            contact.face(state, positions, all);
            let before = state.pattern.len();
            let pairs = contact.pairs_of_stiffness(state, positions);
            state.pattern.extend(pairs);
            let shrank = std::mem::take(&mut state.pattern_shrank);
            state.pattern.len() > before || shrank
        })
    }

    fn relist(&mut self) {
        self.state.looks = LOOKS;
    }

    fn correct(&mut self, positions: &[Vec3], negligible: f64, precision: Precision) -> bool {
        self.change(|contact, state| {
            state.keep_moment(positions);
            let (now, beyond) = contact.corrected(state, positions);
            for memory in &mut state.now {
                memory.unbounded = false;
            }
            state.corrections += 1;
            let patient = state.corrections <= PATIENCE;
            let mut friction =
                contact.off_bounds(&state.now, &now, BOUND[usize::from(!patient)], negligible);
            let mut farthest = 0.0f64;
            let mut gaps = 0.0f64;
            let (mut lost, mut bounds) = (0.0, negligible);
            let points = contact.points_at(positions);
            for (sample, (old, new)) in state.now.iter().zip(&now).enumerate() {
                if old == new {
                    continue;
                }
                let unit = contact.penalty(sample as u32) * contact.description.voxel;
                let pressed = (new.normal - old.normal) / unit;
                let crept = norm(sub(new.friction, old.friction)) / (state.stick * unit);
                gaps = gaps.max(pressed / DEEPEST).max(-pressed / APART);
                bounds += new.bound;
                if old.bound > 0.0 && new.bound == 0.0 {
                    let friction = contact.friction(state, sample as u32, &points);
                    lost += friction.map_or(0.0, |friction| norm(friction.found.force));
                }
                farthest = farthest.max(crept / CREEP);
            }
            let (holds, off) = contact.corrected_ties(state, positions);
            gaps = gaps.max(farthest).max(off);
            friction = friction.max(beyond / BOUND[0]);
            if lost > 0.0 {
                friction = friction.max(lost / (LOST * bounds));
            }
            let mut enough = if state.corrections <= PRECISE {
                precision
            } else {
                Precision::DEFAULT
            };
            // Samples that share a force approach their gaps slowly, hardly in motion. Derivatives ask for them all the
            // same.
            if state.recording.is_none() && gaps > state.off / 2.0 {
                enough.gaps = Precision::DEFAULT.gaps;
            }
            state.off = gaps;
            if farthest > enough.gaps && farthest > state.crept / STIFFER {
                state.stick = (STIFFER * state.stick).min(STICK[1]);
            }
            state.crept = farthest;
            // The forces of a settled state are those of its equilibrium, not of multipliers that came after. Edges
            // search once points have settled: while these are still too deep, the edges beside them are so too.
            let close = gaps <= enough.gaps && friction <= enough.friction;
            let settled = close && !(patient && contact.face_edges(state, positions));
            if settled {
                state.settle_moment(enough == precision);
            } else {
                state.now = now;
                state.holds = holds;
                state.looks = u32::from(patient);
            }
            settled
        })
    }

    fn begin_prediction(&mut self) -> bool {
        // Derivatives retrace equilibria, each with the multipliers of the one before.
        let state = &mut self.state;
        let may = state.recording.is_none();
        if may {
            state.before_prediction = Some(BeforePrediction {
                now: state.now.clone(),
                facing: state.facing.clone(),
                stick: state.stick,
                looks: state.looks,
            });
            state.predicted.clear();
            Self::let_stick(state);
        }
        may
    }

    fn end_prediction(&mut self, converged: bool) {
        let state = &mut self.state;
        if let Some(before) = state.before_prediction.take()
            && !converged
        {
            (state.now, state.facing) = (before.now, before.facing);
            (state.stick, state.looks) = (before.stick, before.looks);
        }
    }

    fn take_prediction(&mut self, positions: &[Vec3], moves: &[Vec3]) {
        self.change(|contact, state| {
            (state.now, state.predicted) =
                contact.predicted_multipliers(state, positions, &state.predicted, moves);
        });
    }

    fn length(&self) -> f64 {
        self.description.voxel
    }

    fn release_bonds(&mut self, positions: &[Vec3]) -> bool {
        self.change(|contact, state| {
            let any = contact.break_ties(state, positions);
            if any {
                // Surfaces whose ties broke may be in contact now.
                let points = contact.points_at(positions);
                contact.list(state, points);
                (state.listed_at_rest, state.corrections) = (false, 0);
                state.edges_listed_points.clear();
                state.off = f64::INFINITY;
                state.looks = LOOKS;
            }
            any
        })
    }

    fn depends_on_way(&self) -> bool {
        let table = self.description.friction.iter().flatten();
        let rough = table.into_iter().any(|coefficient| *coefficient > 0.0);
        rough
            || self
                .description
                .bonds
                .iter()
                .any(|bond| bond.strength.is_finite())
    }

    fn deviation(&self, positions: &[Vec3], ratio: f64) -> Option<f64> {
        self.deviation_of_friction(positions, ratio)
    }

    fn accept(&mut self, positions: &[Vec3]) {
        self.change(|contact, state| {
            let rubs = contact.friction_on_vertices(state, positions);
            state.accepted_friction.rotate_right(1);
            state.accepted_friction[0] = rubs;
            let moved = contact.carried_on(state, positions);
            state.keep_step();
            let pairs = contact.pairs_of_stiffness(state, positions);
            if state.pattern.len() > WASTE * pairs.len().max(MANY) {
                state.pattern = pairs;
                state.pattern_shrank = true;
            }
            let points = contact.points_at(positions);
            state.accepted_points.clone_from(&points);
            state.accepted_facing = state.facing.clone();
            state.before = std::mem::replace(&mut state.accepted, moved.clone());
            state.now = moved;
            state.accepted_holds = state.holds.clone();
            (state.off, state.crept, state.corrections) = (f64::INFINITY, f64::INFINITY, 0);
            contact.list_from_accepted(state, points);
        })
    }

    fn rollback(&mut self) {
        self.change(|contact, state| {
            state.drop_step();
            state.extrapolated = None;
            state.now = state.accepted.clone();
            state.facing = state.accepted_facing.clone();
            if state
                .holds
                .iter()
                .zip(&state.accepted_holds)
                .any(|(a, b)| a.broken != b.broken)
            {
                state.listed_at_rest = false;
            }
            state.holds = state.accepted_holds.clone();
            (state.stick, state.corrections) = (STICK[0], 0);
            (state.off, state.crept) = (f64::INFINITY, f64::INFINITY);
            let points = state.accepted_points.clone();
            contact.list_from_accepted(state, points);
        })
    }

    fn is_recorded(&self) -> bool {
        self.state.recording.is_some()
    }

    fn extrapolate(&mut self, ratio: f64) {
        let state = &mut self.state;
        state.extrapolated = Some(ratio);
        let ratio = ratio.min(LONGEST_EXTRAPOLATION);
        let ContactState {
            now,
            accepted,
            before,
            ..
        } = state;
        for (now, (last, before)) in now.iter_mut().zip(accepted.iter().zip(before)) {
            if !(last.normal > 0.0 && before.normal > 0.0) {
                continue;
            }
            let on = |last: f64, before: f64| last + ratio * (last - before);
            now.normal = on(last.normal, before.normal).max(0.0);
            now.bound = on(last.bound, before.bound).max(0.0);
            let friction = [0, 1, 2].map(|i| on(last.friction[i], before.friction[i]));
            let most = now.bound / norm(friction).max(now.bound);
            now.friction = if most.is_finite() {
                scale(most, friction)
            } else {
                [0.0; 3]
            };
        }
    }
}

impl SurfaceContact {
    /// Multipliers and anchors of samples after a correction with the forces at `positions`, and the largest part by
    /// which friction without a bound exceeds it.
    pub(super) fn corrected(
        &self,
        state: &ContactState,
        positions: &[Vec3],
    ) -> (Vec<SampleMemory>, f64) {
        let mut beyond = 0.0f64;
        // A sample that loses contact for now keeps its anchor: it may come back before the state is accepted.
        let mut now: Vec<SampleMemory> = state.now.iter().map(SampleMemory::anchor_only).collect();
        self.each_contact(state, positions, |meeting, normal, points| {
            let pressure = normal.pressure;
            let sample = meeting.sample as usize;
            let memory = &state.now[sample];
            if !memory.is_pressed(pressure) {
                return;
            }
            let friction = self.friction(state, meeting.sample, points);
            let law = self.law(meeting.sample, meeting.triangle);
            let coefficient = self.coefficient(meeting.sample, meeting.triangle);
            let bound = law.bound(coefficient, pressure);
            let mut force = friction.map_or([0.0; 3], |friction| friction.found.force);
            if memory.slips_as_prescribed() {
                // Its direction is that of its multiplier and its slip: a bound near zero must not turn it.
                force = memory.friction;
            }
            let size = norm(force);
            if memory.unbounded && size > bound {
                force = scale(bound / size, force);
                beyond = beyond.max(size / bound - 1.0);
            }
            let (anchor, along, since) = memory.anchor.map_or_else(
                || self.first_anchor(state, meeting, points),
                |anchor| (anchor, memory.along, memory.since),
            );
            now[sample] = SampleMemory {
                normal: pressure,
                friction: force,
                plane: meeting.normal,
                bound,
                anchor: Some(anchor),
                along,
                since,
                unbounded: false,
                regime: memory.regime,
            };
        });
        (now, beyond)
    }

    /// Multipliers and anchors of samples from an accepted state on: the anchors of slipping samples move along.
    pub(super) fn carried_on(&self, state: &ContactState, positions: &[Vec3]) -> Vec<SampleMemory> {
        let mut moved = vec![SampleMemory::default(); self.samples.len()];
        self.each_contact(state, positions, |meeting, normal, points| {
            let memory = &mut moved[meeting.sample as usize];
            let now = &state.now[meeting.sample as usize];
            if !now.is_pressed(normal.pressure) {
                return;
            }
            *memory = *now;
            let friction = self.friction(state, meeting.sample, points);
            if friction.is_none_or(|friction| friction.found.slips) {
                memory.friction = friction.map_or([0.0; 3], |friction| friction.found.force);
                let anchor = self.foot_across(meeting, memory.plane, points);
                (memory.anchor, memory.along) = (Some(anchor), meeting.along);
            }
        });
        moved
    }

    /// Lists candidates from the accepted state on, unless that state has not moved since they were listed.
    fn list_from_accepted(&self, state: &mut ContactState, points: Vec<Vec3>) {
        if !(state.listed_at_rest && self.farthest_from_listed(state, &points) <= listing::SAME) {
            self.list(state, points);
            state.listed_at_rest = true;
        }
        state.looks = LOOKS;
    }

    /// Samples and triangles that have stiffness at `positions`, or may keep it there by a predicted pressure.
    pub(super) fn pairs_of_stiffness(
        &self,
        state: &ContactState,
        positions: &[Vec3],
    ) -> BTreeSet<(u32, u32)> {
        let mut pairs = BTreeSet::new();
        let kept = predicted::KEPT * self.description.voxel;
        self.each_meeting(state, positions, |meeting, points| {
            let presses = || self.normal(&state.now[meeting.sample as usize], meeting, points);
            let near = self
                .gap_to_clearance(meeting)
                .is_some_and(|gap| gap <= kept);
            if near || presses().is_some() {
                pairs.insert((meeting.sample, meeting.triangle));
            }
        });
        self.each_friction(state, positions, |sample, friction| {
            pairs.insert((sample, friction.anchor.0));
        });
        pairs
    }

    /// Largest motion of any point since candidates were listed, in voxels.
    pub(super) fn farthest_from_listed(&self, state: &ContactState, points: &[Vec3]) -> f64 {
        self.farthest_between(&state.listed_points, points)
    }

    /// Largest motion of any point from those of a list, in voxels; infinite if there is none.
    pub(super) fn farthest_between(&self, listed: &[Vec3], points: &[Vec3]) -> f64 {
        if listed.len() != points.len() {
            return f64::INFINITY;
        }
        let moved = |(a, b): (&Vec3, &Vec3)| norm(sub(*a, *b));
        let farthest = points.iter().zip(listed).map(moved);
        farthest.fold(0.0, f64::max) / self.description.voxel
    }

    /// Updates the faces that samples meet: of all of them, or of those that have strayed from theirs.
    pub(super) fn face(&self, state: &mut ContactState, positions: &[Vec3], all: bool) {
        let points = self.points_at(positions);
        let facing = |index: usize| {
            if self.samples[index].is_edge() {
                return self.keep_across(state, index, &points);
            }
            if state.candidates[index].is_empty() {
                return None;
            }
            let point = points[index];
            let strayed = match state.facing[index] {
                Some(Facing::Plane(triangle)) => {
                    let weights = gap::affine(point, self.corners(triangle, &points));
                    weights.iter().any(|w| *w < -STRAYED)
                }
                Some(_) => false,
                None => true,
            };
            if all || strayed {
                self.look(state, index, point, &points)
            } else {
                state.facing[index]
            }
        };
        state.facing = threads::map(self.samples.len(), facing);
    }
}
