//! Bonds: surfaces that are glued to each other, for good or until a traction.
//!
//! Points `s` all over the triangles of the first surface that lie on the second at rest, with the areas `A_s`, are tied to the
//! places `y_s` of the second body where they are: these move with it. Vertices `v` share each point by `N_v(s)`, and there
//! is one tie for each of them (a mortar form: Bernardi, Maday and Patera 1994; Puso and Laursen 2004, doi 10.1016/j.cma.2003.10.010):
//!
//! ```text
//! c_v = Σ_s A_s N_v(s) (x_s − y_s) / W_v = 0,   W_v = Σ_s A_s N_v(s),
//! ```
//!
//! so that a uniform traction passes between voxels of different sizes, and neither side is stiffened. With a multiplier
//! `f` and a penalty `k` its force is `f − k c`, and `f` is brought up after each equilibrium as that of contact is. As
//! `y_s` is where the point was, gaps and overlaps at rest are kept, and no moment is lost.
//!
//! A bond with a strength lets go where `√(t_n² + t_t²)` passes it, with the pull `t_n` along the normal, which
//! a pressure does not count for, and the traction `t_t` along the surface; both as means over a tie and those beside it.
//! What has let go touches.

use std::collections::{BTreeMap, BTreeSet};

use voxsoft_solid::ProblemError;
use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::vector::{Vec3, add, axpy, dot, norm, scale, sub};

use super::gap::{area, closest, normal};
use super::rigid::Frame;
use super::state::State;
use super::{Carried, LEAST_AREA, PENALTY, Surface, Touch};
use crate::bounds::Bounds;
use crate::skin::Carriers;
use crate::tree::Tree;

/// Surfaces that are bonded look at each other: the product of their normals is below this.
const FACING: f64 = -0.5;
/// How far a tie may be off at the end, in voxels: a hundredth of the clearance of contact.
const OFF: f64 = 1e-6;
/// The penalty of a tie over that of contact: it has no kinks, and what multipliers still have to learn shrinks by it.
const STIFFER_THAN_CONTACT: f64 = 10.0;
/// Into how many parts the edge of a triangle is divided for the integrals: functions of the other side have kinks in it.
const PARTS: u32 = 4;
/// How far beside a triangle what lies on its edge may be, of the reach.
const ROUNDING: f64 = 1e-9;

/// What moves with a body, also a little beside its surface.
#[derive(Debug, Clone, Copy)]
pub enum Solid<'a> {
    /// A rigid object whose vertices are those from the given one on.
    Rigid(&'a Frame, u32),
    /// Voxels: corner `c` of each is at `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
    Voxels(&'a [[u32; 8]]),
}

/// One side of a bond.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// Its number among the surfaces.
    pub number: u32,
    /// The surface.
    pub surface: &'a Surface,
    /// For each point the vertices that stand for it, with positive weights; none where these are what carries it.
    pub shares: &'a [Carried],
    /// What is behind the surface.
    pub solid: Solid<'a>,
}

/// Two surfaces that are bonded.
#[derive(Debug, Clone, PartialEq)]
pub struct Bond {
    /// The surfaces.
    pub of: [u32; 2],
    /// The traction at which it lets go, Pa; infinite for one that does not.
    pub strength: f64,
    /// What is tied.
    pub(super) ties: Vec<Tie>,
}

/// The mean of places of the first surface, and that of the same places in the second body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tie {
    /// On the first surface.
    pub first: Carried,
    /// In the second body.
    pub second: Carried,
    /// In the unloaded body, m².
    pub area: f64,
    /// The area for which it has a penalty, m².
    pub stiff: f64,
    /// A triangle of the second surface there, as it is numbered on it.
    pub triangle: u32,
    /// The points of the first surface in it, and those of the second one nearest to it.
    pub points: [Vec<u32>; 2],
    /// The ties of its bond that have points of it, itself included.
    pub patch: Vec<u32>,
}

/// What a tie carries along a load path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Hold {
    /// Its multiplier, on the first surface, N.
    pub force: Vec3,
    /// Whether it has let go.
    pub broken: bool,
}

