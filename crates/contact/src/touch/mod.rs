//! Contact of closed surfaces, each with each other and with itself, with Coulomb friction.
//!
//! # Gap
//!
//! Points of every surface look for the closest triangle in front of them ([`gap`]), and edges for those that they cross
//! ([`edges`]). Both sides have samples, and each point stands for half of its area, so that neither is the master. A sample keeps its side: a triangle counts
//! only if the sample was in front of it at the last accepted state, so that the far side of a thin wall is never
//! taken for something that is met.
//!
//! # Augmented Lagrangian
//!
//! With a multiplier `λ` (N) for each sample and a penalty `k` (N/m), the energy is `k/2 ⟨λ/k − (g − δ)⟩²`, its force
//! `p = k ⟨λ/k − (g − δ)⟩`; after each equilibrium `λ ← p`, until no
//! gap is below the clearance `δ` by more than [`DEEPEST`], so that surfaces which touch do not intersect. The answer
//! does not depend on `k` (Alart and Curnier 1991, doi 10.1016/0045-7825(91)90022-X).
//!
//! # Friction
//!
//! A sample in contact has an anchor on the other surface and slips from it by `u`. Its friction is
//! `t = P (τ − k u)`, cut to the length `μ λ` (return mapping), with the multiplier `τ` brought up like `λ`: what
//! sticks does not move, however long it is held. The bound and the plane of friction are those of the last correction, so that friction has a potential; at the
//! end they are those of the pressure itself. Where a state is accepted, the anchor of what has slipped comes along.

pub mod bonds;
mod edges;
mod facing;
mod field;
mod friction;
pub(crate) mod gap;
mod listing;
pub mod live;
mod mortar;
mod path;
mod planes;
mod predicted;
mod recording;
mod report;
pub mod rigid;
mod state;
pub(crate) mod surface;
mod term;

use voxsoft_solid::vector::{Vec3, axpy, dot, scale, sub};
use voxsoft_solid::{Contact, ProblemError};

use bonds::Bond;
pub use field::{ContactField, Flip};
use gap::normal;
pub use report::PairReport;
use state::{Facing, Memory, State};
use surface::Sample;
pub use surface::{Carried, Surface};

/// The penalty in units of Young's modulus over the voxel size. What multipliers still have to learn shrinks by it
/// with every correction; at 100, blocks of rubber that is held against bulging take ten times as many.
const PENALTY: f64 = 1000.0;
/// The least area for which a sample has a penalty, of the mean one of its surface. Slivers of a skin would take theirs
/// on for ever, a little with each correction.
const LEAST_AREA: f64 = 0.5;
/// The penalty of slip, relative to that of gaps: what sticks gives way by more, and lets go less suddenly. Where
/// corrections take it on too slowly, because what they hold is stiffer than that, it grows.
const STICK: [f64; 2] = [0.01, 1.0];
/// By how much a correction must bring down what sticks and still creeps, and how much stiffer it is else.
const STIFFER: f64 = 4.0;
/// The clearance of surfaces that touch, in voxels: that of points, and that of edges, or of points where there are no edges, which is
/// what points have left of theirs at least. So edges carry nothing where surfaces lie flat on each other, as the sides of mismatched squares cross everywhere.
const CLEARANCE: [f64; 2] = [2e-4, 1e-4];
/// Looks at the start of a search for equilibrium; after a correction there is one.
const LOOKS: u32 = 2;
/// How far a sample may slide beyond the edge of the triangle that it faces before it looks again, in affine
/// coordinates.
const STRAYED: f64 = 0.5;
/// By how much gaps may be below the clearance at the end, in voxels: surfaces that touch do not intersect.
const DEEPEST: f64 = 0.9e-4;
/// How far apart samples may be that still press, and how far those may creep that stick, in voxels. Surfaces of
/// different voxels do not fit each other to the last point, where multipliers converge slowly.
const APART: f64 = 1e-3;
const CREEP: f64 = 1e-4;
/// By how much bounds of friction may be off, of the largest one that a vertex feels: at first, and after [`PATIENCE`]
/// corrections, as long as the sum of the bounds on each surface is that good.
const BOUND: [f64; 2] = [3e-3, 0.05];
/// The part of its bound from which friction counts as slipping: bounds of light pressures are right to a few percent.
const NEARLY: f64 = 0.95;
/// Corrections at one load after which samples keep what they face, and bounds may be off by more.
const PATIENCE: u32 = 10;
/// Corrections after which more precision than by default is given up.
const PRECISE: u32 = 36;
/// Parts of a motion, and of a direction, that are none.
const ROUNDING: f64 = 1e-9;

