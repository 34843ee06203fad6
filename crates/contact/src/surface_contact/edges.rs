//! Edge-to-edge contact.
//!
//! If two ridges meet, no point of one is behind the other, and yet they may pass through each other. So edges are
//! samples too: each faces the edge of the other surface that it lies across, with the common perpendicular of both as
//! normal ([`super::gap::crossing`]). The two are adjacent there if the faces at each edge lie on its own side of that
//! normal; a concave edge never is.
//!
//! Edges search at equilibria alone, because a crossing comes and goes with less than a step of Newton's method. Their
//! candidates depend on the place alone, not on the accepted state, so that these are kept over slow steps.

use voxsoft_solid::vector::{Vec3, add, dot, norm, scale, sub};

use super::listing::{DEPTH, REACH};
use super::state::{ContactState, Facing};
use super::{CLEARANCE, DEEPEST, SurfaceContact};
use crate::gap::{Crossing, crossing, normal, unit};
use crate::threads;

/// Largest sine by which a face may lean over the normal of its edge: before the edge meets another one, where the
/// normal of nearly flat facets depends on their deformation, and while it presses one, so that it does not alternate
/// between two.
const LEANING: [f64; 2] = [0.01, 0.1];
/// Largest sine between faces at an edge that count as coplanar: over half of an edge, which is shorter than a voxel,
/// it amounts to less than the smallest gap that points keep.
const FLAT: f64 = 2.0 * CLEARANCE[1];
/// Largest slide of a crossing beyond the ends of an edge, in parts of the edge, before it is dropped.
const BEYOND: f64 = 0.1;

/// Ends of the side of a triangle from a corner to the next.
pub(super) fn side(corners: [Vec3; 3], corner: usize) -> [Vec3; 2] {
    [corners[corner], corners[(corner + 1) % 3]]
}

/// Affine coordinates of a place on that side.
pub(super) fn weights(corner: usize, along: f64) -> [f64; 3] {
    let mut weights = [0.0; 3];
    weights[corner] = 1.0 - along;
    weights[(corner + 1) % 3] = along;
    weights
}

impl SurfaceContact {
    /// Searches the edges that each edge crosses at an equilibrium; returns true if any force changes by it.
    pub(super) fn face_edges(&self, state: &mut ContactState, positions: &[Vec3]) -> bool {
        let points = self.points_at(positions);
        let first = self.points.len();
        let apart = |listed: &[Vec3]| self.farthest_between(listed, &points);
        if !(apart(&state.edges_listed_points) <= REACH / 2.0) {
            state.edge_candidates = self.near(state, first..self.samples.len(), &points);
            state.edges_listed_points.clone_from(&points);
        }
        let listed = &state.edge_candidates;
        let look = |edge: usize| self.look_across(state, first + edge, &listed[edge], &points);
        let found = threads::map(self.samples.len() - first, look);
        let mut changes = false;
        for (edge, facing) in found.into_iter().enumerate() {
            let sample = first + edge;
            let before = std::mem::replace(&mut state.facing[sample], facing);
            changes |= before != facing
                && (self.is_pressed(state, sample, before, &points)
                    || self.is_deep(sample, facing, &points));
        }
        changes
    }

    /// Edge faced during Newton iterations: the previous one, or `None` once the crossing has left it.
    pub(super) fn keep_across(
        &self,
        state: &ContactState,
        index: usize,
        points: &[Vec3],
    ) -> Option<Facing> {
        let facing = state.facing[index]?;
        let Facing::Across(triangle, corner, _) = facing else {
            return None;
        };
        let own = self.ends(index as u32, points);
        let other = side(self.corners(triangle, points), corner);
        let along = crossing(own, other)?.along;
        let meets = along
            .iter()
            .all(|part| (-BEYOND..=1.0 + BEYOND).contains(part));
        meets.then_some(facing)
    }

    fn is_pressed(
        &self,
        state: &ContactState,
        sample: usize,
        facing: Option<Facing>,
        points: &[Vec3],
    ) -> bool {
        let meeting = facing.and_then(|facing| self.meeting(sample as u32, facing, points));
        meeting
            .and_then(|meeting| self.normal(&state.now[sample], &meeting, points))
            .is_some_and(|normal| normal.pressure > 0.0)
    }

    fn is_deep(&self, sample: usize, facing: Option<Facing>, points: &[Vec3]) -> bool {
        let meeting = facing.and_then(|facing| self.meeting(sample as u32, facing, points));
        let clearance = self.clearance(sample as u32);
        meeting.is_some_and(|meeting| {
            let least = self.mobility(&meeting) * clearance - DEEPEST * self.description.voxel;
            meeting.gap < least
        })
    }

