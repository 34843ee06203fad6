//! Contact of closed surfaces, each with each other and with itself, with Coulomb friction.
//!
//! # Gap
//!
//! Points of every surface search the closest triangle in front of them ([`crate::gap`]), and edges the edges that they
//! cross ([`edges`]). Both sides have samples, and each point stands for half of its area, so that neither is the
//! master. A sample keeps its side: a triangle counts only if the sample was in front of it at the last accepted state,
//! so that the far side of a thin wall is never mistaken for an obstacle.
//!
//! # Augmented Lagrangian
//!
//! With a multiplier `λ` (N) for each sample and a penalty `k` (N/m), the energy is `k/2 ⟨λ/k − (g − δ)⟩²`, its force
//! `p = k ⟨λ/k − (g − δ)⟩`; after each equilibrium `λ ← p`, until no gap is below the clearance `δ` by more than
//! [`DEEPEST`], so that surfaces in contact do not intersect. The result does not depend on `k` (Alart and Curnier
//! 1991, doi 10.1016/0045-7825(91)90022-X).
//!
//! # Friction
//!
//! A sample in contact has an anchor on the other surface and slips from it by `u`. Its friction is `t = P (τ − k u)`,
//! cut to the length `μ λ` (return mapping), with the multiplier `τ` updated like `λ`: a sticking sample does not move,
//! however long it is held. The bound and the plane of friction are those of the last correction, so that friction has
//! a potential; at the end they are those of the pressure itself. When a state is accepted, the anchors of slipping
//! samples move along.

mod across;
mod anchors;
pub mod bonds;
mod edges;
mod facing;
mod field;
mod friction;
pub mod law;
mod listing;
pub mod live;
mod mortar;
mod normals;
mod path;
mod planes;
mod predicted;
mod recording;
mod report;
pub mod rigid;
mod sample;
mod state;
mod term;
pub mod tie;

use voxsoft_solid::vector::{Vec3, axpy, dot, scale, sub};
use voxsoft_solid::{Contact, ProblemError};

use bonds::Bond;
pub use field::{ContactField, Flip};
use law::Laws;
use normals::Normals;
pub use report::PairReport;
use sample::Sample;
use state::{ContactState, Facing};

use crate::gap::{self, normal};
use crate::surface::{Carried, Surface};

/// Contact penalty in units of Young's modulus over the voxel size. The larger it is, the more each correction reduces
/// the multiplier error; at 100, blocks of rubber held against bulging take ten times as many corrections.
const PENALTY: f64 = 1000.0;
/// Smallest area from which the penalty of a sample is computed, relative to the mean one of its surface. Multipliers
/// of slivers of a skin would otherwise converge endlessly, a little with each correction.
const LEAST_AREA: f64 = 0.5;
/// Slip penalty relative to the contact penalty, at first and at most: a soft one lets sticking samples slip less
/// abruptly. It grows if corrections converge too slowly, because the held bodies are stiffer.
const STICK: [f64; 2] = [0.01, 1.0];
/// Factor by which a correction has to reduce the creep of sticking samples, and by which the slip penalty grows
/// otherwise.
const STIFFER: f64 = 4.0;
/// Clearance of surfaces in contact, in voxels: of points, and of edges, or of points where there are no edges; the
/// latter is below the smallest gap that points keep. So edges carry no load where surfaces lie flat on each other, as
/// the sides of mismatched squares cross everywhere.
const CLEARANCE: [f64; 2] = [2e-4, 1e-4];
/// Searches of all samples at the start of an equilibrium iteration; after a correction there is one.
const LOOKS: u32 = 2;
/// Slide of a sample beyond the edge of the triangle that it faces before it searches again, in affine coordinates.
const STRAYED: f64 = 0.5;
/// Tolerance of gaps below the clearance at the end, in voxels: surfaces in contact do not intersect.
const DEEPEST: f64 = 0.9e-4;
/// Tolerances, in voxels, of the gap of pressed samples and of the creep of sticking ones. Surfaces of different voxels
/// do not fit each other to the last point, where multipliers converge slowly.
const APART: f64 = 1e-3;
const CREEP: f64 = 1e-4;
/// Tolerance of friction bounds, relative to the largest one of a vertex: at first, and after [`PATIENCE`] corrections,
/// as long as the sum of the bounds on each pair of surfaces keeps the first one.
const BOUND: [f64; 2] = [3e-3, 0.05];
/// Tolerance of the friction of samples that have lost contact, relative to all bounds: it ends when a state is accepted.
const LOST: f64 = 1e-5;
/// Fraction of its bound from which friction counts as slipping: bounds of light pressures are right to a few percent.
const NEARLY: f64 = 0.95;
/// Corrections at one load factor after which samples keep the faces that they meet, and the tolerance of bounds is
/// wider.
const PATIENCE: u32 = 10;
/// Corrections after which only the default precision is asked for.
const PRECISE: u32 = 36;
/// Relative rounding of motions and directions.
const ROUNDING: f64 = 1e-9;

