//! Geometric multigrid for the tangents of voxel bodies too large for a direct factor.

mod blocks;
mod cells;
mod coarsest;
mod color;
mod hierarchy;
mod kernels;
mod parallel;
mod values;

pub(crate) use blocks::{BlockMatrix, Columns, RowsPart, columns_of};
pub(crate) use cells::{Cell, cells_of};
pub(crate) use color::{Coloring, color};
pub(crate) use hierarchy::Hierarchy;
#[cfg(test)]
pub(crate) use kernels::BLOCK;
pub(crate) use kernels::vectorized;
#[cfg(test)]
pub(crate) use parallel::for_each_chunk;
pub(crate) use parallel::{for_each, for_each_large, sum};
pub(crate) use values::Block;