/// Who touches whom, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// The coefficient of friction of each surface with each, symmetric; NaN where they pass through each other.
    pub friction: Vec<Vec<f64>>,
    /// Surfaces that are bonded.
    pub bonds: Vec<Bond>,
    /// The size of a voxel in m.
    pub voxel: f64,
    /// Young's modulus of what touches, or something of its size, in Pa.
    pub young: f64,
}

/// Contact of surfaces.
#[derive(Debug, Clone)]
pub struct Touch {
    description: Description,
    samples: Vec<Sample>,
    /// The least area for which a sample of each surface has a penalty, m².
    least_area: Vec<f64>,
    /// The points of all surfaces.
    points: Vec<Carried>,
    /// How many of the surfaces, the first ones, are those of bodies.
    bodies: u32,
    /// For each point of bodies the vertices that stand for it, where those are not what carries it.
    shares: Vec<Carried>,
    /// Where they are in the unloaded design, m.
    rest_points: Vec<Vec3>,
    /// The axes across planes of symmetry through the origin.
    planes: [bool; 3],
    /// With these, the part of each sample that counts: none of those on the negative sides, which are images.
    weights: Vec<f64>,
    /// With these, the point that each is an image of, itself where it counts.
    twins: Vec<u32>,
    /// The axes on which vertices never move; empty where nothing touches in the unloaded design.
    still: Vec<[bool; 3]>,
    /// With these, the samples that are within their clearance there.
    touching: Vec<bool>,
    /// The triangles of all surfaces, of these points.
    triangles: Vec<[u32; 3]>,
    /// The surface of each.
    surface_of: Vec<u32>,
    /// The triangles at each point.
    around: Vec<Vec<u32>>,
    /// For each sample the ties that it is in, with the surface that they are to.
    ties_at: Vec<Vec<(u32, u32)>>,
    /// The penalty in units of Young's modulus over the voxel size, which live contact changes.
    penalty: f64,
    state: State,
}

/// A sample and what it is in front of.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    sample: u32,
    triangle: u32,
    /// Where on an edge it is, as a part of the way between its ends; 0 for a point.
    along: f64,
    /// Barycentric coordinates of the closest point.
    weights: [f64; 3],
    gap: f64,
    /// From the triangle to the sample.
    normal: Vec3,
    facing: Facing,
}

impl Meeting {
    /// How a sample with these ends lies to what it faces, a triangle with these corners; `None` for edges that have become
    /// parallel.
    fn new(sample: u32, facing: Facing, ends: [Vec3; 2], corners: [Vec3; 3]) -> Option<Self> {
        let (along, weights, normal) = match facing {
            Facing::Plane(_) => (0.0, gap::affine(ends[0], corners), normal(corners)),
            Facing::Edge(_, weights, normal) => (0.0, weights, normal),
            Facing::Across(_, corner, same) => {
                let crossing = gap::crossing(ends, edges::side(corners, corner))?;
                let [along, of_other] = crossing.along;
                let sign = if same { 1.0 } else { -1.0 };
                (
                    along,
                    edges::weights(corner, of_other),
                    scale(sign, crossing.normal),
                )
            }
        };
        let mut away = between(ends, along);
        for (weight, corner) in weights.iter().zip(corners) {
            axpy(&mut away, -weight, corner);
        }
        Some(Self {
            sample,
            triangle: facing.triangle(),
            along,
            weights,
            gap: dot(away, normal),
            normal,
            facing,
        })
    }

    /// Where the forces of a pressure act.
    fn spot(&self) -> Spot {
        Spot {
            sample: self.sample,
            along: self.along,
            triangle: self.triangle,
            weights: self.weights,
        }
    }
}

/// A place of a sample and one of a triangle that act on each other.
#[derive(Debug, Clone, Copy)]
struct Spot {
    sample: u32,
    /// As [`Meeting::along`].
    along: f64,
    triangle: u32,
    /// Affine coordinates.
    weights: [f64; 3],
}

/// The place that is a part of the way between two.
fn between([start, end]: [Vec3; 2], along: f64) -> Vec3 {
    let mut place = start;
    axpy(&mut place, along, sub(end, start));
    place
}

