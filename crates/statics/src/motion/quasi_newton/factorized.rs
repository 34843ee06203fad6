//! Direct solver of the lagged tangent.
//!
//! A few entries of the diagonal that have changed since the factor was made are corrected exactly (Sherman, Morrison
//! and Woodbury): `(A + E Δ Eᵀ)⁻¹ = A⁻¹ − C (Δ⁻¹ + Eᵀ C)⁻¹ Cᵀ` with `C = A⁻¹ E`.

use voxsoft_solid::vector::Vec3;

use super::inverse::{Change, Inverse, Visit};
use crate::linear::direct::{DirectFactor, DirectSystem};
use crate::linear::error::FactorError;

/// Changed entries of the diagonal beyond which a new factor is cheaper: each costs a solution.
const MOST_PATCHES: usize = 24;

/// Changed entry of the diagonal.
struct Patch {
    row: usize,
    change: f64,
    /// Solution `A⁻¹ e`.
    column: Vec<f64>,
}

/// Sparse Cholesky factor with its patches.
pub(super) struct Factorized {
    system: DirectSystem,
    factor: Option<DirectFactor>,
    patches: Vec<Patch>,
}

impl Factorized {
    pub fn new(system: DirectSystem) -> Self {
        Self {
            system,
            factor: None,
            patches: Vec::new(),
        }
    }
}

impl Inverse for Factorized {
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
        self.system.assemble_pieces(None, &mut [], visit);
        self.factor = None;
    }

    fn factorize(&mut self, diagonal: &[f64]) -> Result<bool, FactorError> {
        self.patches.clear();
        match self.system.factor_lifted(diagonal) {
            Ok(factor) => self.factor = Some(factor),
            Err(FactorError::NotPositive) => return Ok(false),
            Err(error) => return Err(error),
        }
        Ok(true)
    }

    fn is_factorized(&self) -> bool {
        self.factor.is_some()
    }

    fn patch(&mut self, changes: &[Change]) -> bool {
        if changes.len() > MOST_PATCHES {
            return false;
        }
        let Some(factor) = &self.factor else {
            return false;
        };
        let mut known = std::mem::take(&mut self.patches);
        for &Change { row, by } in changes {
            let column = match known.iter().position(|patch| patch.row == row) {
                Some(place) => known.swap_remove(place).column,
                None => {
                    let mut column = vec![0.0; self.system.size()];
                    column[row] = 1.0;
                    self.system.solve(factor, &mut column, false);
                    column
                }
            };
            self.patches.push(Patch {
                row,
                change: by,
                column,
            });
        }
        true
    }

    fn solve(&self, side: &mut [f64]) {
        let Some(factor) = &self.factor else {
            return;
        };
        self.system.solve(factor, side, false);
        let count = self.patches.len();
        if count == 0 {
            return;
        }
        let mut matrix = vec![vec![0.0; count]; count];
        let mut right: Vec<f64> = self.patches.iter().map(|p| side[p.row]).collect();
        for (i, patch) in self.patches.iter().enumerate() {
            for (j, other) in self.patches.iter().enumerate() {
                matrix[i][j] = other.column[patch.row];
            }
            matrix[i][i] += 1.0 / patch.change;
        }
        eliminate(&mut matrix, &mut right);
        for (patch, part) in self.patches.iter().zip(right) {
            for (x, c) in side.iter_mut().zip(&patch.column) {
                *x -= part * c;
            }
        }
    }

    /// Both go through all entries of the factor, its making once for each row of an entry's column.
    fn factor_cost(&self) -> f64 {
        (self.system.factor_entries() as f64 / self.system.size() as f64 / 16.0).max(4.0)
    }
}

/// Solves a small dense system in place, with partial pivoting.
fn eliminate(matrix: &mut [Vec<f64>], right: &mut [f64]) {
    let count = right.len();
    for k in 0..count {
        let size = |i: &usize| matrix[*i][k].abs();
        let pivot = (k..count).max_by(|a, b| size(a).total_cmp(&size(b)));
        let pivot = pivot.unwrap_or(k);
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        for i in k + 1..count {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..count {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / matrix[k][k];
    }
}