    /// Candidate edge that an edge lies across, the one with the deepest crossing; an edge that is pressed is kept.
    fn look_across(
        &self,
        state: &ContactState,
        index: usize,
        candidates: &[u32],
        points: &[Vec3],
    ) -> Option<Facing> {
        let before = state.facing[index];
        if self.is_pressed(state, index, before, points)
            && let Some(Facing::Across(triangle, corner, _)) = before
            && let Some((_, kept)) = self.across(state, index, (triangle, corner), true, points)
        {
            return Some(kept);
        }
        if candidates.is_empty() || self.is_flat(self.samples[index].ends, points) {
            return None;
        }
        let mut best: Option<(f64, Facing)> = None;
        for &triangle in candidates {
            for corner in 0..3 {
                let found = self.across(state, index, (triangle, corner), false, points);
                if let Some((gap, facing)) = found
                    && best.is_none_or(|(least, _)| gap < least)
                {
                    best = Some((gap, facing));
                }
            }
        }
        best.map(|(_, facing)| facing)
    }

    /// Facing of a sample edge and a side of a triangle, and their depth, if they are adjacent; with wider tolerances
    /// if it already `presses` it.
    fn across(
        &self,
        state: &ContactState,
        index: usize,
        (triangle, corner): (u32, usize),
        presses: bool,
        points: &[Vec3],
    ) -> Option<(f64, Facing)> {
        let ends = self.samples[index].ends;
        let corners = self.triangles[triangle as usize];
        let other = [corners[corner], corners[(corner + 1) % 3]];
        let at = |points: &[Vec3]| {
            let place = |point: u32| points[point as usize];
            crossing(ends.map(place), other.map(place))
        };
        let Crossing {
            along, normal, gap, ..
        } = at(points)?;
        let beyond = if presses { BEYOND } else { 0.0 };
        if !along
            .iter()
            .all(|part| (-beyond..=1.0 + beyond).contains(part))
        {
            return None;
        }
        // Direction from the other edge to this one, from the normals of their faces.
        let looks = sub(
            self.edge_normal(other, points),
            self.edge_normal(ends, points),
        );
        let same = dot(normal, looks) > 0.0;
        let sign = if same { 1.0 } else { -1.0 };
        let depth = -sign * gap;
        // A crossing deeper than the distance to the ends of an edge is handled by its points.
        let voxel = self.description.voxel;
        let length = |[a, b]: [u32; 2]| norm(sub(points[a as usize], points[b as usize]));
        let to_end = |part: f64, ends: [u32; 2]| (beyond + part.min(1.0 - part)) * length(ends);
        let deepest = to_end(along[0], ends).min(to_end(along[1], other));
        if depth > deepest.min(DEPTH * voxel) || -depth > REACH * voxel {
            return None;
        }
        let leans = |edge: [u32; 2], away: Vec3| {
            self.faces_at(edge).any(|face| {
                dot(self.inwards(face, edge, points), away) < -LEANING[usize::from(presses)]
            })
        };
        if leans(ends, scale(sign, normal)) || leans(other, scale(-sign, normal)) {
            return None;
        }
        if self.is_flat(ends, points) || self.is_flat(other, points) {
            return None;
        }
        let own = self.samples[index].surface == self.surface_of[triangle as usize];
        let allowed = if own {
            self.depth_of_edge(ends, triangle)?
        } else {
            DEPTH
        };
        let depth_before = -sign * at(&state.accepted_points)?.gap;
        (depth_before <= allowed * voxel)
            .then_some((-depth, Facing::Across(triangle, corner, same)))
    }

    /// Triangles at an edge.
    fn faces_at(&self, [from, to]: [u32; 2]) -> impl Iterator<Item = u32> {
        let around = self.around[from as usize].iter().copied();
        around.filter(move |t| self.triangles[*t as usize].contains(&to))
    }

    /// Tests whether an edge lies within a plane, where its points suffice.
    fn is_flat(&self, edge: [u32; 2], points: &[Vec3]) -> bool {
        let mut faces = self.faces_at(edge);
        let (Some(first), Some(second)) = (faces.next(), faces.next()) else {
            return false;
        };
        let outward = normal(self.corners(first, points));
        dot(self.inwards(second, edge, points), outward).abs() < FLAT
    }

    /// Sum of the normals at an edge.
    fn edge_normal(&self, edge: [u32; 2], points: &[Vec3]) -> Vec3 {
        let normals = self.faces_at(edge).map(|t| normal(self.corners(t, points)));
        normals.fold([0.0; 3], add)
    }