/// Surfaces in contact, their friction and bonds.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// Coefficient of friction of each surface with each, symmetric; NaN where they pass through each other.
    pub friction: Vec<Vec<f64>>,
    /// Bonds between surfaces.
    pub bonds: Vec<Bond>,
    /// Voxel size in m.
    pub voxel: f64,
    /// Young's modulus of the bodies in contact, or its order of magnitude, Pa.
    pub young: f64,
}

/// Contact of surfaces.
#[derive(Debug, Clone)]
pub struct SurfaceContact {
    description: Description,
    samples: Vec<Sample>,
    /// Smallest area from which the penalty of a sample of each surface is computed, m².
    least_area: Vec<f64>,
    /// Points of all surfaces.
    points: Vec<Carried>,
    /// Number of surfaces that belong to bodies, which come first.
    bodies: u32,
    /// Vertices that stand for each point of bodies, if they are not the vertices that carry it.
    shares: Vec<Carried>,
    /// Positions of the points in the unloaded design, m.
    rest_points: Vec<Vec3>,
    /// Normals there.
    rest_normals: Normals,
    /// Axes across planes of symmetry through the origin.
    planes: [bool; 3],
    /// Part of each sample that counts with planes of symmetry: 0 on the negative sides, which are images.
    weights: Vec<f64>,
    /// Point of which each is an image with planes of symmetry, itself if it counts.
    twins: Vec<u32>,
    /// Axes along which vertices never move; empty if nothing touches in the unloaded design.
    still: Vec<[bool; 3]>,
    /// True for samples within their clearance in the unloaded design; empty where `still` is.
    touching: Vec<bool>,
    /// True if a surface may rub itself.
    rubs_itself: bool,
    /// Triangles of all surfaces, of these points.
    triangles: Vec<[u32; 3]>,
    /// Surface of each triangle.
    surface_of: Vec<u32>,
    /// Triangles at each point.
    around: Vec<Vec<u32>>,
    /// Ties of each sample, with the surface at their other end.
    ties_at: Vec<Vec<(u32, u32)>>,
    /// Contact penalty in units of Young's modulus over the voxel size, which live contact changes.
    penalty: f64,
    /// Contact laws of pairs of surfaces.
    laws: Laws,
    state: ContactState,
}

/// Contact pair: a sample and the triangle or edge that it faces.
#[derive(Debug, Clone, Copy)]
struct ContactPair {
    sample: u32,
    triangle: u32,
    /// Place on an edge, as a part of the way between its ends; 0 for a point.
    along: f64,
    /// Barycentric coordinates of the closest point.
    weights: [f64; 3],
    gap: f64,
    /// Contact normal, from the triangle to the sample.
    normal: Vec3,
    facing: Facing,
}

impl ContactPair {
    /// Gap and normal of a sample with these ends and the triangle with these corners that it faces; `None` for edges
    /// that have become parallel.
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

    /// Place where the contact force acts.
    fn spot(&self) -> Spot {
        Spot {
            sample: self.sample,
            along: self.along,
            triangle: self.triangle,
            weights: self.weights,
        }
    }
}

/// Places of a sample and of a triangle between which a force acts.
#[derive(Debug, Clone, Copy)]
struct Spot {
    sample: u32,
    /// Place on an edge, see [`ContactPair::along`].
    along: f64,
    triangle: u32,
    /// Affine coordinates in the triangle.
    weights: [f64; 3],
}

/// Linear interpolation between two places.
fn between([start, end]: [Vec3; 2], along: f64) -> Vec3 {
    let mut place = start;
    axpy(&mut place, along, sub(end, start));
    place
}

