//! Self-intersection of a body: an exact test of its surface, and the depth of each overlap.
//!
//! Two places of a body overlap if their material would have to be at one place. The surface shows it: triangles of it
//! then intersect, or a whole shell of it lies in other material. Intersecting triangles are found by predicates
//! without rounding ([`robust`]), so that bodies which touch, to the last bit, do not overlap, and bodies that overlap
//! by the last bit do.
//!
//! # Depth
//!
//! The depth of a surface vertex in foreign material is its distance from the surface of *that* material: the distance
//! to the nearest face reached from it through the material. The depth of an overlap is the largest one of its
//! vertices, and of the midpoints of the edge segments that lie in foreign material.
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
mod gap;
mod groups;
mod incidence;
mod material;
mod overlaps;
mod predicates;
mod shells;
pub mod skin;
pub mod surface;
pub mod surface_contact;
mod tetrahedra;
mod threads;
mod tree;
mod triangles;
mod union;
mod vectors;

use std::borrow::Cow;

pub use predicates::Point;

/// A deformed body. All indices are of `positions`.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Vertices of the unloaded body (m).
    pub rest: &'a [Point],
    /// Vertices of the deformed body (m); finite.
    pub positions: &'a [Point],
    /// Tetrahedra, of positive volume in the unloaded body.
    pub tets: &'a [[i32; 4]],
    /// Boundary triangles of the tetrahedra, outward.
    pub triangles: &'a [[i32; 3]],
    /// Triangles of membranes without volume, which nothing may pass through either.
    pub membranes: &'a [[i32; 3]],
}

/// Overlaps of a body with itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Penetration {
    /// Pairs of triangles that intersect, ascending; triangles of membranes are numbered after those of the surface.
    pub pairs: Vec<[u32; 2]>,
    /// Overlaps, the deepest first.
    pub overlaps: Vec<Overlap>,
    /// Vertices of the surface in foreign material.
    pub covered: Vec<Covered>,
}

/// One overlap of a component with itself or another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Depth (m); for membranes, a lower bound of the distance by which an edge reaches through.
    pub depth: f64,
    /// Deepest point of the deformed body (m).
    pub now: Point,
    /// The two material points there, in the unloaded body (m): one on the surface, one in the material that it
    /// penetrates.
    pub rest: [Point; 2],
    /// Tetrahedra of both points; -1 where a membrane has none.
    pub tets: [i32; 2],
    /// True if this is no overlap but a surface turned inside out, at inverted tetrahedra.
    pub inverted: bool,
}

/// A vertex of the surface in foreign material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Covered {
    /// Vertex number.
    pub vertex: i32,
    /// Tetrahedron that contains the vertex.
    pub tet: i32,
    /// Number of the overlap in [`Penetration::overlaps`].
    pub overlap: u32,
}

/// Finds the overlaps of a body with itself. The result has the same bits for any number of threads.
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
