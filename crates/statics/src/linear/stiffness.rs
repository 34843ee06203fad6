//! Assembled tangent of a voxel body, to look at and to solve with: the matrix and the solver of a Newton iteration.

use std::sync::atomic::{AtomicUsize, Ordering};

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use super::conjugate_gradients::{End, Equation, conjugate_gradients};
use super::iterative::IterativeSystem;
use super::multigrid::Block;
use super::operator::LinearOperator;
use super::options::{LARGE, LinearOptions, LinearSolver};
use crate::sensitivity::adjoint::AdjointError;

/// Tangent of a problem under its whole load, assembled for conjugate gradients.
pub struct Stiffness {
    system: IterativeSystem,
    preconditioned: bool,
}

/// Sparse matrix of 3 × 3 blocks by vertices, in N/m; rows and columns of held coordinates are zero.
pub struct BlockRows {
    /// First block of each vertex, and the number of blocks.
    pub starts: Vec<usize>,
    /// Vertex of each block, rising in a row.
    pub columns: Vec<u32>,
    /// Blocks, row-major.
    pub blocks: Vec<[f64; 9]>,
}

/// Solution of a linear system.
pub struct LinearSolution {
    /// Displacements of the vertices in m, zero where held.
    pub displacements: Vec<Vec3>,
    /// Iterations of conjugate gradients.
    pub iterations: usize,
}

impl Stiffness {
    /// Assembles the tangent at `positions` (m); `None` if the body is not made of equal voxels or the tangent is not
    /// symmetric, so that the iterative solver does not apply. `memory` is a limit in bytes.
    pub fn new(
        problem: &Problem,
        positions: &[Vec3],
        memory: u64,
    ) -> Result<Option<Self>, AdjointError> {
        let options = LinearOptions {
            solver: LinearSolver::Iterative,
            memory,
        };
        let Some(make) = options.solver.backend(positions.len(), LARGE) else {
            return Ok(None);
        };
        let Some(mut system) = IterativeSystem::new(problem, problem.held(), options, make)? else {
            return Ok(None);
        };
        let mut unused = vec![0.0; system.size()];
        system.assemble(problem, positions, &|_| 1.0, None, None, &mut unused);
        Ok(Some(Self {
            system,
            preconditioned: false,
        }))
    }

    /// The assembled matrix.
    pub fn block_rows(&mut self) -> BlockRows {
        self.preconditioned &= !self.system.turn_back();
        let (matrix, places) = (self.system.parts().0, self.system.places());
        let mut vertex_of = vec![0u32; places.len()];
        for (vertex, &place) in places.iter().enumerate() {
            vertex_of[place as usize] = vertex as u32;
        }
        let mut rows = BlockRows {
            starts: vec![0],
            columns: Vec::with_capacity(matrix.blocks()),
            blocks: Vec::with_capacity(matrix.blocks()),
        };
        let mut row: Vec<(u32, Block)> = Vec::new();
        for &place in places {
            row.clear();
            let entries = matrix.row(place as usize);
            row.extend(entries.map(|(column, block)| (vertex_of[column as usize], block)));
            row.sort_unstable_by_key(|&(vertex, _)| vertex);
            for &(vertex, block) in &row {
                rows.columns.push(vertex);
                rows.blocks.push(block);
            }
            rows.starts.push(rows.columns.len());
        }
        rows
    }

    /// Derives the preconditioner from the assembled matrix: once, before the first solution.
    pub fn precondition(&mut self) -> Result<(), AdjointError> {
        self.system.factor(false)?;
        self.preconditioned = true;
        Ok(())
    }

    /// Displacements under `forces` (N) on the vertices, by conjugate gradients up to the relative error `tolerance` in
    /// the norm of the preconditioner; `stop` is polled now and then.
    pub fn solve(
        &mut self,
        forces: &[Vec3],
        tolerance: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<LinearSolution, AdjointError> {
        if !self.preconditioned {
            self.precondition()?;
        }
        let system = &self.system;
        let side = system.by_rows(&system.gather(forces));
        let (matrix, backend) = system.parts();
        let operator = Counted {
            base: &*backend.operator(matrix),
            products: AtomicUsize::new(0),
        };
        let equation = Equation {
            operator: &operator,
            side: &side,
            guess: None,
        };
        let mut preconditioner = backend.preconditioner(matrix);
        let (answer, end) =
            conjugate_gradients(&equation, &mut *preconditioner, tolerance, false, stop);
        match end {
            End::Converged | End::NegativeCurvature => {}
            End::Stalled => return Err(AdjointError::Unsettled),
            End::Cancelled => return Err(AdjointError::Cancelled),
        }
        Ok(LinearSolution {
            displacements: system.by_vertices(answer),
            iterations: operator.products.into_inner(),
        })
    }
}

/// Operator that counts its products: one in each iteration.
struct Counted<'a> {
    base: &'a dyn LinearOperator,
    products: AtomicUsize,
}

impl LinearOperator for Counted<'_> {
    fn name(&self) -> &'static str {
        self.base.name()
    }

    fn rows(&self) -> usize {
        self.base.rows()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        self.products.fetch_add(1, Ordering::Relaxed);
        self.base.apply(x, y);
    }

    fn diagonal(&self) -> Vec<Vec3> {
        self.base.diagonal()
    }
}