    /// Direction into a triangle from its edge, in its plane and at right angles to the edge.
    fn inwards(&self, triangle: u32, edge: [u32; 2], points: &[Vec3]) -> Vec3 {
        let third = self.triangles[triangle as usize]
            .iter()
            .find(|p| !edge.contains(p));
        let [from, to] = edge.map(|p| points[p as usize]);
        let toward = third.map_or([0.0; 3], |p| sub(points[*p as usize], from));
        let along = unit(sub(to, from));
        unit(sub(toward, scale(dot(toward, along), along)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Carried, Surface};
    use crate::surface_contact::Description;
    use voxsoft_solid::conformance::check_term;
    use voxsoft_solid::{Contact, Precision};

    /// Two tetrahedra, the upper edge of the first along x across the lower one of the second along y, `apart` from it.
    fn crossed(apart: f64) -> Vec<Vec3> {
        let lower = [
            [-1.0, 0.1, 0.0],
            [1.0, -0.05, 0.0],
            [0.1, 1.0, -1.0],
            [0.0, -1.0, -1.1],
        ];
        let upper = [
            [0.0, -1.0, 0.0],
            [0.2, 1.0, 0.0],
            [1.0, 0.1, 1.0],
            [-1.1, 0.0, 1.2],
        ];
        let lift = |[x, y, z]: Vec3| [x, y, z + apart];
        lower.into_iter().chain(upper.map(lift)).collect()
    }

    fn contact(friction: f64, positions: &[Vec3]) -> SurfaceContact {
        // Orientation outward, by the sign of the volume of four points.
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let surface = |first: u32, flip: bool| Surface {
            points: (first..first + 4).map(Carried::vertex).collect(),
            triangles: faces
                .iter()
                .map(|&[a, b, c]| if flip { [a, c, b] } else { [a, b, c] })
                .collect(),
        };
        let volume = |p: &[Vec3]| {
            let [a, b, c] = [1, 2, 3].map(|i| sub(p[i], p[0]));
            dot(a, voxsoft_solid::vector::cross(b, c))
        };
        let surfaces = vec![
            surface(0, volume(&positions[..4]) < 0.0),
            surface(4, volume(&positions[4..]) < 0.0),
        ];
        let description = Description {
            bonds: Vec::new(),
            surfaces,
            friction: vec![vec![f64::NAN, friction], vec![friction, f64::NAN]],
            voxel: 1.0,
            young: 2.0,
        };
        SurfaceContact::new(description, positions).unwrap()
    }

    #[test]
    fn crossed_edges_press_each_other() {
        let (apart, positions) = (crossed(0.01), crossed(-0.01));
        let mut contact = contact(0.0, &apart);
        contact.follow(&positions);
        assert!(contact.pairs(&positions).is_empty());
        assert!(!contact.correct(&positions, 0.0, Precision::DEFAULT));
        let pairs = contact.pairs(&positions);
        assert_eq!(pairs.len(), 1);
        assert!((pairs[0].gap + 0.01).abs() < 1e-12, "{pairs:?}");
        // Force on the first surface, which is the lower one.
        assert!(pairs[0].force[2] < 0.0, "{pairs:?}");
        assert!(contact.pairs(&apart).is_empty());
    }

    #[test]
    fn edges_keep_the_laws_of_terms() {
        // Penetrated by less than the pressure that the exact tangent accepts.
        let (apart, positions) = (crossed(0.05), crossed(-0.0004));
        let mut contact = contact(0.0, &crossed(0.0));
        contact.follow(&positions);
        for _ in 0..2 {
            assert!(!contact.correct(&positions, 0.0, Precision::DEFAULT));
            contact.follow(&positions);
            assert_eq!(contact.pairs(&positions).len(), 1);
            check_term(&contact, &apart, &positions).unwrap();
        }
    }

    #[test]
    fn edges_stick_up_to_the_bound_of_friction() {
        let positions = crossed(-0.0004);
        let mut contact = contact(0.4, &crossed(0.0));
        contact.follow(&positions);
        for _ in 0..2 {
            contact.correct(&positions, 0.0, Precision::DEFAULT);
        }
        let slip = |by: f64| {
            let mut moved = positions.clone();
            for x in &mut moved[4..] {
                x[0] += by;
            }
            contact.pairs(&moved)[0].clone()
        };
        let held = slip(0.0);
        assert!(held.pressure > 0.0 && norm(held.friction) < 1e-9 * held.pressure);
        // Friction carries the first surface along.
        let slipping = slip(0.05);
        let bound: f64 = contact.state.now.iter().map(|memory| memory.bound).sum();
        assert!(bound > 0.0 && (norm(slipping.friction) / bound - 1.0).abs() < 1e-9);
        assert!(slipping.friction[0] > 0.99 * norm(slipping.friction));
        assert!(slipping.slipping == 1.0 && held.slipping == 0.0);
    }

    #[test]
    fn an_edge_does_not_face_edges_behind_it() {
        let positions = crossed(-1.0);
        let mut contact = contact(0.0, &positions);
        contact.correct(&positions, 0.0, Precision::DEFAULT);
        let state = &contact.state;
        let across = |facing: &&Option<Facing>| matches!(facing, Some(Facing::Across(..)));
        assert_eq!(state.facing.iter().filter(across).count(), 0);
    }
}
