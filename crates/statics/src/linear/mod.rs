//! Linear systems of Newton's method: the tangent on free coordinates, factorized or solved iteratively.

pub(crate) mod direct;
pub(crate) mod error;
mod iterative;
mod low_rank_update;
mod multigrid;
pub(crate) mod options;
mod ordering;
mod rank;
mod row_pattern;
pub(crate) mod system;
pub(crate) mod vectors;
