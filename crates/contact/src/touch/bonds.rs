//! Bonds: surfaces that are glued to each other, for good or until a traction.
//!
//! Samples `s` of the first surface that lie on the second at rest, with the areas `A_s`, are tied to the places `y_s` of the second
//! body where they are: these move with it. Vertices `v` share each sample by `N_v(s)`, and there is one tie for
//! each of them (a mortar form: Bernardi, Maday and Patera 1994; Puso and Laursen 2004, doi 10.1016/j.cma.2003.10.010):
//!
//! ```text
//! c_v = Σ_s A_s N_v(s) (x_s − y_s) / W_v = 0,   W_v = Σ_s A_s N_v(s),
//! ```
//!
//! so that a uniform traction passes between voxels of different sizes, and neither side is stiffened. With a multiplier
//! `f` and a penalty `k` its force is `f − k c`, and `f` is brought up after each equilibrium as that of contact is. As
//! `y_s` is where the sample was, gaps and overlaps at rest are kept, and no moment is lost.
//!
//! A bond with a strength lets go where `√(t_n² + t_t²)` passes it, with the pull `t_n` along the normal, which
//! a pressure does not count for, and the traction `t_t` along the surface. What has let go touches.

use std::collections::BTreeMap;

use voxsoft_solid::ProblemError;
use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::vector::{Vec3, add, axpy, dot, norm, scale, sub};

use super::gap::{area, closest, normal};
use super::rigid::Frame;
use super::state::State;
use super::{Carried, PENALTY, Surface, Touch};
use crate::bounds::Bounds;
use crate::skin::Carriers;
use crate::tree::Tree;

/// Surfaces that are bonded look at each other: the product of their normals is below this.
const FACING: f64 = -0.5;
/// How far a tie may be off at the end, in voxels: a hundredth of the clearance of contact.
const OFF: f64 = 1e-6;
/// Of the ties that are past their strength those let go together that are within this part of the worst one. What the
/// others carry changes then.
const WORST: f64 = 0.9;

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
    /// A triangle of the second surface there, as it is numbered on it.
    pub triangle: u32,
    /// The points of the first surface in it, and those of the second one nearest to it.
    pub points: [Vec<u32>; 2],
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
        let meeting = Meeting::of(first, second, reach, rest);
        let ties = meeting.ties(first, second, rest);
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

/// Where two surfaces meet at rest.
struct Meeting {
    /// The points of both, m.
    points: [Vec<Vec3>; 2],
    /// For each point of the first surface the area that is bonded, m².
    areas: Vec<f64>,
    /// For each of them the triangle of the second that it is on.
    on: Vec<Option<u32>>,
    /// The points of the second surface that are on bonded triangles of the first.
    beside: Vec<u32>,
}

