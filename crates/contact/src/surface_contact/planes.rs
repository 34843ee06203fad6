//! Planes of symmetry: of contact pairs that are images of each other one counts.

use std::collections::BTreeMap;

use voxsoft_solid::Contact;
use voxsoft_solid::vector::Vec3;

use super::sample::Sample;
use super::{SurfaceContact, between};

/// Distance within which a place counts as in a plane of symmetry, in voxels: edges cross there up to this tolerance,
/// and their images slip toward each other by no more.
const IN_PLANE: f64 = 1e-3;
impl SurfaceContact {
    /// Declares planes of symmetry through the origin across the given axes, `rest` (m) being symmetric. Of samples
    /// that are images of each other one counts: two might stick to different places, and pull against each other for
    /// ever where nothing can give way. A sample in a plane counts in part, and does not slip across it: of the two
    /// sides of a ridge there it faces either one.
    #[must_use]
    pub fn with_planes(mut self, across: [bool; 3], rest: &[Vec3]) -> Self {
        let near = IN_PLANE * self.description.voxel;
        let weight = |sample: &Sample| {
            let ends = sample.ends.map(|p| self.rest_points[p as usize]);
            let place = between(ends, 0.5);
            let part = |axis: usize| match place[axis] {
                _ if !across[axis] => 1.0,
                x if x > near => 1.0,
                x if x >= -near => 0.5,
                _ => 0.0,
            };
            part(0) * part(1) * part(2)
        };
        self.weights = self.samples.iter().map(weight).collect();
        self.twins = self.twins_across(across);
        self.planes = across;
        Contact::reset(&mut self, rest);
        self
    }

    /// Part of a sample that counts.
    pub(super) fn weight(&self, sample: u32) -> f64 {
        *self.weights.get(sample as usize).unwrap_or(&1.0)
    }

    /// Points on the positive sides of the planes of which points are images, of the same surface if there is one.
    fn twins_across(&self, across: [bool; 3]) -> Vec<u32> {
        let near = IN_PLANE * self.description.voxel;
        let key = |point: u32| {
            let place = self.rest_points[point as usize];
            [0, 1, 2].map(|axis| {
                let steps = (place[axis] / near).round() as i64;
                if across[axis] { steps.abs() } else { steps }
            })
        };
        let count = self.points.len() as u32;
        let mut counting: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
        for point in (0..count).filter(|point| self.weight(*point) > 0.0) {
            counting.entry(key(point)).or_default().push(point);
        }
        let surface = |point: u32| self.samples[point as usize].surface;
        let twin = |point: u32| {
            if self.weight(point) > 0.0 {
                return point;
            }
            let there = counting.get(&key(point)).map_or(&[][..], Vec::as_slice);
            let same = there.iter().find(|p| surface(**p) == surface(point));
            same.or(there.first()).copied().unwrap_or(point)
        };
        (0..count).map(twin).collect()
    }

    /// Axes along which a sample may slip at a place of it. A sample that has moved to a plane meets its own image,
    /// which moves alike, and does not slip.
    pub(super) fn free_ways(&self, sample: u32, place: Vec3, points: &[Vec3]) -> [bool; 3] {
        if self.planes == [false; 3] {
            return [true; 3];
        }
        let near = IN_PLANE * self.description.voxel;
        let mut free = [true; 3];
        for axis in (0..3).filter(|axis| self.planes[*axis]) {
            let is_near = |place: &Vec3| place[axis].abs() <= near;
            free[axis] = !is_near(&place);
            let at_rest = self.place(sample, 0.5, &self.rest_points);
            if !is_near(&at_rest) && self.ends(sample, points).iter().all(is_near) {
                return [false; 3];
            }
        }
        free
    }
}
