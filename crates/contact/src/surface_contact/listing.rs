//! Broad phase of the contact search: candidate triangles of each sample.

use std::ops::Range;

use voxsoft_solid::vector::{Vec3, dot};

use super::SurfaceContact;
use super::normals::Normals;
use super::state::ContactState;
use crate::bounds::Bounds;
use crate::gap::closest;
use crate::threads;
use crate::tree::Tree;

/// Distance between a sample and a triangle within which the triangle is listed, in voxels.
pub(super) const REACH: f64 = 0.5;
/// Largest motion of points for which listed candidates are kept, in voxels: little beside [`REACH`].
pub(super) const SAME: f64 = 1e-3;
/// Largest depth of a sample in another surface at an accepted state, in voxels: less than half of the thinnest wall.
pub(super) const DEPTH: f64 = 0.25;
/// Largest product of the normals of faces that can meet: they look at each other. A sample on an edge has several
/// normals, of which those along the other face do not meet it.
const FACING: f64 = -0.1;
/// Distance of two places of one surface in the unloaded body, in voxels, within which its shape there decides if they
/// can meet. The two sides of a wall cannot, however thin it is or becomes: rubber does not press a thicker one to
/// [`DEPTH`], and a thin one does not roll up so tightly that its sides meet around its end.
const WALL: f64 = 3.0;
/// Distance, in voxels, within which places whose normals have at least the product `SAME_WAY` are one patch of the
/// surface. A fold there is a folded element.
const PATCH: f64 = 1.0;
const SAME_WAY: f64 = 0.3;
/// Largest depth of a sample in a near triangle that did not face it in the unloaded body, in voxels. A fold first has
/// to bring the two in front of each other; around a convex edge a sample is behind the other side by less than a
/// voxel.
const BESIDE: f64 = 0.01;
/// Distance behind all faces of a sample, in voxels, from which it cannot meet a triangle on its way: twice the depth at
/// which it may begin. The other sides of walls are there.
const BEHIND: f64 = 2.0 * DEPTH;

impl SurfaceContact {
    /// Lists for every point the triangles that come near it on the straight way from the last accepted state to
    /// `points`, and in front of which it was at that state.
    pub(super) fn list(&self, state: &mut ContactState, points: Vec<Vec3>) {
        state.candidates = self.near(state, 0..self.points.len(), &points);
        // The facing is kept: the forces are still those of the state for which it was found.
        state.facing.resize(self.samples.len(), None);
        state.looks = state.looks.max(1);
        state.listed_points = points;
    }

    /// Triangles that each of a range of samples may meet on the straight way from the last accepted state to `points`.
    pub(super) fn near(
        &self,
        state: &ContactState,
        samples: Range<usize>,
        points: &[Vec3],
    ) -> Vec<Vec<u32>> {
        let reach = REACH * self.description.voxel + self.laws.range();
        let behind = BEHIND * self.description.voxel;
        let swept = |triangle: &[u32; 3]| {
            let each = triangle.iter().map(|p| *p as usize);
            let ends = each.flat_map(|p| [state.accepted_points[p], points[p]]);
            grown(Bounds::of(ends), reach)
        };
        let boxes: Vec<Bounds> = self.triangles.iter().map(swept).collect();
        let accepted = &state.accepted_points;
        let normals = self.normals(accepted);
        let trees: Vec<SurfaceTree> = self
            .triangles_of_surfaces()
            .map(|triangles| SurfaceTree::new(triangles, &boxes, &normals.triangles))
            .collect();
        let meets = |place: usize| {
            let index = samples.start + place;
            let sample = &self.samples[index];
            let mut found = Vec::new();
            if self.weight(index as u32) == 0.0 {
                return found;
            }
            let ends = sample.ends.map(|p| p as usize);
            let bounds = Bounds::of(ends.into_iter().flat_map(|p| [accepted[p], points[p]]));
            let own = || {
                sample
                    .triangles
                    .iter()
                    .map(|t| normals.triangles[*t as usize])
            };
            for tree in &trees {
                // Objects do not touch themselves.
                if self.coefficient(index as u32, tree.first).is_nan() {
                    continue;
                }
                tree.facing(&bounds, own, [reach, behind], |triangle| {
                    if self.may_meet(index, triangle, &normals, state) {
                        found.push(triangle);
                    }
                });
            }
            found.sort_unstable();
            found
        };
        threads::map(samples.len(), meets)
    }

    /// Triangles of each surface that has some.
    fn triangles_of_surfaces(&self) -> impl Iterator<Item = Range<usize>> {
        let mut first = 0;
        self.surface_of.chunk_by(|a, b| a == b).map(move |own| {
            let range = first..first + own.len();
            first = range.end;
            range
        })
    }

