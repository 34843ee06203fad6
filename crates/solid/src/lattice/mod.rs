//! Bodies of the lattice material on a regular grid: its constants, cubes of tetrahedra, the order of constraints, and
//! their rows for the lanes of the processor.

pub(crate) mod color;
pub(crate) mod cube;
pub mod lanes;
pub(crate) mod material;
pub mod strips;
