//! Contact for live motion: dynamic steps without a converged augmented-Lagrange loop.
//!
//! A step minimizes with fixed multipliers and corrects them once, at its end: bodies that are held still settle within
//! some steps, and sticking samples keep their anchors. The penalty is moderate, of the stiffness of the voxels in
//! contact, so that an old factor of the tangent serves where contact has opened or closed since. The penetration of
//! one step is pressure over penalty, `2 p h/(50 E)`, until multipliers carry the load.
//!
//! - A multiplier takes the smaller of the pressures of two steps: the pressure of an impact would otherwise push again
//!   in the next step, and bodies would rebound with their impact velocity.
//! - Friction begins in the step after the first contact.
//! - Candidates are listed anew only if something has moved by half of their reach, and energies and forces go through
//!   the samples that have some.

use std::any::Any;
use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::element::hex8::Tangent;
use voxsoft_solid::vector::{Vec3, scale};
use voxsoft_solid::{Contact, ContactMemory, Precision, ProblemError, Term};

use super::friction::Friction;
use super::law::Normal;
use super::state::{ContactState, SampleMemory};
use super::{ContactPair, Description, LOOKS, SurfaceContact, listing};
use crate::gap;

/// Contact penalty in units of Young's modulus over the voxel size, and slip penalty relative to it.
const PENALTY: f64 = 8.0;
const STICK: f64 = 1.0;
/// Depth of a sample beyond which the penalty grows within a step, in voxels, and the factor of this growth.
const DEEP: f64 = 0.05;
const STIFFER: f64 = 4.0;
/// Largest depth of a sample after a step, in voxels: beyond [`listing::DEPTH`] its side is lost.
const DEEPEST: f64 = 0.8 * listing::DEPTH;
/// Rejections of a step that is too deep, before samples that are too deep are released.
const REFUSALS: u32 = 2;

/// Contact of surfaces, for live motion.
#[derive(Debug, Clone)]
pub struct LiveSurfaceContact {
    contact: SurfaceContact,
    /// Memory beside the state of `contact`.
    run: Run,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Run {
    /// Samples that face something.
    near: Vec<u32>,
    /// Pressure of each sample at the end of the last step, N.
    borne: Vec<f64>,
    /// Consecutive steps rejected as too deep.
    refused: u32,
    /// Largest depth of released samples since the start, m.
    lost: f64,
    /// Samples and triangles in the sparsity pattern of the stiffness.
    pattern: BTreeSet<(u32, u32)>,
}

impl LiveSurfaceContact {
    /// Sets up contact for a problem with the vertices `rest` (m).
    pub fn new(description: Description, rest: &[Vec3]) -> Result<Self, ProblemError> {
        let contact = SurfaceContact::new(description, rest)?.without_edges(rest);
        let mut live = Self {
            contact,
            run: Run::default(),
        };
        Contact::reset(&mut live, rest);
        Ok(live)
    }

    /// Contact with the multipliers of the last step: for reports and contact fields.
    pub fn contact(&self) -> &SurfaceContact {
        &self.contact
    }

    /// Depth of the deepest sample (m) if it exceeds the limit of a step; once a sample was released as too deep, also
    /// at least that depth.
    pub fn excess_depth(&self, positions: &[Vec3]) -> Option<f64> {
        let depth = self.depth(positions).max(self.run.lost);
        Some(depth).filter(|depth| *depth > DEEP * self.contact.description.voxel)
    }

    /// Depth of the deepest sample in the surface that it faces at `positions`, m.
    pub fn depth(&self, positions: &[Vec3]) -> f64 {
        let state = &self.contact.state;
        let mut deepest = 0.0f64;
        self.each_near(state, positions, |meeting| {
            deepest = deepest.max(-meeting.gap);
        });
        deepest
    }

    fn corners(&self, triangle: u32, positions: &[Vec3]) -> [Vec3; 3] {
        self.contact.triangles[triangle as usize].map(|point| self.point(point, positions))
    }

    /// Position of a point, which is the sample with its number.
    fn point(&self, point: u32, positions: &[Vec3]) -> Vec3 {
        self.contact.points[point as usize].at(positions)
    }

    /// Calls `take` with every sample that faces something.
    fn each_near(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(&ContactPair),
    ) {
        for &sample in &self.run.near {
            let Some(facing) = state.facing[sample as usize] else {
                continue;
            };
            let point = self.point(sample, positions);
            let corners = self.corners(facing.triangle(), positions);
            if let Some(meeting) = ContactPair::new(sample, facing, [point; 2], corners) {
                take(&meeting);
            }
        }
    }

    /// Calls `take` with every pressed sample and its forces along the normal.
    fn each_pressed(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(&ContactPair, Normal),
    ) {
        self.each_near(state, positions, |meeting| {
            let memory = &state.now[meeting.sample as usize];
            if let Some(normal) = self.contact.normal(memory, meeting, &[]) {
                take(meeting, normal);
            }
        });
    }

