//! Contact pressures and friction as independent unknowns of Newton's method.
//!
//! A step that lets two surfaces penetrate ends under spurious pressures, whose geometric stiffness would make the next
//! tangent indefinite. With the pressure `p` of every sample as an unknown of its own, Newton's method on `f(x) + Σ p
//! ∂g = 0` and `p = ⟨λ − k (g − δ)⟩` solves, as for strains ([`voxsoft_solid::element::assumed_strain`]),
//!
//! `(K + Σ k ∂g ∂gᵀ + Σ p̂ ∂²g) δ = f + Σ ⟨λ − k (g − δ)⟩ ∂g`,
//!
//! with the sum on the right over the samples pressed at `x`, and `p̂` the pressure predicted by the last step: the
//! pressure at its start less `k ∂g·δ` where a sample was pressed, none elsewhere (a semi-smooth Newton method;
//! Hintermüller, Ito and Kunisch 2002, doi 10.1137/S1052623401383558). The equilibrium is the same.
//!
//! A sample whose pressure is predicted stays among the pressed ones if the step ends a little too far out, with a
//! force `λ − k (g − δ)` that pulls until the next step has brought it back: the gap is not linear in the moves, and the
//! penalty `k` would turn an error of it that is small beside the step into an open contact, and the next step into a
//! deep one, for ever. It stays as long as the body's own stiffness `c` would not open the gap by its pressure,
//! `p̂ > c (g − δ)` (primal-dual active set), while the residual that decides on the end knows only forces that push.
//!
//! # Friction
//!
//! `μ p̂` is also the best guess of the bound of friction. An iteration that takes it over finds the bounds and the places
//! that stick together, instead of one equilibrium for each correction of multipliers. A sample that comes into contact
//! gets its anchor from the first step into the other surface, which nothing has hindered yet.
//!
//! Friction that slips has no stiffness along its slip, so that a sample which has to stick would jump from slip to slip
//! and never stop: with a body of the stiffness `K` behind it, from a slip of `u` by `bound/K` to the other side, and
//! back. So a sample begins by sticking, unbounded, and slips once its friction exceeds the bound, as an elastic
//! predictor is returned to the yield surface in plasticity; one whose slip turns back sticks again.

use voxsoft_solid::vector::{Vec3, add, axpy, dot, norm};

use super::law::Normal;
use super::state::{ContactState, SampleMemory};
use super::{ContactPair, NEARLY, PENALTY, STICK, SurfaceContact};

/// Largest gap less clearance of a sample that stays among the pressed ones by its predicted pressure, in voxels.
pub(super) const KEPT: f64 = 0.01;

impl SurfaceContact {
    /// Calls `take` with every contact pair that has forces along its normal, or is kept by its pressure (N) among those
    /// `predicted` for all samples; none are if that is empty.
    pub(super) fn each_kept(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        predicted: &[f64],
        mut take: impl FnMut(&ContactPair, Normal, &[Vec3]),
    ) {
        self.each_meeting(state, positions, |meeting, points| {
            let sample = meeting.sample as usize;
            let memory = &state.now[sample];
            let found = self.normal(memory, meeting, points);
            let pressure = predicted.get(sample).copied().unwrap_or_default();
            if let Some(normal) = found.or_else(|| self.kept(memory, meeting, pressure)) {
                take(meeting, normal, points);
            }
        });
    }

    /// Force of a sample that has none, but is kept in contact by the `pressure` (N) predicted for it.
    fn kept(&self, memory: &SampleMemory, meeting: &ContactPair, pressure: f64) -> Option<Normal> {
        let law = self.law(meeting.sample, meeting.triangle);
        let gap = self.gap_to_clearance(meeting)?;
        let near = gap <= KEPT * self.description.voxel && law.range() == 0.0;
        let penalty = self.penalty(meeting.sample);
        let force = memory.normal - penalty * gap;
        (near && pressure > -force / PENALTY).then_some(Normal {
            pressure: force,
            stiffness: penalty,
            ..Normal::default()
        })
    }

