//! Contract of a back end of iterative solutions.

use super::multigrid::{BlockMatrix, Cell, Coloring};
use super::operator::{LinearOperator, Preconditioner};

/// Arithmetic of iterative solutions of one body: products with its assembled tangent, and a preconditioner.
///
/// The tangent is assembled by [`crate::linear::iterative`], whose matrix is handed to every call; a back end keeps only
/// numbers that it derives from it, such as coarser matrices or a copy on another device. `crate::linear::options` names
/// all back ends.
pub(crate) trait Backend: Send + Sync {
    /// Takes the numbers of a newly assembled tangent; later calls are for the matrix that was taken last.
    fn take(&mut self, matrix: &BlockMatrix);

    /// Product with the tangent.
    fn operator<'a>(&'a self, matrix: &'a BlockMatrix) -> Box<dyn LinearOperator + 'a>;

    /// Preconditioner of the tangent, with buffers of its own.
    fn preconditioner<'a>(&'a self, matrix: &'a BlockMatrix) -> Box<dyn Preconditioner + 'a>;
}

/// Makes the back end for a body: from its voxels, whose nodes are numbered like the rows of the matrix; the rows of
/// rigid objects, which are few and no nodes of voxels; the pattern of the matrix; and the coloring that its rows are
/// sorted by, so that no two rows of one color share an entry.
pub(crate) type MakeBackend = fn(Vec<Cell>, &[u32], &BlockMatrix, Coloring) -> Box<dyn Backend>;
