//! Coulomb friction with the multipliers, bounds and anchors of samples.

use std::collections::{BTreeMap, BTreeSet};

use voxsoft_solid::vector::{Vec3, axpy, dot, norm, scale, sub};

use super::law::{Along, Law, Tangential};
use super::state::{ContactState, SampleMemory};
use super::{BOUND, Spot, SurfaceContact};
use crate::gap::{normal, unit};
use crate::surface::Carried;

/// Height over the plane of a face, in voxels, up to which the next face counts as in it.
const FLAT: f64 = 1e-6;

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
        let anchor = memory.anchor.filter(|_| memory.rubs())?;
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
            slips: memory.regime.and_then(|regime| regime.slips),
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
        if !state.now.iter().any(SampleMemory::rubs) {
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

    /// Largest change of the friction bounds relative to its tolerance: on vertices, with the tolerance `off_vertex`,
    /// and summed over each pair of surfaces.
    ///
    /// Surfaces that do not fit can distribute a pressure among their samples in many ways, between which multipliers
    /// converge slowly without any motion: there are more samples than vertices that carry them. So bounds of single
    /// samples do not count.
    pub(super) fn off_bounds(
        &self,
        old: &[SampleMemory],
        new: &[SampleMemory],
        off_vertex: f64,
        negligible: f64,
    ) -> f64 {
        let mut pairs: BTreeMap<[u32; 2], [f64; 2]> = BTreeMap::new();
        let mut vertices: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        for (index, (old, new)) in old.iter().zip(new).enumerate() {
            let Some((triangle, weights)) = new.anchor else {
                continue;
            };
            let change = new.bound - old.bound;
            let mut pair = [
                self.samples[index].surface,
                self.surface_of[triangle as usize],
            ];
            pair.sort_unstable();
            let entry = pairs.entry(pair).or_default();
            entry[0] += change;
            entry[1] += new.bound;
            let spot = Spot {
                sample: index as u32,
                along: new.along,
                triangle,
                weights,
            };
            for (factor, point) in self.relative(spot) {
                let is_own = self.samples[index].ends.contains(&point);
                let part = if is_own { factor } else { -factor };
                let Carried {
                    vertices: carriers,
                    weights,
                } = self.share(point);
                for (vertex, weight) in carriers.iter().zip(weights) {
                    let entry = vertices.entry(*vertex).or_default();
                    entry[0] += part * weight * change;
                    entry[1] += part * weight * new.bound;
                }
            }
        }
        let largest = vertices
            .values()
            .map(|[_, size]| *size)
            .fold(negligible, f64::max);
        let of_vertices = vertices
            .values()
            .map(|[change, _]| change.abs() / (off_vertex * largest));
        let of_pairs = pairs
            .values()
            .map(|[change, size]| change.abs() / (BOUND[0] * size.max(negligible)));
        // A ratio 0/0 without any bound counts as zero.
        of_vertices.chain(of_pairs).fold(0.0, f64::max)
    }

    /// Tests whether a surface may rub itself: both sides of a fold that closes slip on each other, and neither the place
    /// where they met first nor a line through two states tells how. A convex surface never does.
    pub(super) fn may_rub_itself(&self) -> bool {
        let friction = &self.description.friction;
        let surfaces = self.description.surfaces.iter().enumerate();
        surfaces
            .filter(|(number, _)| friction[*number][*number] > 0.0)
            .any(|(number, _)| !self.is_convex(number as u32))
    }

    /// Tests whether a surface is convex in the unloaded design: one closed component (of Euler's characteristic 2)
    /// without an edge whose faces look at each other.
    fn is_convex(&self, surface: u32) -> bool {
        let own = |(_, of): &(usize, &u32)| **of == surface;
        let triangles = self.surface_of.iter().enumerate().filter(own);
        let mut opposite: BTreeMap<[u32; 2], Vec<(usize, u32)>> = BTreeMap::new();
        let (mut points, mut faces) = (BTreeSet::new(), 0);
        for (triangle, _) in triangles {
            faces += 1;
            let corners = self.triangles[triangle];
            points.extend(corners);
            for corner in 0..3 {
                let [a, b, third] = [0, 1, 2].map(|step| corners[(corner + step) % 3]);
                let beside = opposite.entry([a.min(b), a.max(b)]).or_default();
                beside.push((triangle, third));
            }
        }
        let near = FLAT * self.description.voxel;
        let convex = |beside: &Vec<(usize, u32)>| {
            beside.iter().all(|(triangle, _)| {
                let corners = self.corners(*triangle as u32, &self.rest_points);
                let outward = normal(corners);
                beside.iter().all(|(_, third)| {
                    dot(sub(self.rest_points[*third as usize], corners[0]), outward) <= near
                })
            })
        };
        points.len() + faces == opposite.len() + 2 && opposite.values().all(convex)
    }

    /// See [`voxsoft_solid::Contact::deviation`].
    pub(super) fn deviation_of_friction(&self, positions: &[Vec3], ratio: f64) -> Option<f64> {
        let mut bonds = self.description.bonds.iter();
        if bonds.any(|bond| bond.strength.is_finite()) || self.rubs_itself {
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
