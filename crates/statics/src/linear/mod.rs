//! Linear systems of Newton's method: the tangent on free coordinates, factorized or solved iteratively.

pub(crate) mod backend;
#[cfg(test)]
mod bandwidth;
pub mod conformance;
pub(crate) mod conjugate_gradients;
pub(crate) mod direct;
pub(crate) mod error;
pub(crate) mod iterative;
#[cfg(test)]
mod laden;
pub(crate) mod lattice_product;
mod low_rank_update;
mod multigrid;
mod objects;
pub(crate) mod operator;
pub(crate) mod options;
mod ordering;
mod rank;
mod row_pattern;
mod scatter;
mod sparse_cholesky;
pub(crate) mod stiffness;
pub(crate) mod system;
#[cfg(test)]
pub(crate) mod trials;
pub(crate) mod vectors;
