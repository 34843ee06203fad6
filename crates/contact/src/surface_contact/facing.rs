//! Contact search: the triangle or edge that a sample faces.

use voxsoft_solid::vector::{Vec3, axpy, dot, norm, scale, sub};

use super::SurfaceContact;
use super::listing;
use super::state::{ContactState, Facing};
use crate::gap::{Closest, closest, normal, unit};

/// Tolerance beside an edge within which a sample counts as flush with it, in voxels.
const FLUSH: f64 = 1e-6;
/// Distance beyond the edge of a triangle within which a sample still counts as in front of it, in voxels.
///
/// Around an edge normals turn within the clearance, and by as much as friction lets samples creep: two rims that lie
/// on each other would push each other aside.
const RIM: f64 = 1e-3;
/// Margin, as a cosine, by which a surface has to look more toward another triangle for a sample to leave the one that
/// it faces.
const STAYS: f64 = 0.1;

impl SurfaceContact {
    /// Facing of a sample at `point`, among its candidates.
    pub(super) fn look(
        &self,
        state: &ContactState,
        index: usize,
        point: Vec3,
        points: &[Vec3],
    ) -> Option<Facing> {
        let mut best: Option<(u32, Closest)> = None;
        for &triangle in &state.candidates[index] {
            let found = closest(point, self.corners(triangle, points));
            if best.is_none_or(|(_, other)| found.distance < other.distance) {
                best = Some((triangle, found));
            }
        }
        let (triangle, found) = best?;
        if found.is_inside() {
            return Some(Facing::Plane(triangle));
        }
        if let Some((beside, nearer)) = self.nearer_beside(triangle, found, point, points) {
            let height = dot(nearer.away, normal(self.corners(beside, points)));
            if height.abs() > FLUSH * self.description.voxel {
                // The sample has moved around the edge; it meets the triangle behind it if it was in front of that.
                let met = nearer.is_inside() && self.was_in_front(state, index, beside);
                return met.then_some(Facing::Plane(beside));
            }
        }
        if let Some(plane) = self.over_rim(state, index, triangle, found, point, points) {
            return Some(Facing::Plane(plane));
        }
        let outward = self.normal_beside(triangle, found.weights, points);
        let normal = if found.distance <= 1e-9 * self.description.voxel {
            outward
        } else {
            let behind =
                dot(found.away, outward) < 0.0 && self.went_through(state, index, triangle, &found);
            let sign = if behind { -1.0 } else { 1.0 };
            scale(sign / found.distance, found.away)
        };
        Some(Facing::Edge(triangle, found.weights, normal))
    }

    /// Triangle at an edge or corner in front of which a point lies that is beyond it by less than the tolerance: the
    /// one toward which its own surface looks most, or the one that it already faces if two are alike.
    fn over_rim(
        &self,
        state: &ContactState,
        index: usize,
        triangle: u32,
        found: Closest,
        point: Vec3,
        points: &[Vec3],
    ) -> Option<u32> {
        let of = |t: u32| normal(self.corners(t, points));
        let looks = self.normal_at_point(index as u32, points, of);
        let mut best: Option<(u32, f64)> = None;
        for other in self.triangles_at(triangle, found) {
            let away = closest(point, self.corners(other, points)).away;
            let outward = normal(self.corners(other, points));
            let height = dot(away, outward);
            let beyond = norm(sub(away, scale(height, outward)));
            let toward = dot(looks, outward);
            if toward >= 0.0 || height <= 0.0 || beyond > RIM * self.description.voxel {
                continue;
            }
            let faced = state.facing[index] == Some(Facing::Plane(other));
            let toward = if faced { toward - STAYS } else { toward };
            if best.is_none_or(|(_, least)| toward < least) {
                best = Some((other, toward));
            }
        }
        best.map(|(plane, _)| plane)
    }

    /// Triangles at the corners on which the closest point of a triangle depends.
    fn triangles_at(&self, triangle: u32, found: Closest) -> impl Iterator<Item = u32> {
        let corners = self.triangles[triangle as usize];
        let on = (0..3).filter(move |c| found.weights[*c] > 0.0);
        on.flat_map(move |c| self.around[corners[c] as usize].iter().copied())
    }