    /// Tests whether a sample may meet a triangle; `normals` are those at the accepted state.
    fn may_meet(
        &self,
        index: usize,
        triangle: u32,
        normals: &Normals,
        state: &ContactState,
    ) -> bool {
        let sample = &self.samples[index];
        let n = normals.triangles[triangle as usize];
        let faces = |own: &u32| dot(normals.triangles[*own as usize], n) < FACING;
        if !sample.triangles.iter().any(faces) {
            return false;
        }
        let other = self.surface_of[triangle as usize];
        if sample
            .ends
            .iter()
            .any(|end| self.is_bonded(state, *end, other))
        {
            return false;
        }
        let itself = sample.surface == other;
        if itself {
            let of = self.triangles[triangle as usize];
            let mut own = sample.triangles.iter().map(|t| self.triangles[*t as usize]);
            if own.any(|own| own.iter().any(|point| of.contains(point))) {
                return false;
            }
        }
        if sample.is_edge() {
            return !itself || self.depth_of_edge(sample.ends, triangle).is_some();
        }
        self.may_come_to(index, triangle).is_some_and(|depth| {
            let start = state.accepted_points[index];
            let found = closest(start, self.corners(triangle, &state.accepted_points));
            let outward = || self.normal_among(normals, triangle, found.weights);
            self.counts_as_in_front(&found, depth, outward)
        })
    }

    /// Largest depth of an edge in a triangle of its own surface at an accepted state, in voxels: the smaller one of
    /// its ends.
    pub(super) fn depth_of_edge(&self, ends: [u32; 2], triangle: u32) -> Option<f64> {
        let [first, second] = ends.map(|end| self.depth_at_rest(end as usize, triangle));
        Some(first?.min(second?))
    }

    /// Tests whether a sample was in front of a triangle at the accepted state, or not too deep behind it, so that it
    /// may meet it.
    pub(super) fn was_in_front(&self, state: &ContactState, index: usize, triangle: u32) -> bool {
        let start = state.accepted_points[index];
        self.may_come_to(index, triangle)
            .is_some_and(|depth| self.is_in_front(triangle, start, &state.accepted_points, depth))
    }

    /// Largest depth of a sample in a triangle at an accepted state to count as in front of it, in voxels; `None` if
    /// they never meet.
    fn may_come_to(&self, index: usize, triangle: u32) -> Option<f64> {
        if self.samples[index].surface == self.surface_of[triangle as usize] {
            self.depth_at_rest(index, triangle)
        } else {
            Some(DEPTH)
        }
    }

    /// Largest depth of a sample in a triangle of its own surface at an accepted state to count as in front of it, in
    /// voxels; `None` if the unloaded body shows that they never meet.
    fn depth_at_rest(&self, index: usize, triangle: u32) -> Option<f64> {
        let points = &self.rest_points;
        let corners = self.corners(triangle, points);
        let found = closest(points[index], corners);
        let distance = found.distance / self.description.voxel;
        if distance > WALL {
            return Some(DEPTH);
        }
        let normals = &self.rest_normals;
        let n = normals.triangles[triangle as usize];
        let own = self.samples[index].triangles.iter();
        let least = own
            .map(|own| dot(normals.triangles[*own as usize], n))
            .fold(1.0, f64::min);
        let behind = || {
            dot(
                found.away,
                self.normal_among(normals, triangle, found.weights),
            ) < 0.0
        };
        match least < FACING {
            true if behind() => None,
            true => Some(DEPTH),
            false if distance <= PATCH && least > SAME_WAY => None,
            false => Some(BESIDE),
        }
    }
}

/// Triangles of a surface by place and direction.
struct SurfaceTree {
    /// Number of the first triangle.
    first: u32,
    tree: Tree,
    /// Box of the normals in each node of the tree.
    directions: Vec<Bounds>,
}

impl SurfaceTree {
    /// Builds the tree of a range of all triangles, which have these boxes and normals.
    fn new(triangles: Range<usize>, boxes: &[Bounds], normals: &[Vec3]) -> Self {
        let tree = Tree::new(&boxes[triangles.clone()]);
        let of_normal = |normal: &Vec3| Bounds::of([*normal]);
        let directions: Vec<Bounds> = normals[triangles.clone()].iter().map(of_normal).collect();
        Self {
            first: triangles.start as u32,
            directions: tree.fitted(&directions),
            tree,
        }
    }

    /// Calls `each` with the triangles in boxes that meet `bounds`, except those of nodes in which none looks at one of
    /// the directions `own` from in front of it, or from less than the distance `behind` (m) behind it: most triangles
    /// near a sample are those around it, which look its own way, and those of the other side of its wall. The boxes are
    /// grown by `reach` (m).
    fn facing<D: Iterator<Item = Vec3>>(
        &self,
        bounds: &Bounds,
        own: impl Fn() -> D,
        [reach, behind]: [f64; 2],
        mut each: impl FnMut(u32),
    ) {
        let in_front = |boxes: &Bounds, n: Vec3| {
            let growth = reach * n.iter().map(|x| x.abs()).sum::<f64>();
            boxes.largest_product(n) - growth - bounds.least_product(n) > -behind
        };
        let faces = |node: usize, boxes: &Bounds| {
            own().any(|n| self.directions[node].least_product(n) < FACING && in_front(boxes, n))
        };
        self.tree
            .meeting_within(bounds, faces, |triangle| each(self.first + triangle));
    }
}

fn grown(bounds: Bounds, by: f64) -> Bounds {
    Bounds {
        low: bounds.low.map(|x| x - by),
        high: bounds.high.map(|x| x + by),
    }
}