    fn friction(&self, state: &ContactState, sample: u32, positions: &[Vec3]) -> Option<Friction> {
        let memory = &state.now[sample as usize];
        if !(memory.bound > 0.0) {
            return None;
        }
        let point = self.point(sample, positions);
        let k = state.stick * self.contact.penalty(sample);
        Friction::new(
            memory,
            k,
            point,
            [true; 3],
            |triangle| self.contact.law(sample, triangle),
            |triangle| self.corners(triangle, positions),
        )
    }

    fn each_friction(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(u32, Friction),
    ) {
        for &sample in &self.run.near {
            if let Some(friction) = self.friction(state, sample, positions) {
                take(sample, friction);
            }
        }
    }

    /// Pairs that have stiffness at `positions`.
    fn pairs_of_stiffness(&self, state: &ContactState, positions: &[Vec3]) -> BTreeSet<(u32, u32)> {
        let mut pairs = BTreeSet::new();
        self.each_pressed(state, positions, |meeting, _| {
            pairs.insert((meeting.sample, meeting.triangle));
        });
        self.each_friction(state, positions, |sample, friction| {
            pairs.insert((sample, friction.anchor.0));
        });
        pairs
    }

    /// Lists the samples that face something or have friction.
    fn note_near(&mut self) {
        let state = &self.contact.state;
        let near = |sample: &u32| {
            let sample = *sample as usize;
            state.facing[sample].is_some() || state.now[sample].bound > 0.0
        };
        let all = 0..self.contact.samples.len() as u32;
        self.run.near = all.filter(near).collect();
    }

    /// Multipliers and anchor of a sample after a step that ended with a pressure on it.
    fn remembered(
        &self,
        state: &ContactState,
        meeting: &ContactPair,
        (pressure, borne): (f64, f64),
        positions: &[Vec3],
    ) -> SampleMemory {
        let friction = self.friction(state, meeting.sample, positions);
        let before = &state.now[meeting.sample as usize];
        let sticks = friction.is_some_and(|friction| !friction.found.slips);
        let anchor = match before.anchor {
            Some(anchor) if sticks => anchor,
            _ => {
                let corners = self.corners(meeting.triangle, positions);
                let point = self.point(meeting.sample, positions);
                (meeting.triangle, gap::affine(point, corners))
            }
        };
        let law = self.contact.law(meeting.sample, meeting.triangle);
        let coefficient = self.contact.coefficient(meeting.sample, meeting.triangle);
        SampleMemory {
            normal: pressure.min(borne),
            friction: friction.map_or([0.0; 3], |friction| friction.found.force),
            plane: meeting.normal,
            bound: law.bound(coefficient, pressure),
            anchor: Some(anchor),
            ..SampleMemory::default()
        }
    }
}

impl Contact for LiveSurfaceContact {
    fn visit_bonded(&self, visit: &mut dyn FnMut(u32)) {
        self.contact.visit_bonded(visit);
    }

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
        let SurfaceContact { penalty, state, .. } = &self.contact;
        ContactMemory::new((*penalty, state.clone(), self.run.clone()))
    }

    fn remember(&mut self, memory: &ContactMemory) {
        if let Some((penalty, state, run)) = memory.get::<(f64, ContactState, Run)>() {
            self.contact.penalty = *penalty;
            self.contact.state.clone_from(state);
            self.run.clone_from(run);
        }
    }

    fn read_memory(&self, bytes: &[u8]) -> Option<ContactMemory> {
        ContactMemory::read::<(f64, ContactState, Run)>(bytes)
    }

    fn reset(&mut self, positions: &[Vec3]) {
        self.contact.penalty = PENALTY;
        self.contact.reset(positions);
        self.contact.state.stick = STICK;
        self.note_near();
        let run = &mut self.run;
        run.borne = vec![0.0; self.contact.samples.len()];
        (run.refused, run.lost) = (0, 0.0);
        run.pattern.clear();
    }

    fn follow(&mut self, positions: &[Vec3]) -> bool {
        self.contact.change(|contact, state| {
            let points = contact.points_at(positions);
            let moved = contact.farthest_from_listed(state, &points);
            if !(moved <= listing::REACH / 2.0) {
                contact.list(state, points);
                state.listed_at_rest = false;
            }
            let all = state.looks > 0;
            state.looks = state.looks.saturating_sub(1);
            contact.face(state, positions, all);
        });
        self.note_near();
        let pairs = self.pairs_of_stiffness(&self.contact.state, positions);
        let outgrown = !pairs.is_subset(&self.run.pattern);
        if outgrown {
            self.run.pattern = pairs;
        }
        outgrown
    }

    fn relist(&mut self) {
        self.contact.state.looks = LOOKS;
    }

