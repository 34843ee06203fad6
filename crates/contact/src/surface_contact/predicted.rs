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

use super::state::{ContactState, SampleMemory};
use super::{ContactPair, NEARLY, STICK, SurfaceContact};

impl SurfaceContact {
    /// Force of every sample along its normal in N, linearized, at the end of a step that `moves` (m) from `positions`.
    pub(super) fn predicted_pressures(&self, positions: &[Vec3], moves: &[Vec3]) -> Vec<f64> {
        self.predicted_across(&self.state, positions, moves)
            .into_iter()
            .map(|[push, pull]| push - pull)
            .collect()
    }

    /// Forces of every sample in N that keep surfaces apart and that draw them together, linearized, at the end of a
    /// step that `moves` (m) from `positions`.
    fn predicted_across(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        moves: &[Vec3],
    ) -> Vec<[f64; 2]> {
        let mut forces = vec![[0.0; 2]; self.samples.len()];
        self.each_contact(state, positions, |meeting, normal, _| {
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

    /// Multipliers and anchors that a step of `moves` (m) from `positions` predicts. Friction keeps its multiplier, from
    /// which its slip is measured.
    pub(super) fn predicted_multipliers(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        moves: &[Vec3],
    ) -> Vec<SampleMemory> {
        let pairs = positions.iter().zip(moves);
        let moved: Vec<Vec3> = pairs.map(|(x, m)| add(*x, *m)).collect();
        let [start, end] = [positions, &moved].map(|positions| self.points_at(positions));
        let mut now: Vec<SampleMemory> = state.now.iter().map(SampleMemory::anchor_only).collect();
        let pushed = self.predicted_across(state, positions, moves);
        for (sample, ([pressure, _], facing)) in pushed.into_iter().zip(&state.facing).enumerate() {
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
        now
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
