//! Options of linear solutions, and the choice of their back end.

use crate::linear::backend::{Backend, MakeBackend};
use crate::linear::error::FactorError;
use crate::linear::multigrid::{BlockMatrix, Cell, Coloring, Hierarchy};

/// Number of vertices from which an equilibrium is solved iteratively: measured with `benchmarks/statics.py`.
pub(crate) const LARGE: usize = 4_000;
/// Number beside free rigid objects, whose contact takes more iterations of conjugate gradients: pads of 11,700
/// vertices that grip a bar took 1.2 times the processor time of a factor, which grows with the power 4/3 to 2 of their
/// number (`benchmarks/contact_price.py`).
pub(crate) const LARGE_WITH_OBJECTS: usize = 25_000;

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

impl LinearSolver {
    /// All solvers by the names that callers give.
    pub const NAMES: &[(&str, Self)] = &[
        ("auto", Self::Auto),
        ("direct", Self::Direct),
        ("iterative", Self::Iterative),
    ];

    /// Solver of a name.
    pub fn named(name: &str) -> Option<Self> {
        let mut names = Self::NAMES.iter();
        names.find(|own| own.0 == name).map(|own| own.1)
    }

    /// Back end of conjugate gradients for a body with a number of vertices, of which `large` are enough; `None` for a
    /// direct factor. Back ends are named here and nowhere else.
    pub(crate) fn backend(self, vertices: usize, large: usize) -> Option<MakeBackend> {
        match self {
            Self::Direct => None,
            Self::Auto if vertices < large => None,
            Self::Auto | Self::Iterative => Some(multigrid),
        }
    }
}

/// Assembled matrix and V-cycle on the threads of the processor.
fn multigrid(
    cells: Vec<Cell>,
    objects: &[u32],
    matrix: &BlockMatrix,
    coloring: Coloring,
) -> Box<dyn Backend> {
    Box::new(Hierarchy::new(cells, objects.to_vec(), matrix, coloring))
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
