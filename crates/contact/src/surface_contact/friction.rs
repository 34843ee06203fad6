//! Coulomb friction with the multipliers, bounds and anchors of samples.

use voxsoft_solid::vector::{Vec3, axpy, dot, norm, scale, sub};

use super::law::{Along, Law, Tangential};
use super::state::{ContactState, SampleMemory};
use super::{Spot, SurfaceContact};
use crate::gap::unit;

/// Friction on one sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Friction {
    /// Force, stiffness and energy by the contact law.
    pub found: Tangential,
    pub anchor: (u32, [f64; 3]),
    /// Place on an edge where it acts, as a part of the way between its ends.
    pub along: f64,
}

impl SurfaceContact {
    /// Friction of a sample that was in contact at the last correction and had an anchor: also if it has lost contact
    /// since, or its force would jump.
    pub(super) fn friction(
        &self,
        state: &ContactState,
        sample: u32,
        points: &[Vec3],
    ) -> Option<Friction> {
        let memory = &state.now[sample as usize];
        let point = self.place(sample, memory.along, points);
        let k = state.stick * self.penalty(sample);
        let free = self.free_ways(sample, point, points);
        Friction::new(
            memory,
            k,
            point,
            free,
            |triangle| self.law(sample, triangle),
            |triangle| self.corners(triangle, points),
        )
    }
}

impl Friction {
    /// Place where the force acts.
    pub(super) fn spot(&self, sample: u32) -> Spot {
        Spot {
            sample,
            along: self.along,
            triangle: self.anchor.0,
            weights: self.anchor.1,
        }
    }

    /// Friction of a sample at `point` with a slip penalty `k` (N/m), which moves along the axes that are `free`, by
    /// the law and at the corners of the triangle of its anchor; `None` without a bound or an anchor.
    pub(super) fn new<'a>(
        memory: &SampleMemory,
        k: f64,
        point: Vec3,
        free: [bool; 3],
        law_of: impl FnOnce(u32) -> &'a dyn Law,
        corners_of: impl FnOnce(u32) -> [Vec3; 3],
    ) -> Option<Self> {
        let anchor = memory.anchor.filter(|_| memory.bound > 0.0)?;
        let kept = |v: Vec3| [0, 1, 2].map(|axis| if free[axis] { v[axis] } else { 0.0 });
        let n = if free == [true; 3] {
            memory.plane
        } else {
            unit(kept(memory.plane))
        };
        let along = |v: Vec3| {
            let v = kept(v);
            sub(v, scale(dot(v, n), n))
        };
        let mut slip = point;
        for (weight, corner) in anchor.1.iter().zip(corners_of(anchor.0)) {
            axpy(&mut slip, -weight, corner);
        }
        let bound = if memory.unbounded {
            f64::INFINITY
        } else {
            memory.bound
        };
        let found = law_of(anchor.0).tangential(Along {
            multiplier: along(memory.friction),
            penalty: k,
            slip: along(slip),
            normal: n,
            free,
            bound,
        });
        Some(Self {
            found,
            anchor,
            along: memory.along,
        })
    }
}

impl SurfaceContact {
    /// Calls `take` with the friction of every sample that has some.
    pub(super) fn each_friction(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        mut take: impl FnMut(u32, Friction),
    ) {
        if !state.now.iter().any(|memory| memory.bound > 0.0) {
            return;
        }
        let points = self.points_at(positions);
        for sample in 0..self.samples.len() as u32 {
            if let Some(friction) = self.friction(state, sample, &points) {
                take(sample, friction);
            }
        }
    }

    /// Friction on each vertex in N: samples share it in many ways, between which multipliers may change without motion.
    pub(super) fn friction_on_vertices(
        &self,
        state: &ContactState,
        positions: &[Vec3],
    ) -> Vec<Vec3> {
        let mut forces = vec![[0.0; 3]; positions.len()];
        self.each_friction(state, positions, |sample, friction| {
            self.add_force(friction.found.force, friction.spot(sample), &mut forces);
        });
        forces
    }

    /// Tests whether a surface presses on itself with friction: both sides of a fold that closes slip on each other, and no line
    /// through two states tells how.
    pub(super) fn rubs_itself(&self) -> bool {
        let mut memories = self.samples.iter().zip(&self.state.now);
        memories.any(|(sample, memory)| {
            let own = |triangle: u32| self.surface_of[triangle as usize] == sample.surface;
            memory.bound > 0.0 && memory.anchor.is_some_and(|(triangle, _)| own(triangle))
        })
    }

    /// See [`voxsoft_solid::Contact::deviation`].
    pub(super) fn deviation_of_friction(&self, positions: &[Vec3], ratio: f64) -> Option<f64> {
        let mut bonds = self.description.bonds.iter();
        if bonds.any(|bond| bond.strength.is_finite()) || self.rubs_itself() {
            return None;
        }
        let rubs = self.friction_on_vertices(&self.state, positions);
        let [last, before] = &self.state.accepted_friction;
        let mut deviation = 0.0;
        for (vertex, force) in rubs.iter().enumerate() {
            let at = |forces: &[Vec3]| forces.get(vertex).copied().unwrap_or_default();
            let (last, before) = (at(last), at(before));
            let mut off = sub(*force, last);
            axpy(&mut off, -ratio, sub(last, before));
            deviation += norm(off);
        }
        let size = |forces: &[Vec3]| -> f64 { forces.iter().map(|force| norm(*force)).sum() };
        let rubbed = size(last);
        if rubbed == 0.0 && size(&rubs) > 0.0 {
            return None;
        }
        let bound: f64 = self.state.now.iter().map(|memory| memory.bound).sum();
        Some(if bound > 0.0 { deviation / bound } else { 0.0 })
    }
}
