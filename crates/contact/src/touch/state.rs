//! What contact remembers between evaluations.

use std::collections::BTreeSet;

use voxsoft_solid::vector::Vec3;

use super::bonds::Hold;
use super::recording::Recording;

/// What a sample carries along a load path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Memory {
    /// The multiplier of its gap, a force in N that pushes apart.
    pub normal: f64,
    /// That of its slip in N, along the surface.
    pub friction: Vec3,
    /// The normal of the surface that it slips on, of the last correction.
    pub plane: Vec3,
    /// The most that friction may be, in N.
    pub bound: f64,
    /// Where on the other surface it sticks: a triangle, and affine coordinates in it.
    pub anchor: Option<(u32, [f64; 3])>,
    /// Which place of an edge sticks there, as a part of the way between its ends.
    pub along: f64,
    /// The part of its step that was left when it came into contact there.
    pub since: f64,
}

/// What a sample faces, fixed for some steps of Newton's method, so that what it minimizes has no kinks where a
/// sample slides over an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Facing {
    /// The plane of a triangle.
    Plane(u32),
    /// A point on an edge or corner of a triangle, with its barycentric coordinates, and the normal there.
    Edge(u32, [f64; 3], Vec3),
    /// An edge of a triangle, that from the given corner to the next, and whether the normal is the cross product of
    /// the two edges, that of the sample first, or its opposite.
    Across(u32, usize, bool),
}

impl Facing {
    pub fn triangle(self) -> u32 {
        match self {
            Self::Plane(triangle) | Self::Edge(triangle, ..) | Self::Across(triangle, ..) => {
                triangle
            }
        }
    }
}

/// The state of all samples.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct State {
    /// The points of all surfaces at the last accepted state, m.
    pub accepted_points: Vec<Vec3>,
    /// What samples faced there.
    pub accepted_facing: Vec<Option<Facing>>,
    /// What they carried.
    pub accepted: Vec<Memory>,
    /// What they carried at the accepted state before that.
    pub before: Vec<Memory>,
    /// By how many steps what they carry now goes on, while nothing has corrected it.
    pub extrapolated: Option<f64>,
    /// What they carry now.
    pub now: Vec<Memory>,
    /// What ties carried at the last accepted state, and what they carry now.
    pub accepted_holds: Vec<Hold>,
    pub holds: Vec<Hold>,
    /// The points when candidates were listed last.
    pub listed_points: Vec<Vec3>,
    /// Whether they were those of the accepted state then.
    pub listed_at_rest: bool,
    /// For each sample the triangles that it may meet on the way from the last accepted state.
    pub candidates: Vec<Vec<u32>>,
    /// What each of them faces now.
    pub facing: Vec<Option<Facing>>,
    /// The penalty of slip, relative to that of gaps.
    pub stick: f64,
    /// How far what sticks had crept at the last correction, as a part of what it may.
    pub crept: f64,
    /// Corrections since the last accepted state.
    pub corrections: u32,
    /// How often all samples may still look for what they face before that is fixed.
    pub looks: u32,
    /// Samples and triangles whose stiffness there is room for.
    pub pattern: BTreeSet<(u32, u32)>,
    /// Whether that has become less, and nobody has been told.
    pub pattern_shrank: bool,
    /// Whether a path is gone over again, for which the stiffness has to be exact.
    pub retraces: bool,
    /// That part for each sample which comes into contact, while a path is gone over again: where a sample was just apart it
    /// changes steeply, and soon no more.
    pub given_since: Vec<f64>,
    /// The path so far, where derivatives will ask for it.
    pub recording: Option<Recording>,
}
