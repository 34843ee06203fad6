//! Mortar integrals over the bonded part of the first surface, and the ties of a bond.

use std::collections::{BTreeMap, BTreeSet};

use voxsoft_solid::vector::{Vec3, add, dot, norm, scale, sub};

use super::LEAST_AREA;
use super::tie::{Side, Solid, Tie};
use crate::bounds::Bounds;
use crate::gap::{area, closest, normal};
use crate::skin::Carriers;
use crate::surface::Carried;
use crate::tree::Tree;

/// Largest product of the normals of bonded surfaces, which look at each other.
const FACING: f64 = -0.5;
/// Parts into which the edge of a triangle is divided for the integrals: shape functions of the other side have kinks
/// in it.
const PARTS: u32 = 4;
/// Tolerance for a point straight above a triangle, relative to the reach.
const ROUNDING: f64 = 1e-9;

/// Two surfaces at rest, and the search of their bonded parts.
pub(super) struct MortarIntegral<'a> {
    sides: [Side<'a>; 2],
    /// Points of both, m.
    points: [Vec<Vec3>; 2],
    trees: [Tree; 2],
    /// Largest distance of bonded surfaces, m.
    reach: f64,
}

/// Triangle near a point.
#[derive(Clone, Copy)]
struct Near {
    distance: f64,
    triangle: u32,
    /// True if the point is straight above the triangle.
    is_over: bool,
}

