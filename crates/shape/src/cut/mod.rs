//! Cells that a surface cuts: how full they are, where their material and its surface lie, and the voids in them.
//!
//! A cell is divided into small cubes ([`CUBES`] along each edge). In each a shape is taken as the plane with its value
//! at the center and its mean slopes between the centers of opposite faces.
mod closed_voids;
mod facets;
mod fill;
mod measures;
mod plane;
mod regions;

pub use closed_voids::{CellState, closed_voids};
pub use facets::{FacetSums, Neighbors, POWERS};
pub use fill::{Filled, fill};
pub use measures::{Measures, integrals, measures, unit};
pub use plane::below_plane;
pub use regions::{REACH, WINDOW, nearest_region};

/// Small cubes along each edge of a cell. Any number of them meets a plane exactly; the plane at a sphere of radius R
/// lies w²/(12 R) too far out, w the edge of a small cube: its neglected curvature.
pub const CUBES: usize = 4;

/// Small cubes of a cell, in C order.
pub const ALL: usize = CUBES * CUBES * CUBES;

/// Steps between neighbors among the small cubes of a cell.
const STEPS: [usize; 3] = [CUBES * CUBES, CUBES, 1];

/// Place of a small cube along each axis.
fn place(cube: usize) -> [usize; 3] {
    [
        cube / STEPS[0],
        cube / STEPS[1] % CUBES,
        cube / STEPS[2] % CUBES,
    ]
}