    /// Tests whether a sample that appears to be behind an edge or a corner has passed through it since the accepted
    /// state.
    ///
    /// Inside of the body only a concave edge is the closest point of its faces. Between the faces of a concave edge of
    /// the opening angle θ the sample was at most θ/2 from its normal, and behind it is at most (π − θ)/2 from the
    /// opposite direction: so it has turned around the edge by a right angle or more. A sample that has turned by less
    /// only lies beside an edge whose normal has turned.
    fn went_through(
        &self,
        state: &ContactState,
        index: usize,
        triangle: u32,
        found: &Closest,
    ) -> bool {
        let points = &state.accepted_points;
        let mut before = points[index];
        for (weight, corner) in found.weights.iter().zip(self.corners(triangle, points)) {
            axpy(&mut before, -weight, corner);
        }
        let was_behind = || {
            let outward = self.normal_beside(triangle, found.weights, points);
            dot(before, outward) < 0.0 && norm(before) <= listing::DEPTH * self.description.voxel
        };
        dot(found.away, before) <= 0.0 || was_behind()
    }

    /// Triangle at the edge or corner of another that is closer to a point than that one.
    fn nearer_beside(
        &self,
        triangle: u32,
        found: Closest,
        point: Vec3,
        points: &[Vec3],
    ) -> Option<(u32, Closest)> {
        let least = found.distance - 1e-9 * self.description.voxel;
        let mut best: Option<(u32, Closest)> = None;
        for other in self.triangles_at(triangle, found) {
            let beside = closest(point, self.corners(other, points));
            if beside.distance < best.map_or(least, |(_, best)| best.distance) {
                best = Some((other, beside));
            }
        }
        best
    }

    /// Tests whether a point is in front of a triangle, or no deeper behind it than a `depth` in voxels.
    ///
    /// Beside the triangle the surface at its edge decides: the plane of a wall continues into the body where that wall
    /// ends in a corner, and points along it there are inside.
    pub(super) fn is_in_front(
        &self,
        triangle: u32,
        point: Vec3,
        points: &[Vec3],
        depth: f64,
    ) -> bool {
        let found = closest(point, self.corners(triangle, points));
        let outward = || self.normal_beside(triangle, found.weights, points);
        self.counts_as_in_front(&found, depth, outward)
    }

    /// Tests for a point with this closest point of a triangle whether it is in front of it, or no deeper behind it
    /// than a `depth` in voxels; `outward` is the normal there.
    pub(super) fn counts_as_in_front(
        &self,
        found: &Closest,
        depth: f64,
        outward: impl Fn() -> Vec3,
    ) -> bool {
        found.distance <= depth * self.description.voxel || dot(found.away, outward()) >= 0.0
    }

    /// Mean normal at a point of a triangle, on an edge or corner of all triangles that meet there (angle-weighted
    /// pseudonormal), which distinguishes outside from inside (Baerentzen and Aanaes 2005, doi 10.1109/TVCG.2005.49).
    pub(super) fn normal_beside(&self, triangle: u32, weights: [f64; 3], points: &[Vec3]) -> Vec3 {
        let of = |t: u32| normal(self.corners(t, points));
        match self.corners_on(triangle, weights) {
            [Some(point), None, None] => self.normal_at_point(point, points, of),
            on => self.normal_on(on, of),
        }
    }

    /// Corners of a triangle on which a point with these coordinates depends: none for NaN.
    pub(super) fn corners_on(&self, triangle: u32, weights: [f64; 3]) -> [Option<u32>; 3] {
        let corners = self.triangles[triangle as usize];
        let mut on = [None; 3];
        let positive = (0..3).filter(|c| weights[*c] > 0.0);
        for (place, c) in on.iter_mut().zip(positive) {
            *place = Some(corners[c]);
        }
        on
    }

    /// Mean normal of the triangles with the normals `of` that have all of two or three points.
    pub(super) fn normal_on(&self, on: [Option<u32>; 3], of: impl Fn(u32) -> Vec3) -> Vec3 {
        let mut sum = [0.0; 3];
        let Some(first) = on[0] else {
            return sum;
        };
        for &other in &self.around[first as usize] {
            let of_other = self.triangles[other as usize];
            if on.iter().flatten().all(|point| of_other.contains(point)) {
                axpy(&mut sum, 1.0, of(other));
            }
        }
        unit(sum)
    }

