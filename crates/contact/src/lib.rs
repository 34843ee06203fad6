//! Where a body passes through itself: an exact test of its surface, and how deep.
//!
//! Two places of a body overlap if their material would have to be at one place. The surface tells: triangles of it
//! then pass through each other, or a whole piece of it lies in other material. Which triangles do is decided by
//! predicates without rounding ([`robust`]), so that bodies which touch, to the last bit, do not overlap, and bodies
//! that overlap by the last bit do.
//!
//! # Depth
//!
//! A vertex of the surface in foreign material is as deep as it is far from the surface of *that* material: the
//! distance to the nearest face that it sees through it. The depth of an overlap is the largest one of its vertices, and
//! of the middles of the stretches of edges that lie in foreign material.
//!
//! ```
//! use voxsoft_contact::{Body, penetration};
//!
//! // Two tetrahedra; the tip of the second is in the first, 0.1 m from three of its faces.
//! let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let other = corner.map(|[x, y, z]| [x + 0.1, y + 0.1, z - 0.9]);
//! let positions = [corner, other].concat();
//! let faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
//! let triangles = [faces, faces.map(|face| face.map(|v| v + 4))].concat();
//! let body = Body {
//!     rest: &positions,
//!     positions: &positions,
//!     tets: &[[0, 1, 2, 3], [4, 5, 6, 7]],
//!     triangles: &triangles,
//!     membranes: &[],
//! };
//! let found = penetration(&body);
//! assert_eq!(found.overlaps.len(), 1);
//! assert!((found.overlaps[0].depth - 0.1).abs() < 1e-12);
//! ```
#![forbid(unsafe_code)]

mod bounds;
mod crossings;
mod expansion;
mod groups;
mod incidence;
mod material;
mod overlaps;
mod predicates;
mod shells;
pub mod skin;
mod tetrahedra;
mod threads;
pub mod touch;
mod tree;
mod triangles;
mod union;
mod vectors;

use std::borrow::Cow;

pub use predicates::Point;

/// A deformed body. All indices are of `positions`.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Vertices of the unloaded body [m].
    pub rest: &'a [Point],
    /// The same vertices now [m]; finite.
    pub positions: &'a [Point],
    /// Tetrahedra, of positive volume in the unloaded body.
    pub tets: &'a [[i32; 4]],
    /// Their boundary, outward.
    pub triangles: &'a [[i32; 3]],
    /// Triangles of membranes without volume, which nothing may pass through either.
    pub membranes: &'a [[i32; 3]],
}

/// Where a body overlaps itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Penetration {
    /// Triangles that pass through each other, ascending; those of the membranes are numbered on from the surface's.
    pub pairs: Vec<[u32; 2]>,
    /// The places where they do, the deepest first.
    pub overlaps: Vec<Overlap>,
    /// Vertices of the surface in foreign material.
    pub covered: Vec<Covered>,
}

/// One place where a component overlaps itself or another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// How deep [m]; for membranes, how far an edge reaches through at least.
    pub depth: f64,
    /// The deepest point now [m].
    pub now: Point,
    /// The two points of the unloaded body that are there [m]: of the surface, and of what it is in.
    pub rest: [Point; 2],
    /// The tetrahedra of both; -1 where a membrane has none.
    pub tets: [i32; 2],
    /// Whether there is no overlap but a surface turned inside out, at tetrahedra that are.
    pub inverted: bool,
}

/// A vertex of the surface in foreign material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Covered {
    /// The vertex.
    pub vertex: i32,
    /// The tetrahedron that it is in.
    pub tet: i32,
    /// The overlap, as they are listed.
    pub overlap: u32,
}

/// Finds where a body overlaps itself. The answer has the same bits for any number of threads.
///
/// # Panics
///
/// If an index has no vertex.
pub fn penetration(body: &Body<'_>) -> Penetration {
    let all: Cow<'_, [[i32; 3]]> = if body.membranes.is_empty() {
        body.triangles.into()
    } else {
        [body.triangles, body.membranes].concat().into()
    };
    let surface = body.triangles.len();
    let crossings = crossings::Crossings::of(body.positions, &all, surface, body.tets);
    if crossings.pairs.is_empty() && crossings.swallowed.is_empty() {
        return Penetration::default();
    }
    let (overlaps, covered) = overlaps::overlaps(body, &all, &crossings);
    Penetration {
        pairs: crossings.pairs,
        overlaps,
        covered,
    }
}