impl SurfaceContact {
    /// Sets up contact for a problem with the vertices `rest` (m).
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
            let own = sample::samples(surface, number, first, rest);
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
        // Points first, so that sample numbers equal point numbers.
        samples.extend(sample::edges(&triangles, &surface_of));
        let mut contact = Self {
            description,
            samples,
            least_area,
            points,
            bodies: 1,
            shares: Vec::new(),
            rest_points,
            rest_normals: Normals::default(),
            planes: [false; 3],
            weights: Vec::new(),
            twins: Vec::new(),
            still: Vec::new(),
            touching: Vec::new(),
            rubs_itself: false,
            triangles,
            surface_of,
            around,
            ties_at: Vec::new(),
            penalty: PENALTY,
            laws: Laws::default(),
            state: ContactState::default(),
        };
        contact.rest_normals = contact.normals(&contact.rest_points);
        contact.ties_at = contact.ties_at(&first_sample, contact.points.len());
        contact.rubs_itself = contact.may_rub_itself();
        Contact::reset(&mut contact, rest);
        Ok(contact)
    }

    /// Sets the number of surfaces that belong to bodies, which come first, and the vertices that stand for their
    /// points in fields over vertices, with positive weights: the vertices that carry a smooth surface lie partly
    /// inside, and have weights of both signs.
    #[must_use]
    pub fn with_bodies(mut self, bodies: u32, shares: Vec<Carried>) -> Self {
        self.bodies = bodies;
        self.shares = shares;
        self
    }

    /// Sets the axes along which vertices, at `rest` in the unloaded design, never move, such as those of a clamp
    /// without a motion.
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

    /// Fraction of the clearance that a contact pair keeps. A pair within the clearance in the unloaded design keeps
    /// the fraction of its carrying vertices that can open the gap: a half between a vertex that never moves and one
    /// that does, 0 if none moves. Others keep all of it.
    fn mobility(&self, meeting: &ContactPair) -> f64 {
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

    /// Tests whether there is edge-to-edge contact.
    fn has_edges(&self) -> bool {
        self.samples.len() > self.points.len()
    }

    /// Removes edge-to-edge contact: only points are kept out of surfaces.
    pub(super) fn without_edges(mut self, rest: &[Vec3]) -> Self {
        self.samples.truncate(self.points.len());
        Contact::reset(&mut self, rest);
        self
    }

    /// Raises the slip penalty to its largest, that of contact: the tangent at an equilibrium then has friction that
    /// sticks as firmly as surfaces keep apart, as small vibrations need. Forces there hardly change, for creep is
    /// within its tolerance.
    pub fn stick_firmly(&mut self) {
        self.state.stick = STICK[1];
    }

    /// Surfaces in contact, their friction and bonds.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Vertices that stand for a point, as points are numbered over all surfaces.
    fn share(&self, point: u32) -> &Carried {
        let point = point as usize;
        self.shares.get(point).unwrap_or(&self.points[point])
    }

    /// Changes the state by a function of the surfaces and the state.
    fn change<T>(&mut self, act: impl FnOnce(&Self, &mut ContactState) -> T) -> T {
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

    /// Coefficient of friction between a sample and a triangle.
    fn coefficient(&self, sample: u32, triangle: u32) -> f64 {
        let of = self.samples[sample as usize].surface as usize;
        let with = self.surface_of[triangle as usize] as usize;
        self.description.friction[of][with]
    }

    /// Contact penalty of a sample, N/m; half of that of its area, because both sides have samples.
    fn penalty(&self, sample: u32) -> f64 {
        let per_area = self.penalty * self.description.young / self.description.voxel;
        per_area * self.stiff_area(sample) / 2.0
    }

    /// Area from which the penalty of a sample is computed, m².
    fn stiff_area(&self, sample: u32) -> f64 {
        let weight = self.weight(sample);
        let sample = &self.samples[sample as usize];
        weight * sample.area.max(self.least_area[sample.surface as usize])
    }

    /// Clearance of a sample, m.
    fn clearance(&self, sample: u32) -> f64 {
        let leaves_to_edges = sample < self.points.len() as u32 && self.has_edges();
        CLEARANCE[usize::from(!leaves_to_edges)] * self.description.voxel
    }

    fn ends(&self, sample: u32, points: &[Vec3]) -> [Vec3; 2] {
        self.samples[sample as usize]
            .ends
            .map(|p| points[p as usize])
    }

    /// Place at a part of the way along a sample.
    fn place(&self, sample: u32, along: f64, points: &[Vec3]) -> Vec3 {
        between(self.ends(sample, points), along)
    }

    /// Contact pair of a sample and the triangle that it faces; `None` for edges that have become parallel.
    fn meeting(&self, sample: u32, facing: Facing, points: &[Vec3]) -> Option<ContactPair> {
        let corners = self.corners(facing.triangle(), points);
        ContactPair::new(sample, facing, self.ends(sample, points), corners)
    }

    /// Points that a spot moves with, each with its factor in the relative motion: those of the sample, one or two, and
    /// the corners of the triangle.
    fn relative(&self, spot: Spot) -> impl Iterator<Item = (f64, u32)> {
        let sample = &self.samples[spot.sample as usize];
        let own = sample.ends.into_iter().zip([1.0 - spot.along, spot.along]);
        let own = own.take(1 + usize::from(sample.is_edge()));
        let corners = self.triangles[spot.triangle as usize].into_iter();
        let other = corners.zip(spot.weights.map(|weight| -weight));
        own.chain(other).map(|(point, factor)| (factor, point))
    }

    /// Adds the force on the sample at a spot, and its reaction on the triangle.
    fn add_force(&self, force: Vec3, spot: Spot, forces: &mut [Vec3]) {
        for (factor, point) in self.relative(spot) {
            self.points[point as usize].add_force(factor, force, forces);
        }
    }
}

#[cfg(test)]
mod tests;