impl Bond {
    /// Bonds the parts of two surfaces that are within `reach` (m) of each other at `rest`.
    ///
    /// The first one should have the smaller voxels, and must not be rigid unless both are.
    ///
    /// # Errors
    ///
    /// They do not meet.
    pub fn new(
        first: Side<'_>,
        second: Side<'_>,
        reach: f64,
        strength: f64,
        rest: &[Vec3],
    ) -> Result<Self, ProblemError> {
        let ties = Meeting::new([first, second], reach, rest).ties(rest);
        if ties.is_empty() {
            let what = "the bonded area in m²";
            return Err(ProblemError::NotPositive { what, value: 0.0 });
        }
        Ok(Self {
            of: [first.number, second.number],
            strength,
            ties,
        })
    }
}

/// Two surfaces at rest, and where they meet.
struct Meeting<'a> {
    sides: [Side<'a>; 2],
    /// The points of both, m.
    points: [Vec<Vec3>; 2],
    trees: [Tree; 2],
    /// m
    reach: f64,
}

/// A triangle near a point.
#[derive(Clone, Copy)]
struct Near {
    distance: f64,
    triangle: u32,
    /// Whether the point is straight above it.
    is_over: bool,
}

impl<'a> Meeting<'a> {
    fn new(sides: [Side<'a>; 2], reach: f64, rest: &[Vec3]) -> Self {
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

    /// The nearest triangle of a side within reach that looks against a direction.
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

    /// The triangles of the first surface that lie on the second one.
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

    /// The points of the second surface that lie on those triangles.
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

    fn ties(&self, rest: &[Vec3]) -> Vec<Tie> {
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
                    // A rigid side has no vertices that share its points: each of them is tied.
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
            // What has little area would take its multiplier on slowly.
            tie.stiff = tie.area.max(LEAST_AREA * mean);
        }
        ties
    }

    /// The vertex nearest to a point of those that stand for a triangle.
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

/// A place in a triangle.
fn place(corners: [Vec3; 3], weights: [f64; 3]) -> Vec3 {
    let pairs = corners.iter().zip(weights);
    pairs.fold([0.0; 3], |sum, (x, weight)| add(sum, scale(weight, *x)))
}

/// The middles of the parts of a triangle, as barycentric coordinates.
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

/// A weighted mean of what is carried.
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

/// A tie that is being summed up.
#[derive(Default)]
struct Draft {
    sides: [BTreeMap<u32, f64>; 2],
    area: f64,
    /// The largest part of it, and the triangle below that.
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

impl Tie {
    /// How far it is off, m.
    fn off(&self, positions: &[Vec3]) -> Vec3 {
        sub(self.first.at(positions), self.second.at(positions))
    }
}

impl Touch {
    /// All ties with their bonds, as their holds are numbered.
    pub(super) fn ties(&self) -> impl Iterator<Item = (&Bond, &Tie)> {
        let bonds = self.description.bonds.iter();
        bonds.flat_map(|bond| bond.ties.iter().map(move |tie| (bond, tie)))
    }

    /// Hands over every tie that holds, with its force on the first surface, N.
    pub(super) fn each_tie(
        &self,
        state: &State,
        positions: &[Vec3],
        mut take: impl FnMut(&Bond, &Tie, Vec3),
    ) {
        for ((bond, tie), hold) in self.ties().zip(&state.holds) {
            if !hold.broken {
                let force = self.tie_force(tie, hold, positions);
                take(bond, tie, force);
            }
        }
    }

    fn tie_force(&self, tie: &Tie, hold: &Hold, positions: &[Vec3]) -> Vec3 {
        let mut force = hold.force;
        axpy(&mut force, -self.tie_penalty(tie), tie.off(positions));
        force
    }

    /// N/m.
    pub(super) fn tie_penalty(&self, tie: &Tie) -> f64 {
        STIFFER_THAN_CONTACT * PENALTY * self.description.young / self.description.voxel * tie.stiff
    }

    /// The multipliers that ties have at an equilibrium, and how far off they are, as a part of what they may.
    pub(super) fn corrected_ties(&self, state: &State, positions: &[Vec3]) -> (Vec<Hold>, f64) {
        let mut largest = 0.0f64;
        let pairs = self.ties().zip(&state.holds);
        let corrected = pairs.map(|((_, tie), hold)| {
            if hold.broken {
                return *hold;
            }
            largest = largest.max(norm(tie.off(positions)) / (OFF * self.description.voxel));
            Hold {
                force: self.tie_force(tie, hold, positions),
                ..*hold
            }
        });
        (corrected.collect(), largest)
    }

    /// Lets go what is pulled harder than it holds; whether anything has.
    pub(super) fn break_ties(&self, state: &mut State, positions: &[Vec3]) -> bool {
        let mut loads = Vec::with_capacity(state.holds.len());
        let mut first = 0;
        for bond in &self.description.bonds {
            let holds = &state.holds[first..first + bond.ties.len()];
            first += bond.ties.len();
            for (tie, hold) in bond.ties.iter().zip(holds) {
                let load = if hold.broken || bond.strength.is_infinite() {
                    0.0
                } else {
                    let traction = self.traction(bond, tie, holds, positions);
                    self.pull(bond, tie, traction, positions) / bond.strength
                };
                loads.push(load);
            }
        }
        let mut any = false;
        for (hold, load) in state.holds.iter_mut().zip(loads) {
            if load > 1.0 {
                (hold.broken, any) = (true, true);
            }
        }
        any
    }

    /// The traction on the first surface around a tie, Pa: multipliers of single ones, of which some have little area, go
    /// up and down from one to the next.
    fn traction(&self, bond: &Bond, tie: &Tie, holds: &[Hold], positions: &[Vec3]) -> Vec3 {
        let (mut force, mut area) = ([0.0; 3], 0.0);
        for &near in &tie.patch {
            let (tie, hold) = (&bond.ties[near as usize], &holds[near as usize]);
            if !hold.broken {
                axpy(&mut force, 1.0, self.tie_force(tie, hold, positions));
                area += tie.area;
            }
        }
        scale(1.0 / area, force)
    }

    /// The size of a traction on the first surface without what of it presses, Pa.
    fn pull(&self, bond: &Bond, tie: &Tie, traction: Vec3, positions: &[Vec3]) -> f64 {
        let surface = &self.description.surfaces[bond.of[1] as usize];
        let corners = surface.triangles[tie.triangle as usize];
        let outward = normal(corners.map(|p| surface.points[p as usize].at(positions)));
        let pressing = dot(traction, outward).max(0.0);
        norm(sub(traction, scale(pressing, outward)))
    }

    /// For each sample the ties that it is in, with the surface that they are to.
    pub(super) fn ties_at(&self, first_sample: &[u32], samples: usize) -> Vec<Vec<(u32, u32)>> {
        let mut at = vec![Vec::new(); samples];
        for (number, (bond, tie)) in self.ties().enumerate() {
            for side in 0..2 {
                let first = first_sample[bond.of[side] as usize];
                for point in &tie.points[side] {
                    at[(first + point) as usize].push((number as u32, bond.of[1 - side]));
                }
            }
        }
        at
    }

    /// Whether a sample is still bonded to a surface.
    pub(super) fn is_bonded(&self, state: &State, sample: u32, surface: u32) -> bool {
        let ties = self.ties_at[sample as usize].iter();
        let holds = |(tie, to): &(u32, u32)| *to == surface && !state.holds[*tie as usize].broken;
        ties.into_iter().any(holds)
    }

    /// The stiffness of a tie: its penalty between all vertices that carry it.
    pub(super) fn visit_tie(&self, tie: &Tie, visit: Visitor<'_>) {
        let mut parts: BTreeMap<u32, f64> = BTreeMap::new();
        for (sign, side) in [(1.0, &tie.first), (-1.0, &tie.second)] {
            for (vertex, weight) in side.vertices.iter().zip(&side.weights) {
                *parts.entry(*vertex).or_default() += sign * weight;
            }
        }
        let (vertices, weights): (Vec<u32>, Vec<f64>) = parts.into_iter().unzip();
        let size = 3 * vertices.len();
        let mut matrix = vec![0.0; size * size];
        let k = self.tie_penalty(tie);
        for (a, wa) in weights.iter().enumerate() {
            for (b, wb) in weights.iter().enumerate() {
                for i in 0..3 {
                    matrix[(3 * a + i) * size + 3 * b + i] = k * wa * wb;
                }
            }
        }
        visit(&vertices, &matrix);
    }
}
