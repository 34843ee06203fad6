//! Contact report of each pair of surfaces.

use std::collections::{BTreeMap, BTreeSet};

use voxsoft_solid::vector::{Vec3, add, axpy, dot, norm, scale, sub};

use super::state::ContactState;
use super::{ContactPair, NEARLY, SurfaceContact};
use crate::gap::normal;

/// Largest gap of a point between pressed ones that counts as in contact, in voxels: facets of a ball of four voxels
/// radius are a thirtieth of a voxel apart from it.
const NEAR: f64 = 0.05;

/// Contact of two surfaces, or of one with itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PairReport {
    /// The two surfaces.
    pub of: [u32; 2],
    /// Force on the first surface in N; zero for a surface with itself.
    pub force: Vec3,
    /// Sum of the magnitudes of all contact forces with friction, N: also of those that cancel.
    pub pressed: f64,
    /// Sum of all pressures alone, N.
    pub pressure: f64,
    /// Friction part of the force, N.
    pub friction: Vec3,
    /// Bound of friction: the sum of all pressures times their coefficients, N.
    pub bound: f64,
    /// Contact area in the unloaded body, m²; bonded area is part of it.
    pub area: f64,
    /// Bonded area, m².
    pub bonded: f64,
    /// Smallest gap in m.
    pub gap: f64,
    /// Fraction of the pressure under which the surfaces slip.
    pub slipping: f64,
    /// Mean place of the pressure in m; `None` where nothing presses.
    pub place: Option<Vec3>,
}

impl PairReport {
    /// Report of surfaces without contact.
    fn apart(of: [u32; 2]) -> Self {
        Self {
            of,
            force: [0.0; 3],
            pressed: 0.0,
            pressure: 0.0,
            friction: [0.0; 3],
            bound: 0.0,
            area: 0.0,
            bonded: 0.0,
            gap: f64::INFINITY,
            slipping: 0.0,
            place: None,
        }
    }
}

impl SurfaceContact {
    /// Reports of the surfaces in contact at `positions`, with the multipliers of the last correction; ascending. With
    /// planes of symmetry only the part that counts, to which the caller adds the images.
    pub fn pairs(&self, positions: &[Vec3]) -> Vec<PairReport> {
        let state = &self.state;
        let mut found: BTreeMap<[u32; 2], (PairReport, [f64; 2])> = BTreeMap::new();
        let mut pressed_samples = vec![false; self.samples.len()];
        self.each_contact(state, positions, |meeting, normal, points| {
            let pressure = normal.pressure;
            pressed_samples[meeting.sample as usize] = pressure > 0.0;
            let sample = &self.samples[meeting.sample as usize];
            let of = self.surfaces_of(meeting);
            let memory = &state.now[meeting.sample as usize];
            let friction = self.friction(state, meeting.sample, points);
            let mut force = scale(normal.force(), meeting.normal);
            let mut tangential = [0.0; 3];
            let (mut pressed, mut slipping) = (normal.force().abs(), pressure);
            if let Some(friction) = friction {
                tangential = friction.found.force;
                force = add(force, tangential);
                pressed = norm(force);
                let sticks = !friction.found.slips && norm(tangential) < NEARLY * memory.bound;
                if sticks {
                    slipping = 0.0;
                }
            }
            let entry = found.entry(of);
            let (report, areas) = entry.or_insert_with(|| (PairReport::apart(of), [0.0; 2]));
            if of[0] != of[1] {
                let sign = if sample.surface == of[0] { 1.0 } else { -1.0 };
                axpy(&mut report.force, sign, force);
                axpy(&mut report.friction, sign, tangential);
            }
            report.pressure += pressure;
            let coefficient = self.coefficient(meeting.sample, meeting.triangle);
            let law = self.law(meeting.sample, meeting.triangle);
            report.bound += law.bound(coefficient, pressure);
            report.pressed += pressed;
            if pressure > 0.0 {
                areas[self.side(meeting)] += self.area_toward(meeting, points);
            }
            report.gap = report.gap.min(meeting.gap);
            report.slipping += slipping;
            let place = report.place.get_or_insert([0.0; 3]);
            axpy(place, pressure, self.place(meeting.sample, 0.5, points));
        });
        for (point, twin) in self.twins.iter().enumerate() {
            pressed_samples[point] = pressed_samples[*twin as usize];
        }
        self.each_between(state, positions, &pressed_samples, |meeting, points| {
            if let Some((_, areas)) = found.get_mut(&self.surfaces_of(meeting)) {
                areas[self.side(meeting)] += self.area_toward(meeting, points);
            }
        });
        self.each_tie(state, positions, |bond, tie, force| {
            let mut of = bond.of;
            of.sort_unstable();
            let entry = found.entry(of);
            let (report, _) = entry.or_insert_with(|| (PairReport::apart(of), [0.0; 2]));
            let sign = if bond.of == of { 1.0 } else { -1.0 };
            axpy(&mut report.force, sign, force);
            report.pressed += norm(force);
            report.bonded += tie.area;
            report.gap = report.gap.min(0.0);
        });
        let each = found.into_values().map(|(mut report, areas)| {
            if report.pressure > 0.0 {
                report.slipping /= report.pressure;
                report.place = report.place.map(|sum| scale(1.0 / report.pressure, sum));
            } else {
                report.place = None;
            }
            // Both sides see the contact, the coarser one less sharply; a surface with itself counts twice.
            report.area = match report.of {
                [a, b] if a == b => areas[1] / 2.0,
                _ => areas[0].max(areas[1]) + report.bonded,
            };
            report
        });
        each.collect()
    }