    /// Force of every sample along its normal in N, linearized, at the end of a step that `moves` (m) from `positions`,
    /// where pressures were `predicted`.
    pub(super) fn predicted_pressures(
        &self,
        positions: &[Vec3],
        predicted: &[f64],
        moves: &[Vec3],
    ) -> Vec<f64> {
        self.predicted_across(&self.state, positions, predicted, moves)
            .into_iter()
            .map(|[push, pull]| push - pull)
            .collect()
    }

    /// Forces of every sample in N that keep surfaces apart and that draw them together, linearized, at the end of a
    /// step that `moves` (m) from `positions`, where pressures were `predicted`.
    fn predicted_across(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        predicted: &[f64],
        moves: &[Vec3],
    ) -> Vec<[f64; 2]> {
        let mut forces = vec![[0.0; 2]; self.samples.len()];
        self.each_kept(state, positions, predicted, |meeting, normal, _| {
            let mut relative = [0.0; 3];
            for (factor, point) in self.relative(meeting.spot()) {
                axpy(&mut relative, factor, self.points[point as usize].at(moves));
            }
            let law = self.law(meeting.sample, meeting.triangle);
            let opening = dot(meeting.normal, relative);
            let force = law.predicted(normal, self.penalty(meeting.sample), opening);
            forces[meeting.sample as usize] = [force + normal.pull, normal.pull];
        });
        forces
    }

    /// Lets samples that stick do so whatever their bound, with the stiffest penalty.
    pub(super) fn let_stick(state: &mut ContactState) {
        state.stick = STICK[1];
        for memory in &mut state.now {
            memory.unbounded = memory.bound > 0.0 && norm(memory.friction) < NEARLY * memory.bound;
        }
    }

    /// Multipliers and anchors that a step of `moves` (m) from `positions`, where pressures were `predicted`, predicts,
    /// and the pressures at its end. Friction keeps its multiplier, from which its slip is measured.
    pub(super) fn predicted_multipliers(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        predicted: &[f64],
        moves: &[Vec3],
    ) -> (Vec<SampleMemory>, Vec<f64>) {
        let pairs = positions.iter().zip(moves);
        let moved: Vec<Vec3> = pairs.map(|(x, m)| add(*x, *m)).collect();
        let [start, end] = [positions, &moved].map(|positions| self.points_at(positions));
        let mut now: Vec<SampleMemory> = state.now.iter().map(SampleMemory::anchor_only).collect();
        let forces = self.predicted_across(state, positions, predicted, moves);
        let pressures: Vec<f64> = forces.into_iter().map(|[push, _]| push).collect();
        for (sample, (&pressure, facing)) in pressures.iter().zip(&state.facing).enumerate() {
            let Some(meeting) = facing.and_then(|facing| self.meeting(sample as u32, facing, &end))
            else {
                continue;
            };
            let memory = &mut now[sample];
            let clearance = self.mobility(&meeting) * self.clearance(meeting.sample);
            if memory.anchor.is_none() && (pressure > 0.0 || meeting.gap < clearance) {
                let (anchor, along, since) = self.first_anchor(state, &meeting, &end);
                (memory.anchor, memory.along, memory.since) = (Some(anchor), along, since);
            }
            if pressure > 0.0 {
                self.predict_friction(memory, state, &meeting, pressure, [&start, &end]);
            }
        }
        (now, pressures)
    }

    /// Updates the friction of a sample, with an anchor, under a predicted pressure (N), with the points at the start and
    /// the end of the step.
    fn predict_friction(
        &self,
        memory: &mut SampleMemory,
        state: &ContactState,
        meeting: &ContactPair,
        pressure: f64,
        [start, end]: [&[Vec3]; 2],
    ) {
        let ContactPair {
            sample, triangle, ..
        } = *meeting;
        let before = &state.now[sample as usize];
        let coefficient = self.coefficient(sample, triangle);
        memory.normal = before.normal;
        memory.friction = before.friction;
        memory.plane = meeting.normal;
        memory.bound = self.law(sample, triangle).bound(coefficient, pressure);
        let found = |points: &[Vec3]| Some(self.friction(state, sample, points)?.found);
        memory.unbounded = match (found(start), found(end)) {
            (Some(first), Some(last)) => first.slips && dot(first.force, last.force) < 0.0,
            _ => memory.bound > 0.0,
        };
    }
}