    /// Mean normal at a point, weighted by the angles of the triangles with the normals `of` there.
    pub(super) fn normal_at_point(
        &self,
        point: u32,
        points: &[Vec3],
        of: impl Fn(u32) -> Vec3,
    ) -> Vec3 {
        let mut sum = [0.0; 3];
        for &other in &self.around[point as usize] {
            let of_other = self.triangles[other as usize];
            let place = of_other.iter().position(|p| *p == point).unwrap_or(0);
            let at = |step: usize| points[of_other[(place + step) % 3] as usize];
            let (u, v) = (unit(sub(at(1), at(0))), unit(sub(at(2), at(0))));
            axpy(&mut sum, dot(u, v).clamp(-1.0, 1.0).acos(), of(other));
        }
        unit(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Carried, Surface};
    use crate::surface_contact::{Description, listing};
    use voxsoft_solid::vector::add;

    /// Prism of height 1 over an L of lengths 2 and width 1, its concave edge at (1, 1).
    fn angle() -> (SurfaceContact, Vec<Vec3>) {
        let outline = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        let at = |z: f64| outline.map(|[x, y]| [x, y, z]);
        let positions = [at(0.0), at(1.0)].concat();
        let mut triangles = Vec::new();
        for i in 0..6u32 {
            let j = (i + 1) % 6;
            triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
        }
        for [a, b, c] in [[3, 4, 5], [3, 5, 0], [3, 0, 1], [3, 1, 2]] {
            triangles.extend([[a, c, b], [a + 6, b + 6, c + 6]]);
        }
        let surface = Surface {
            points: (0..12).map(Carried::vertex).collect(),
            triangles,
        };
        let description = Description {
            bonds: Vec::new(),
            surfaces: vec![surface],
            friction: vec![vec![0.0]],
            voxel: 1.0,
            young: 1.0,
        };
        (
            SurfaceContact::new(description, &positions).unwrap(),
            positions,
        )
    }

    #[test]
    fn points_in_front_of_a_wall_with_an_inner_edge() {
        let (contact, positions) = angle();
        let front = |triangle: u32, point: Vec3| {
            contact.is_in_front(triangle, point, &positions, listing::DEPTH)
        };
        // The wall y = 1, which ends at the concave edge, where its plane continues into the body.
        let wall = 4;
        assert_eq!(contact.triangles[wall as usize], [2, 3, 9]);
        assert!(!front(wall, [0.5, 0.99, 0.5]));
        assert!(front(wall, [1.2, 1.5, 0.5]));
        // Points not too deep behind it, at its edge too.
        assert!(front(wall, [0.9, 0.99, 0.5]));
        assert!(front(wall, [1.2, 0.8, 0.5]));
        assert!(!front(wall, [1.2, 0.7, 0.5]));
        // A point beyond a convex edge, along the wall and a little below its plane.
        assert!(front(wall, [3.0, 0.7, 0.5]));
    }

    #[test]
    fn sample_beside_an_inner_edge_has_not_passed_through() {
        let (contact, positions) = angle();
        let mut state = contact.state.clone();
        state.accepted_points = contact.points_at(&positions);
        // The concave edge joins the points 3 and 9, at (1, 1); its normal is along x + y.
        let (triangle, weights) = (4, [0.0, 0.5, 0.5]);
        let mut through = |before: Vec3, away: Vec3| {
            state.accepted_points[0] = add([1.0, 1.0, 0.5], before);
            let distance = norm(away);
            let found = Closest {
                weights,
                away,
                distance,
            };
            contact.went_through(&state, 0, triangle, &found)
        };
        assert!(through([0.3, 0.2, 0.0], [-0.1, -0.1, 0.0]));
        // Rotated with the body by a little, at right angles to the normal.
        assert!(!through([0.5, -0.5, 0.0], [0.5, -0.51, 0.0]));
        // Slightly behind it already, within the depth allowed at rest.
        assert!(through([-0.1, -0.1, 0.0], [-0.1, -0.11, 0.0]));
    }
}