    /// Surfaces of a contact pair, the smaller number first.
    fn surfaces_of(&self, meeting: &ContactPair) -> [u32; 2] {
        let own = self.samples[meeting.sample as usize].surface;
        let other = self.surface_of[meeting.triangle as usize];
        [own.min(other), own.max(other)]
    }

    /// Index of the surface in this pair that has the sample; for a surface with itself the second.
    fn side(&self, meeting: &ContactPair) -> usize {
        let [first, second] = self.surfaces_of(meeting);
        usize::from(self.samples[meeting.sample as usize].surface != first || first == second)
    }

    /// Area of a sample in the unloaded body, of its triangles that face the contact.
    fn area_toward(&self, meeting: &ContactPair, points: &[Vec3]) -> f64 {
        let sample = &self.samples[meeting.sample as usize];
        let area = self.weight(meeting.sample) * sample.area;
        let facing = |t: &&u32| {
            let own = normal(self.corners(**t, points));
            dot(own, meeting.normal) < -0.5
        };
        let part = sample.triangles.iter().filter(facing).count();
        area * part as f64 / sample.triangles.len() as f64
    }

    /// Calls `take` with every sample that is not pressed, near the face that it meets, and between pressed ones.
    ///
    /// Facets of surfaces that do not fit each other meet at points: the vertices of a voxel have fewer degrees of
    /// freedom than it has points, and the others keep a small gap.
    fn each_between(
        &self,
        state: &ContactState,
        positions: &[Vec3],
        pressed: &[bool],
        mut take: impl FnMut(&ContactPair, &[Vec3]),
    ) {
        let points = self.points_at(positions);
        for (index, facing) in state.facing[..points.len()].iter().enumerate() {
            let facing = facing.filter(|_| !pressed[index]);
            let meeting = facing.and_then(|facing| self.meeting(index as u32, facing, &points));
            let Some(meeting) = meeting else {
                continue;
            };
            if meeting.gap < NEAR * self.description.voxel
                && self.is_between(index as u32, pressed, &points)
            {
                take(&meeting, &points);
            }
        }
    }

    /// Tests whether pressed samples lie on opposite sides of a point, among its neighbors and theirs.
    fn is_between(&self, point: u32, pressed: &[bool], points: &[Vec3]) -> bool {
        let ring = |point: u32| {
            let triangles = self.around[point as usize].iter();
            triangles.flat_map(|t| self.triangles[*t as usize])
        };
        let near: BTreeSet<u32> = ring(point).flat_map(ring).collect();
        let near = near.into_iter().filter(|other| pressed[*other as usize]);
        let ways: Vec<Vec3> = near
            .map(|other| sub(points[other as usize], points[point as usize]))
            .collect();
        let opposite = |(i, a): (usize, &Vec3)| ways[..i].iter().any(|b| dot(*a, *b) < 0.0);
        ways.iter().enumerate().any(opposite)
    }
}