    fn stiffen(&mut self, positions: &[Vec3]) -> bool {
        if self.depth(positions) <= DEEP * self.contact.description.voxel {
            return false;
        }
        self.contact.penalty *= STIFFER;
        true
    }

    fn correct(&mut self, positions: &[Vec3], negligible: f64, precision: Precision) -> bool {
        let settled = self.contact.correct(positions, negligible, precision);
        self.contact.state.stick = STICK;
        settled
    }

    fn length(&self) -> f64 {
        self.contact.length()
    }

    /// Bonds do not move live: designs with them wait for a solution.
    fn release_bonds(&mut self, _positions: &[Vec3]) -> bool {
        false
    }

    fn depends_on_way(&self) -> bool {
        self.contact.depends_on_way()
    }

    /// A step begins with the multipliers that the last one ended with.
    fn extrapolate(&mut self, _ratio: f64) {}

    fn accept(&mut self, positions: &[Vec3]) {
        self.contact.accept(positions);
        self.note_near();
    }

    fn commit_partial(&mut self, positions: &[Vec3]) -> bool {
        let depth = self.depth(positions);
        let deepest = DEEPEST * self.contact.description.voxel;
        if depth > deepest {
            self.run.refused += 1;
            if self.run.refused <= REFUSALS {
                return false;
            }
            self.run.lost = self.run.lost.max(depth);
        }
        let mut moved = vec![SampleMemory::default(); self.contact.samples.len()];
        let mut pressures = vec![0.0; moved.len()];
        let state = &self.contact.state;
        self.each_pressed(state, positions, |meeting, normal| {
            let pressure = normal.pressure;
            let sample = meeting.sample as usize;
            if -meeting.gap > deepest {
                return; // Released as too deep; see `excess_depth`.
            }
            pressures[sample] = pressure;
            let both = (pressure, self.run.borne[sample]);
            moved[sample] = self.remembered(state, meeting, both, positions);
        });
        let points = self.contact.points_at(positions);
        let state = &mut self.contact.state;
        state.accepted_points = points;
        state.accepted.clone_from(&moved);
        state.now = moved;
        state.looks = LOOKS;
        self.contact.penalty = PENALTY;
        (self.run.borne, self.run.refused) = (pressures, 0);
        true
    }

    fn is_touching(&self, positions: &[Vec3]) -> bool {
        let state = &self.contact.state;
        let mut touching = false;
        self.each_pressed(state, positions, |_, _| touching = true);
        touching
    }

    fn rollback(&mut self) {
        let state = &mut self.contact.state;
        state.now = state.accepted.clone();
        state.looks = LOOKS;
        self.contact.penalty = PENALTY;
        self.note_near();
    }
}

impl Term for LiveSurfaceContact {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn check(&self, vertices: usize) -> Result<(), ProblemError> {
        self.contact.check(vertices)
    }

    fn is_local(&self) -> bool {
        true
    }

    fn visit_pattern(&self, visit: &mut dyn FnMut(&[u32])) {
        for &pair in &self.run.pattern {
            self.contact.visit_pair(pair, visit);
        }
    }

    fn energy(&self, positions: &[Vec3]) -> f64 {
        let state = &self.contact.state;
        let mut energy = 0.0;
        self.each_pressed(state, positions, |_, normal| energy += normal.energy);
        self.each_friction(state, positions, |_, friction| {
            energy += friction.found.energy;
        });
        energy
    }

    fn add_forces(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let state = &self.contact.state;
        self.each_pressed(state, positions, |meeting, normal| {
            let force = scale(normal.force(), meeting.normal);
            self.contact.add_force(force, meeting.spot(), forces);
        });
        self.each_friction(state, positions, |sample, friction| {
            self.contact
                .add_force(friction.found.force, friction.spot(sample), forces);
        });
    }

    fn visit_stiffness(&self, positions: &[Vec3], visit: Visitor<'_>) {
        self.visit_tangent(positions, Tangent::Exact, visit);
    }

    /// Tangent without the geometric stiffness of contact, for any `Tangent`: so it is positive semidefinite, and
    /// serves longer. Pairs outside of the sparsity pattern are left out; the minimization tolerates an inexact
    /// tangent.
    fn visit_tangent(&self, positions: &[Vec3], _: Tangent, visit: Visitor<'_>) {
        let state = &self.contact.state;
        let pattern = &self.run.pattern;
        self.each_pressed(state, positions, |meeting, normal| {
            if pattern.contains(&(meeting.sample, meeting.triangle)) {
                self.contact
                    .visit_gap(meeting, [normal.stiffness, 0.0], &[], visit);
            }
        });
        self.each_friction(state, positions, |sample, friction| {
            if pattern.contains(&(sample, friction.anchor.0)) {
                self.contact.visit_friction(sample, &friction, visit);
            }
        });
    }
}
