//! Iterative solver of the lagged tangent of large bodies.
//!
//! Conjugate gradients with a multigrid V-cycle, stopped early: a move has to lower the potential, and later moves find
//! the rest. Inertia helps little: in a step of a frame's length waves of shear run across twenty voxels and more, so that
//! coarse levels matter nearly as much as at rest.

use voxsoft_solid::assembly::Elements;
use voxsoft_solid::vector::Vec3;

use super::inverse::{Change, Inverse, Visit};
use crate::linear::error::FactorError;
use crate::linear::iterative::{IterativeFactor, IterativeSystem};

/// Relative error of a solution in the norm of the preconditioner: 0.01 takes 1.8 times the iterations and as many moves,
/// 0.2 an eighth more moves, each with an evaluation of all voxels that costs as much as five iterations.
const TOLERANCE: f64 = 0.1;
/// Polls, one in five iterations, after which a solution ends with its present error.
const MOST_POLLS: u32 = 10;
/// Elements that are added to the matrix at a time, on all threads.
const BATCH: usize = 512;
/// Assembly of the tangent and its coarser levels, in units of a move: 180 ms for 38 with 12,167 vertices.
const FACTOR_COST: f64 = 5.0;

/// Assembled tangent with its preconditioner.
pub(super) struct Preconditioned {
    system: IterativeSystem,
    factor: Option<IterativeFactor>,
    /// Diagonal of the stiffness `K` in N/m.
    stiffness: Vec<f64>,
    /// Diagonal `D` (N/m) of the last factor, and the present one.
    diagonal: Vec<f64>,
    present: Vec<f64>,
}

impl Preconditioned {
    pub fn new(system: IterativeSystem) -> Self {
        Self {
            stiffness: Vec::new(),
            diagonal: Vec::new(),
            present: Vec::new(),
            factor: None,
            system,
        }
    }

    fn set(&mut self, diagonal: &[f64]) {
        let pairs = self.stiffness.iter().zip(diagonal);
        let sum: Vec<f64> = pairs.map(|(own, more)| own + more).collect();
        self.system.set_diagonal(&sum);
    }
}

impl Inverse for Preconditioned {
    fn size(&self) -> usize {
        self.system.size()
    }

    fn row_of(&self, vertex: usize, axis: usize) -> Option<usize> {
        self.system.row_of(vertex, axis)
    }

    fn gather(&self, vectors: &[Vec3]) -> Vec<f64> {
        self.system.gather(vectors)
    }

    fn spread(&self, free: &[f64]) -> Vec<Vec3> {
        self.system.spread(free)
    }

    fn assemble(&mut self, visit: Visit<'_>) {
        self.factor = None;
        self.system.assemble_batches(|add| {
            let mut batch = Batch::default();
            visit(&mut |vertices, matrix| {
                batch.push(vertices, matrix, add);
            });
            batch.pass_on(add);
        });
        self.stiffness = self.system.diagonal();
    }

    fn factorize(&mut self, diagonal: &[f64]) -> Result<bool, FactorError> {
        self.set(diagonal);
        self.diagonal = diagonal.to_vec();
        self.present = diagonal.to_vec();
        // An indefinite tangent shows itself on the way, and its solution still leads down.
        self.factor = Some(self.system.factor(true)?);
        Ok(true)
    }

    fn is_factorized(&self) -> bool {
        self.factor.is_some()
    }

    fn patch(&mut self, changes: &[Change]) -> bool {
        let mut diagonal = self.diagonal.clone();
        for change in changes {
            diagonal[change.row] += change.by;
        }
        if diagonal == self.present {
            return true;
        }
        self.set(&diagonal);
        self.present = diagonal;
        self.factor = self.system.factor(true).ok();
        self.factor.is_some()
    }

    fn solve(&self, side: &mut [f64]) {
        let Some(factor) = &self.factor else {
            return;
        };
        let mut polls = 0;
        let mut stop = || {
            polls += 1;
            polls > MOST_POLLS
        };
        // The solution is a direction of descent however it ends.
        let _ = self.system.solve(factor, side, TOLERANCE, &mut stop);
    }

    fn factor_cost(&self) -> f64 {
        FACTOR_COST
    }
}

/// Element matrices of one width that wait to be added together.
#[derive(Default)]
struct Batch {
    width: usize,
    vertices: Vec<u32>,
    matrices: Vec<f64>,
}

impl Batch {
    fn push(&mut self, vertices: &[u32], matrix: &[f64], add: &mut dyn FnMut(Elements<'_>)) {
        if vertices.len() != self.width || self.vertices.len() >= BATCH * self.width {
            self.pass_on(add);
            self.width = vertices.len();
        }
        self.vertices.extend_from_slice(vertices);
        self.matrices.extend_from_slice(matrix);
    }

    fn pass_on(&mut self, add: &mut dyn FnMut(Elements<'_>)) {
        if !self.vertices.is_empty() {
            add(Elements {
                width: self.width,
                vertices: &self.vertices,
                matrices: &self.matrices,
            });
        }
        self.vertices.clear();
        self.matrices.clear();
    }
}
