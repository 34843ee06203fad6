//! Options of linear solutions.

use crate::linear::error::FactorError;

/// Solver of the linear systems of Newton's method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinearSolver {
    /// Choice by the number of vertices: direct if that is quicker.
    Auto,
    /// Sparse direct factorization.
    Direct,
    /// Conjugate gradients with a multigrid preconditioner, if the body is made of equal voxels and its loads have a
    /// potential; otherwise direct.
    Iterative,
}

/// Solver and memory limit of linear systems.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearOptions {
    pub solver: LinearSolver,
    /// Limit in bytes.
    pub memory: u64,
}

impl LinearOptions {
    /// Checks a memory estimate against the limit.
    pub fn allow(self, bytes: u64) -> Result<(), FactorError> {
        if bytes <= self.memory {
            Ok(())
        } else {
            Err(FactorError::Memory(bytes))
        }
    }
}