impl Touch {
    /// Makes contact ready for a problem with the vertices `rest` (m).
    pub fn new(description: Description, rest: &[Vec3]) -> Result<Self, ProblemError> {
        let count = description.surfaces.len();
        let rows = description.friction.iter().map(Vec::len);
        if description.friction.len() != count || !rows.into_iter().all(|row| row == count) {
            return Err(ProblemError::Length {
                what: "rows of the table of friction",
                got: description.friction.len(),
                expected: count,
            });
        }
        if let Some(&value) = description.friction.iter().flatten().find(|f| **f < 0.0) {
            let what = "a coefficient of friction";
            return Err(ProblemError::NotPositive { what, value });
        }
        for (what, value) in [
            ("the voxel size of contact", description.voxel),
            ("the modulus of contact", description.young),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ProblemError::NotPositive { what, value });
            }
        }
        let (mut samples, mut points, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let (mut surface_of, mut least_area) = (Vec::new(), Vec::new());
        let mut first_sample = Vec::new();
        for (number, surface) in description.surfaces.iter().enumerate() {
            surface.check(rest.len())?;
            let number = number as u32;
            let first = (points.len() as u32, triangles.len() as u32);
            let own = surface::samples(surface, number, first, rest);
            let area: f64 = own.iter().map(|sample| sample.area).sum();
            least_area.push(LEAST_AREA * area / own.len().max(1) as f64);
            samples.extend(own);
            let first = first.0;
            first_sample.push(first);
            points.extend(surface.points.iter().cloned());
            triangles.extend(surface.triangles.iter().map(|t| t.map(|p| first + p)));
            surface_of.resize(triangles.len(), number);
        }
        let rest_points = points.iter().map(|point| point.at(rest)).collect();
        let mut around = vec![Vec::new(); points.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for point in triangle {
                around[*point as usize].push(t as u32);
            }
        }
        // Points first, as they are numbered.
        samples.extend(surface::edges(&triangles, &surface_of));
        let mut touch = Self {
            description,
            samples,
            least_area,
            points,
            bodies: 1,
            shares: Vec::new(),
            rest_points,
            planes: [false; 3],
            weights: Vec::new(),
            twins: Vec::new(),
            still: Vec::new(),
            touching: Vec::new(),
            triangles,
            surface_of,
            around,
            ties_at: Vec::new(),
            penalty: PENALTY,
            state: State::default(),
        };
        touch.ties_at = touch.ties_at(&first_sample, touch.points.len());
        Contact::start(&mut touch, rest);
        Ok(touch)
    }

    /// Says how many surfaces are those of bodies, which come first, and gives their points vertices that stand for
    /// them in fields over vertices, with positive weights: what carries a smooth surface lies partly inside, and has
    /// weights of both signs.
    #[must_use]
    pub fn with_bodies(mut self, bodies: u32, shares: Vec<Carried>) -> Self {
        self.bodies = bodies;
        self.shares = shares;
        self
    }

    /// Says on which axes vertices, which are at `rest` in the unloaded design, never move, as those of a clamp without a
    /// motion.
    #[must_use]
    pub fn with_still(mut self, still: Vec<[bool; 3]>, rest: &[Vec3]) -> Self {
        let points = self.points_at(rest);
        let near = |point: &u32| {
            let facing = self.state.facing[*point as usize];
            let meeting = facing.and_then(|facing| self.meeting(*point, facing, &points));
            meeting.is_some_and(|meeting| meeting.gap < self.clearance(*point))
        };
        let touching = |sample: &Sample| sample.ends.iter().any(near);
        let touching: Vec<bool> = self.samples.iter().map(touching).collect();
        if touching.contains(&true) {
            (self.still, self.touching) = (still, touching);
        }
        self
    }

    /// The part of the clearance that a meeting keeps: of what is within it in the unloaded design, the part of what carries
    /// it that could open its gap, a half between a vertex that never moves and one that does, beside what rests. All of
    /// it, where there was more to begin with.
    fn mobility(&self, meeting: &Meeting) -> f64 {
        if !self
            .touching
            .get(meeting.sample as usize)
            .is_some_and(|touches| *touches)
        {
            return 1.0;
        }
        let mut free = 0.0;
        for (factor, point) in self.relative(meeting.spot()) {
            let point = &self.points[point as usize];
            for (vertex, weight) in point.vertices.iter().zip(&point.weights) {
                let held = self.still[*vertex as usize];
                if (0..3).any(|axis| !held[axis] && meeting.normal[axis].abs() > ROUNDING) {
                    free += (factor * weight).abs();
                }
            }
        }
        free.min(1.0)
    }

    /// Whether edges are kept out of edges.
    fn has_edges(&self) -> bool {
        self.samples.len() > self.points.len()
    }

    /// Leaves edges to themselves: only points are kept out of surfaces.
    pub(super) fn without_edges(mut self, rest: &[Vec3]) -> Self {
        self.samples.truncate(self.points.len());
        Contact::start(&mut self, rest);
        self
    }

    /// Who touches whom, and how.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The vertices that stand for a point, as points are numbered over all surfaces.
    fn share(&self, point: u32) -> &Carried {
        let point = point as usize;
        self.shares.get(point).unwrap_or(&self.points[point])
    }

    /// Changes the state by what the surfaces say of it.
    fn change<T>(&mut self, act: impl FnOnce(&Self, &mut State) -> T) -> T {
        let mut state = std::mem::take(&mut self.state);
        let outcome = act(self, &mut state);
        self.state = state;
        outcome
    }

    fn points_at(&self, positions: &[Vec3]) -> Vec<Vec3> {
        self.points
            .iter()
            .map(|point| point.at(positions))
            .collect()
    }

    fn corners(&self, triangle: u32, points: &[Vec3]) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|p| points[p as usize])
    }

    /// The friction between a sample and a triangle.
    fn coefficient(&self, sample: u32, triangle: u32) -> f64 {
        let of = self.samples[sample as usize].surface as usize;
        let with = self.surface_of[triangle as usize] as usize;
        self.description.friction[of][with]
    }

    /// N/m; both sides of a contact have samples.
    fn penalty(&self, sample: u32) -> f64 {
        let per_area = self.penalty * self.description.young / self.description.voxel;
        per_area * self.stiff_area(sample) / 2.0
    }

    /// The area for which a sample has a penalty, m².
    fn stiff_area(&self, sample: u32) -> f64 {
        let weight = self.weight(sample);
        let sample = &self.samples[sample as usize];
        weight * sample.area.max(self.least_area[sample.surface as usize])
    }

    /// The gap that a sample keeps, m.
    fn clearance(&self, sample: u32) -> f64 {
        let leaves_to_edges = sample < self.points.len() as u32 && self.has_edges();
        CLEARANCE[usize::from(!leaves_to_edges)] * self.description.voxel
    }

    fn ends(&self, sample: u32, points: &[Vec3]) -> [Vec3; 2] {
        self.samples[sample as usize]
            .ends
            .map(|p| points[p as usize])
    }

    /// The place of a sample that is a part of the way along it.
    fn place(&self, sample: u32, along: f64, points: &[Vec3]) -> Vec3 {
        between(self.ends(sample, points), along)
    }

    /// How a sample lies to what it faces; `None` for edges that have become parallel.
    fn meeting(&self, sample: u32, facing: Facing, points: &[Vec3]) -> Option<Meeting> {
        let corners = self.corners(facing.triangle(), points);
        Meeting::new(sample, facing, self.ends(sample, points), corners)
    }

    /// The force with which a sample is pushed away, N.
    ///
    /// Where a body touches from the first, the clearance goes to zero beside vertices that never move: there gaps are what
    /// they are, and a multiplier that were to open them would grow for ever.
    fn pressure(&self, memory: &Memory, meeting: &Meeting) -> f64 {
        let k = self.penalty(meeting.sample);
        let clearance = self.clearance(meeting.sample);
        if !(memory.normal - k * (meeting.gap - clearance) > 0.0) {
            return 0.0;
        }
        let mobility = self.mobility(meeting);
        if mobility <= ROUNDING {
            return 0.0;
        }
        (memory.normal - k * (meeting.gap - mobility * clearance)).max(0.0)
    }

    /// Hands over every sample that is in contact, with its pressure in N.
    fn each_contact(
        &self,
        state: &State,
        positions: &[Vec3],
        mut take: impl FnMut(&Meeting, f64, &[Vec3]),
    ) {
        let points = self.points_at(positions);
        for (index, facing) in state.facing.iter().enumerate() {
            let meeting = facing.and_then(|facing| self.meeting(index as u32, facing, &points));
            let Some(meeting) = meeting else {
                continue;
            };
            let pressure = self.pressure(&state.now[index], &meeting);
            if pressure > 0.0 {
                take(&meeting, pressure, &points);
            }
        }
    }

    /// The points that a spot moves with, each with the factor of its motion in the relative one: those of the sample,
    /// one or two, and the corners of the triangle.
    fn relative(&self, spot: Spot) -> impl Iterator<Item = (f64, u32)> {
        let sample = &self.samples[spot.sample as usize];
        let own = sample.ends.into_iter().zip([1.0 - spot.along, spot.along]);
        let own = own.take(1 + usize::from(sample.is_edge()));
        let corners = self.triangles[spot.triangle as usize].into_iter();
        let other = corners.zip(spot.weights.map(|weight| -weight));
        own.chain(other).map(|(point, factor)| (factor, point))
    }

    /// Adds the force on the sample at a spot, and its opposite on the triangle.
    fn add_force(&self, force: Vec3, spot: Spot, forces: &mut [Vec3]) {
        for (factor, point) in self.relative(spot) {
            self.points[point as usize].add_force(factor, force, forces);
        }
    }
}

#[cfg(test)]
mod tests;