impl<'a> MortarIntegral<'a> {
    pub fn new(sides: [Side<'a>; 2], reach: f64, rest: &[Vec3]) -> Self {
        let points = sides.map(|side| side.surface.points.iter().map(|p| p.at(rest)).collect());
        let tree = |side: usize| {
            let points: &Vec<Vec3> = &points[side];
            let triangles = sides[side].surface.triangles.iter();
            let boxes = triangles.map(|t| Bounds::of(t.map(|p| points[p as usize])));
            Tree::new(&boxes.collect::<Vec<_>>())
        };
        Self {
            trees: [tree(0), tree(1)],
            sides,
            points,
            reach,
        }
    }

    fn corners(&self, side: usize, triangle: u32) -> [Vec3; 3] {
        let corners = self.sides[side].surface.triangles[triangle as usize];
        corners.map(|p| self.points[side][p as usize])
    }

    /// Nearest triangle of a side within reach whose normal opposes a direction.
    fn nearest(&self, side: usize, point: Vec3, against: Vec3) -> Option<Near> {
        let around = Bounds {
            low: point.map(|x| x - self.reach),
            high: point.map(|x| x + self.reach),
        };
        let mut best: Option<Near> = None;
        self.trees[side].meeting(&around, |triangle| {
            let corners = self.corners(side, triangle);
            let outward = normal(corners);
            if dot(outward, against) >= FACING {
                return;
            }
            let found = closest(point, corners);
            let distance = found.distance;
            let nearer =
                best.is_none_or(|best| (distance, triangle) < (best.distance, best.triangle));
            if distance <= self.reach && nearer {
                let straight = dot(found.away, outward).abs();
                best = Some(Near {
                    distance,
                    triangle,
                    is_over: straight > distance - ROUNDING * self.reach,
                });
            }
        });
        best
    }

    /// Triangles of the first surface that lie on the second one.
    fn bonded(&self) -> Vec<bool> {
        let all = 0..self.sides[0].surface.triangles.len() as u32;
        let lies = |triangle: u32| {
            let corners = self.corners(0, triangle);
            let outward = normal(corners);
            let middle = self.nearest(1, place(corners, [1.0 / 3.0; 3]), outward);
            middle.is_some_and(|middle| middle.is_over)
                && corners
                    .iter()
                    .all(|x| self.nearest(1, *x, outward).is_some())
        };
        all.map(lies).collect()
    }

    /// Points of the second surface that lie on those triangles.
    fn beside(&self, bonded: &[bool]) -> BTreeSet<u32> {
        let mut beside = BTreeSet::new();
        for (t, triangle) in self.sides[1].surface.triangles.iter().enumerate() {
            let outward = normal(self.corners(1, t as u32));
            for point in triangle {
                let found = self.nearest(0, self.points[1][*point as usize], outward);
                if found.is_some_and(|near| bonded[near.triangle as usize]) {
                    beside.insert(*point);
                }
            }
        }
        beside
    }

    /// Ties of the bond, one for each vertex that has points of the first surface on the second.
    pub fn ties(&self, rest: &[Vec3]) -> Vec<Tie> {
        let [first, second] = self.sides;
        let carriers = match second.solid {
            Solid::Voxels(voxels) => Some(Carriers::new(voxels, rest)),
            Solid::Rigid(..) => None,
        };
        let bonded = self.bonded();
        let mut drafts: BTreeMap<u32, Draft> = BTreeMap::new();
        for (t, triangle) in first.surface.triangles.iter().enumerate() {
            if !bonded[t] {
                continue;
            }
            let corners = self.corners(0, t as u32);
            let outward = normal(corners);
            let part = area(corners) / f64::from(PARTS * PARTS);
            for weights in parts() {
                let point = place(corners, weights);
                let Some(near) = self.nearest(1, point, outward) else {
                    continue;
                };
                let own = mixed(triangle.map(|p| &first.surface.points[p as usize]), weights);
                let there = match second.solid {
                    Solid::Rigid(frame, vertex) => frame.carry(point, vertex),
                    Solid::Voxels(_) => {
                        let share = self.vertex_near(second, near.triangle, point, rest);
                        let carry = |carriers: &Carriers<'_>| carriers.carry(&share, point);
                        carriers.as_ref().map_or_else(Carried::default, carry)
                    }
                };
                let share = match first.solid {
                    // A rigid side has no vertices that share its points: each of its points is tied.
                    Solid::Rigid(..) => Carried {
                        vertices: triangle.to_vec(),
                        weights: weights.to_vec(),
                    },
                    Solid::Voxels(_) => {
                        let of = |p: u32| {
                            let own = &first.surface.points[p as usize];
                            first.shares.get(p as usize).unwrap_or(own)
                        };
                        mixed(triangle.map(of), weights)
                    }
                };
                for (vertex, weight) in share.vertices.iter().zip(&share.weights) {
                    let draft = drafts.entry(*vertex).or_default();
                    draft.take(weight * part, [&own, &there], near.triangle);
                    draft.points.extend(triangle);
                }
            }
        }
        let mut ties: Vec<Tie> = drafts.into_values().map(Draft::finish).collect();
        let places: Vec<Vec3> = ties.iter().map(|tie| tie.first.at(rest)).collect();
        for point in self.beside(&bonded) {
            let at = self.points[1][point as usize];
            let far = |place: &Vec3| norm(sub(*place, at));
            let nearest =
                (0..ties.len()).min_by(|a, b| far(&places[*a]).total_cmp(&far(&places[*b])));
            if let Some(nearest) = nearest {
                ties[nearest].points[1].push(point);
            }
        }
        let mean = ties.iter().map(|tie| tie.area).sum::<f64>() / ties.len().max(1) as f64;
        let mut of_point: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (number, tie) in ties.iter().enumerate() {
            for point in &tie.points[0] {
                of_point.entry(*point).or_default().push(number as u32);
            }
        }
        for tie in &mut ties {
            let each = tie.points[0].iter().flat_map(|point| &of_point[point]);
            let patch: BTreeSet<u32> = each.copied().collect();
            tie.patch = patch.into_iter().collect();
            // The multiplier of a tie of little area would converge slowly.
            tie.stiff = tie.area.max(LEAST_AREA * mean);
        }
        ties
    }

    /// Vertex nearest to a point among those that stand for a triangle.
    fn vertex_near(&self, side: Side<'_>, triangle: u32, point: Vec3, rest: &[Vec3]) -> Carried {
        let corners = side.surface.triangles[triangle as usize];
        let share = |corner: &u32| {
            let corner = *corner as usize;
            side.shares
                .get(corner)
                .unwrap_or(&side.surface.points[corner])
        };
        let vertices = corners.iter().flat_map(|corner| &share(corner).vertices);
        let far = |vertex: u32| norm(sub(rest[vertex as usize], point));
        let nearest = vertices.copied().min_by(|a, b| far(*a).total_cmp(&far(*b)));
        nearest.map_or_else(Carried::default, Carried::vertex)
    }
}

/// Place in a triangle.
fn place(corners: [Vec3; 3], weights: [f64; 3]) -> Vec3 {
    let pairs = corners.iter().zip(weights);
    pairs.fold([0.0; 3], |sum, (x, weight)| add(sum, scale(weight, *x)))
}

/// Centroids of the parts of a triangle, as barycentric coordinates.
fn parts() -> impl Iterator<Item = [f64; 3]> {
    let third = 1.0 / 3.0;
    let at = |i: u32, j: u32, offset: f64| {
        let along = |k: u32| (f64::from(k) + offset) / f64::from(PARTS);
        [1.0 - along(i) - along(j), along(i), along(j)]
    };
    let all = (0..PARTS).flat_map(|i| (0..PARTS - i).map(move |j| (i, j)));
    all.flat_map(move |(i, j)| {
        let turned = (i + j + 1 < PARTS).then(|| at(i, j, 2.0 * third));
        std::iter::once(at(i, j, third)).chain(turned)
    })
}

/// Weighted mean of carried points.
fn mixed(parts: [&Carried; 3], weights: [f64; 3]) -> Carried {
    let mut sum: BTreeMap<u32, f64> = BTreeMap::new();
    for (part, factor) in parts.iter().zip(weights) {
        for (vertex, weight) in part.vertices.iter().zip(&part.weights) {
            *sum.entry(*vertex).or_default() += factor * weight;
        }
    }
    let (vertices, weights) = sum.into_iter().unzip();
    Carried { vertices, weights }
}

/// Accumulator of a tie.
#[derive(Default)]
struct Draft {
    sides: [BTreeMap<u32, f64>; 2],
    area: f64,
    /// Largest contribution, and the triangle below it.
    heaviest: (f64, u32),
    points: BTreeSet<u32>,
}

impl Draft {
    fn take(&mut self, part: f64, ends: [&Carried; 2], triangle: u32) {
        for (side, carried) in self.sides.iter_mut().zip(ends) {
            for (vertex, weight) in carried.vertices.iter().zip(&carried.weights) {
                *side.entry(*vertex).or_default() += part * weight;
            }
        }
        self.area += part;
        if part > self.heaviest.0 {
            self.heaviest = (part, triangle);
        }
    }

    fn finish(self) -> Tie {
        let area = self.area;
        let mean = |side: BTreeMap<u32, f64>| {
            let (vertices, weights) = side.into_iter().map(|(v, w)| (v, w / area)).unzip();
            Carried { vertices, weights }
        };
        let [first, second] = self.sides;
        Tie {
            first: mean(first),
            second: mean(second),
            area,
            stiff: area,
            triangle: self.heaviest.1,
            points: [self.points.into_iter().collect(), Vec::new()],
            patch: Vec::new(),
        }
    }
}
