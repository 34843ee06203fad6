//! Coulomb friction with the multipliers, bounds and anchors of samples.

use voxsoft_solid::matrix::Mat3;
use voxsoft_solid::vector::{Vec3, axpy, dot, norm, scale, sub};

use super::gap::unit;
use super::state::{Memory, State};
use super::{Spot, Touch};

/// Friction on one sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Friction {
    /// Force, N.
    pub force: Vec3,
    /// Tangent stiffness: minus the derivative of the force with respect to the slip, N/m.
    pub stiffness: Mat3,
    /// Energy, J.
    pub energy: f64,
    pub anchor: (u32, [f64; 3]),
    /// Place on an edge where it acts, as a part of the way between its ends.
    pub along: f64,
    pub slips: bool,
}

impl Touch {
    /// Friction of a sample that was in contact at the last correction and had an anchor: also if it has lost contact
    /// since, or its force would jump.
    pub(super) fn friction(&self, state: &State, sample: u32, points: &[Vec3]) -> Option<Friction> {
        let memory = &state.now[sample as usize];
        let point = self.place(sample, memory.along, points);
        let k = state.stick * self.penalty(sample);
        let free = self.free_ways(sample, point, points);
        Friction::new(memory, k, point, free, |triangle| {
            self.corners(triangle, points)
        })
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

    /// Return mapping of a sample at `point` with a slip penalty `k` (N/m), which moves along the axes that are `free`;
    /// `None` without a bound or an anchor.
    pub(super) fn new(
        memory: &Memory,
        k: f64,
        point: Vec3,
        free: [bool; 3],
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
        let trial = sub(along(memory.friction), scale(k, along(slip)));
        let size = norm(trial);
        let slips = size > memory.bound;
        let (force, energy) = if slips {
            let energy = memory.bound * (size - memory.bound / 2.0) / k;
            (scale(memory.bound / size, trial), energy)
        } else {
            (trial, size * size / (2.0 * k))
        };
        let stiffness = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let plane = if i == j && free[i] { 1.0 } else { 0.0 } - n[i] * n[j];
                if slips {
                    let across = plane - trial[i] * trial[j] / (size * size);
                    k * memory.bound / size * across
                } else {
                    k * plane
                }
            })
        });
        Some(Self {
            force,
            stiffness,
            energy,
            anchor,
            along: memory.along,
            slips,
        })
    }
}

impl Touch {
    /// Calls `take` with the friction of every sample that has some.
    pub(super) fn each_friction(
        &self,
        state: &State,
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
}
