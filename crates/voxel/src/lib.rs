//! Voxel grids of soft-robot parts, and the tetrahedral meshes made of them.
//!
//! A [`Grid`] is a box of cubic cells, each empty or of one part. It gives the regions that matter to a designer
//! ([`components()`], [`cavities()`], [`leaks()`], [`hinges()`], [`wall_thickness`]) and the conforming mesh that the
//! solvers use ([`tet_mesh()`]).
//!
//! # Conventions
//!
//! - SI units and `f64` positions; cell `(i, j, k)` of the array fills
//!   `origin + μ [i, i+1] × [j, j+1] × [k, k+1]`, its last index runs fastest (C order).
//! - The *lattice* is the infinite grid that contains the box. A grid stores its position on it
//!   ([`Grid::lattice_offset`]), so that padding and cropping change neither positions nor meshes.
//! - *Contact* is through a face unless another [`Contact`] is given.
//! - Tetrahedra have positive volume, boundary triangles point out of the material.
//!
//! # A tour
//!
//! ```
//! use voxsoft_voxel::{Grid, cavities, tet_mesh};
//!
//! let mm = 1e-3;
//! let mut grid = Grid::empty([5, 5, 5], [0.0; 3], 5.0 * mm, u64::MAX)?;
//! grid.fill_box([0.0; 3], [25.0 * mm; 3], 1);
//! grid.set([2, 2, 2], 0);
//!
//! let chambers = cavities(&grid);
//! assert_eq!(chambers.len(), 1);
//! assert!((chambers[0].volume - (5.0 * mm).powi(3)).abs() < 1e-18);
//!
//! let mesh = tet_mesh(&grid, u64::MAX)?;
//! assert_eq!(mesh.tets.len(), 5 * 124);
//! assert_eq!(mesh.cavities[0].triangles.len(), 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod bits;
mod cavities;
mod combine;
mod components;
mod edges;
mod fill;
mod five_tets;
mod from_tets;
mod grid;
mod hinges;
mod leaks;
mod nodes;
mod pieces;
mod planes;
mod quality;
mod runs;
mod shells;
mod stitch;
mod tet_mesh;
mod thickness;
mod topology;
mod unstitched;
mod vectors;
mod voxel_lists;

pub use cavities::{Cavity, cavities};
pub use combine::CombineError;
pub use components::{CellRun, Component, Contact, components};
pub use from_tets::{FromTetsError, mesh_from_tets};
pub use grid::{Grid, GridError, MAX_CELLS_PER_AXIS};
pub use hinges::{Hinge, hinges};
pub use leaks::{Leak, leaks};
pub use pieces::pieces;
pub use quality::{Quality, quality};
pub use stitch::{StitchError, mesh_bytes, tet_mesh, tet_mesh_until};
pub use tet_mesh::{CavitySurface, TetMesh};
pub use thickness::{Wall, WallThickness, cavity_walls, wall_thickness};
pub use unstitched::{Unstitched, unstitched};