impl Meeting {
    fn of(first: Side<'_>, second: Side<'_>, reach: f64, rest: &[Vec3]) -> Self {
        let at = |side: Side<'_>| -> Vec<Vec3> {
            side.surface.points.iter().map(|p| p.at(rest)).collect()
        };
        let points = [at(first), at(second)];
        let corners = |side: usize, surface: &Surface, t: u32| {
            surface.triangles[t as usize].map(|p| points[side][p as usize])
        };
        let tree_of = |side: usize, of: Side<'_>| {
            let all = 0..of.surface.triangles.len() as u32;
            let boxes: Vec<Bounds> = all.map(|t| Bounds::of(corners(side, of.surface, t))).collect();
            Tree::new(&boxes)
        };
        let trees = [tree_of(0, first), tree_of(1, second)];
        // The nearest triangle of a side within reach that looks along `against`.
        let nearest = |side: usize, of: Side<'_>, point: Vec3, against: Vec3| {
            let around = Bounds {
                low: point.map(|x| x - reach),
                high: point.map(|x| x + reach),
            };
            let mut best: Option<(f64, u32, bool)> = None;
            trees[side].meeting(&around, |t| {
                let corners = corners(side, of.surface, t);
                if dot(normal(corners), against) < FACING {
                    let found = closest(point, corners);
                    let over = dot(found.away, normal(corners)).abs() > found.distance - 1e-9 * reach;
                    let key = (found.distance, t);
                    if found.distance <= reach && best.is_none_or(|(d, other, _)| key < (d, other)) {
                        best = Some((found.distance, t, over));
                    }
                }
            });
            best
        };
        let mut areas = vec![0.0; points[0].len()];
        let mut on = vec![None; points[0].len()];
        let mut bonded = vec![false; first.surface.triangles.len()];
        for (t, triangle) in first.surface.triangles.iter().enumerate() {
            let at = corners(0, first.surface, t as u32);
            let outward = normal(at);
            let middle = scale(1.0 / 3.0, at.iter().fold([0.0; 3], |sum, x| add(sum, *x)));
            let is_over = nearest(1, second, middle, outward).is_some_and(|(.., over)| over);
            let each = at.map(|point| nearest(1, second, point, outward));
            if !is_over || each.iter().any(Option::is_none) {
                continue;
            }
            bonded[t] = true;
            for (point, found) in triangle.iter().zip(each) {
                areas[*point as usize] += area(at) / 3.0;
                on[*point as usize] = found.map(|(_, t, _)| t);
            }
        }
        let mut beside = Vec::new();
        for (t, triangle) in second.surface.triangles.iter().enumerate() {
            let outward = normal(corners(1, second.surface, t as u32));
            for point in triangle {
                let found = nearest(0, first, points[1][*point as usize], outward);
                if found.is_some_and(|(_, t, _)| bonded[t as usize]) {
                    beside.push(*point);
                }
            }
        }
        beside.sort_unstable();
        beside.dedup();
        Self {
            points,
            areas,
            on,
            beside,
        }
    }

    fn ties(&self, first: Side<'_>, second: Side<'_>, rest: &[Vec3]) -> Vec<Tie> {
        let carriers = match second.solid {
            Solid::Voxels(voxels) => Some(Carriers::new(voxels, rest)),
            Solid::Rigid(..) => None,
        };
        let mut drafts: BTreeMap<u32, Draft> = BTreeMap::new();
        for (sample, (&area, on)) in self.areas.iter().zip(&self.on).enumerate() {
            let Some(triangle) = *on else {
                continue;
            };
            let point = self.points[0][sample];
            let own = &first.surface.points[sample];
            let there = match second.solid {
                Solid::Rigid(frame, vertex) => frame.carry(point, vertex),
                Solid::Voxels(_) => {
                    let share = self.vertex_near(second, triangle, point, rest);
                    carriers.as_ref().map_or_else(Carried::default, |c| c.carry(&share, point))
                }
            };
            // A rigid side has no vertices that share its samples: each of them is tied.
            let alone = Carried::vertex(sample as u32);
            let share = match first.solid {
                Solid::Rigid(..) => &alone,
                Solid::Voxels(_) => first.shares.get(sample).unwrap_or(own),
            };
            for (vertex, weight) in share.vertices.iter().zip(&share.weights) {
                let draft = drafts.entry(*vertex).or_default();
                draft.take(weight * area, own, &there, sample as u32, triangle);
            }
        }
        let mut ties: Vec<Tie> = drafts.into_values().map(Draft::finish).collect();
        let places: Vec<Vec3> = ties.iter().map(|tie| tie.first.at(rest)).collect();
        for &point in &self.beside {
            let at = self.points[1][point as usize];
            let far = |place: &Vec3| norm(sub(*place, at));
            let nearest = (0..ties.len()).min_by(|a, b| far(&places[*a]).total_cmp(&far(&places[*b])));
            if let Some(nearest) = nearest {
                ties[nearest].points[1].push(point);
            }
        }
        ties
    }

    /// The vertex nearest to a point of those that stand for a triangle.
    fn vertex_near(&self, side: Side<'_>, triangle: u32, point: Vec3, rest: &[Vec3]) -> Carried {
        let corners = side.surface.triangles[triangle as usize];
        let share = |corner: &u32| {
            let corner = *corner as usize;
            side.shares.get(corner).unwrap_or(&side.surface.points[corner])
        };
        let vertices = corners.iter().flat_map(|corner| &share(corner).vertices);
        let far = |vertex: u32| norm(sub(rest[vertex as usize], point));
        let nearest = vertices.copied().min_by(|a, b| far(*a).total_cmp(&far(*b)));
        nearest.map_or_else(Carried::default, Carried::vertex)
    }
}

/// A tie that is being summed up.
#[derive(Default)]
struct Draft {
    sides: [BTreeMap<u32, f64>; 2],
    area: f64,
    /// The largest part of a sample in it, and the triangle below that.
    heaviest: (f64, u32),
    points: Vec<u32>,
}

impl Draft {
    fn take(&mut self, part: f64, own: &Carried, there: &Carried, sample: u32, triangle: u32) {
        for (side, carried) in self.sides.iter_mut().zip([own, there]) {
            for (vertex, weight) in carried.vertices.iter().zip(&carried.weights) {
                *side.entry(*vertex).or_default() += part * weight;
            }
        }
        self.area += part;
        if part > self.heaviest.0 {
            self.heaviest = (part, triangle);
        }
        self.points.push(sample);
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
            triangle: self.heaviest.1,
            points: [self.points, Vec::new()],
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
        PENALTY * self.description.young / self.description.voxel * tie.area
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
        for ((bond, tie), hold) in self.ties().zip(&state.holds) {
            let load = if hold.broken || bond.strength.is_infinite() {
                0.0
            } else {
                let force = self.tie_force(tie, hold, positions);
                let traction = scale(1.0 / tie.area, force);
                self.pull(bond, tie, traction, positions) / bond.strength
            };
            loads.push(load);
        }
        let worst = loads.iter().copied().fold(0.0, f64::max);
        if worst <= 1.0 {
            return false;
        }
        for (hold, load) in state.holds.iter_mut().zip(loads) {
            hold.broken |= load >= f64::max(1.0, WORST * worst);
        }
        true
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
