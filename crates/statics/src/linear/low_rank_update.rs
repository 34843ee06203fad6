//! Tangent with dense coupling of the whole wall of a chamber, whose pressure depends on its volume: `K + G C Gᵀ` with
//! a column of `G` for each chamber.
//!
//! The sum is dense, but solved with the factor of `K` alone (Woodbury's formula):
//!
//! ```text
//! (K + G C Gᵀ)⁻¹ s = y − W (1 + C H)⁻¹ C Gᵀ y,   y = K⁻¹ s,   W = K⁻¹ G,   H = Gᵀ W.
//! ```
//!
//! Past the limit of a balloon `K` is indefinite, and the sum is positive definite if the amount of gas holds the
//! balloon. With `C = L Lᵀ` of the rank `r`, as many eigenvalues of the sum are negative as of `K` and of `−1 − Lᵀ H L`
//! together, less `r` (Haynsworth 1968, doi 10.1016/0024-3795(68)90050-5).

use voxsoft_solid::fluid::{Coupling, solve_small};
use voxsoft_solid::vector::Vec3;

use crate::linear::error::FactorError;
use crate::linear::vectors::product;

/// Relative size of the pivots of `C` below which they are rounding.
const ROUNDING: f64 = 1e-12;

/// Matrices `G` and `C` on free coordinates.
pub(crate) struct LowRankUpdate {
    gradients: Vec<Vec<f64>>,
    stiffness: Vec<f64>,
}

/// Solutions `W`, and those with the transposed tangent.
pub(crate) struct UpdateSolutions {
    own: Vec<Vec<f64>>,
    transposed: Vec<Vec<f64>>,
}

impl LowRankUpdate {
    pub fn new(coupling: Coupling, gather: &dyn Fn(&[Vec3]) -> Vec<f64>) -> Self {
        Self {
            gradients: coupling
                .gradients
                .iter()
                .map(|field| gather(field))
                .collect(),
            stiffness: coupling.stiffness,
        }
    }

    /// Solves for `W` by `solve`, which takes a right-hand side and a flag for the transposed tangent.
    pub fn answers(&self, solve: &dyn Fn(&mut [f64], bool)) -> UpdateSolutions {
        let all = |transposed: bool| {
            let mut answers = self.gradients.clone();
            answers.iter_mut().for_each(|side| solve(side, transposed));
            answers
        };
        UpdateSolutions {
            own: all(false),
            transposed: all(true),
        }
    }

    /// Corrects a solution with the tangent alone into one with the sum.
    pub fn correct(
        &self,
        answers: &UpdateSolutions,
        solution: &mut [f64],
        transposed: bool,
    ) -> Result<(), FactorError> {
        let n = self.gradients.len();
        let answers = if transposed {
            &answers.transposed
        } else {
            &answers.own
        };
        let entry = |row: usize, column: usize| {
            if transposed {
                self.stiffness[column * n + row]
            } else {
                self.stiffness[row * n + column]
            }
        };
        let times = |values: &[f64]| -> Vec<f64> {
            let row = |row: usize| (0..n).map(|k| entry(row, k) * values[k]).sum();
            (0..n).map(row).collect()
        };
        let along = |field: &[f64]| -> Vec<f64> {
            self.gradients.iter().map(|g| product(g, field)).collect()
        };
        let columns: Vec<Vec<f64>> = answers.iter().map(|w| times(&along(w))).collect();
        let mut matrix = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..n {
                matrix[row * n + column] =
                    columns[column][row] + f64::from(u8::from(row == column));
            }
        }
        let mut sides = [times(&along(solution))];
        if !solve_small(&mut matrix, &mut sides, n) {
            return Err(FactorError::Singular);
        }
        for (answer, size) in answers.iter().zip(&sides[0]) {
            solution
                .iter_mut()
                .zip(answer)
                .for_each(|(x, w)| *x -= size * w);
        }
        Ok(())
    }

    /// Tests whether the sum is positive definite, given the number of negative eigenvalues of the tangent alone; both
    /// are symmetric.
    pub fn is_positive_with(&self, answers: &UpdateSolutions, negative: usize) -> bool {
        let roots = self.roots();
        let n = self.gradients.len();
        let flexibility: Vec<Vec<f64>> = (self.gradients.iter())
            .map(|g| answers.own.iter().map(|w| product(g, w)).collect())
            .collect();
        let mut matrix = vec![vec![0.0; roots.len()]; roots.len()];
        for (row, a) in roots.iter().enumerate() {
            for (column, b) in roots.iter().enumerate() {
                let mut sum = f64::from(u8::from(row == column));
                for i in 0..n {
                    sum += a[i] * product(&flexibility[i], b);
                }
                matrix[row][column] = sum;
            }
        }
        // The matrix −M has as many negative eigenvalues as M has positive ones.
        let positive = positive_pivots(matrix);
        negative + positive == roots.len()
    }

    /// Columns of `G L`, whose outer products sum up to `G C Gᵀ`, which is symmetric.
    pub fn columns(&self) -> Vec<Vec<f64>> {
        let column = |root: &Vec<f64>| {
            let mut sum = vec![0.0; self.gradients[0].len()];
            for (part, gradient) in root.iter().zip(&self.gradients) {
                sum.iter_mut()
                    .zip(gradient)
                    .for_each(|(x, g)| *x += part * g);
            }
            sum
        };
        self.roots().iter().map(column).collect()
    }

    /// Columns of `L`: a Cholesky factor with the largest pivots first.
    fn roots(&self) -> Vec<Vec<f64>> {
        let n = self.gradients.len();
        let mut left = self.stiffness.clone();
        let least = ROUNDING * left.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let mut roots = Vec::new();
        while roots.len() < n {
            let best = (0..n).max_by(|&a, &b| left[a * (n + 1)].total_cmp(&left[b * (n + 1)]));
            let Some(best) = best.filter(|&best| left[best * (n + 1)] > least) else {
                break;
            };
            let pivot = left[best * (n + 1)].sqrt();
            let root: Vec<f64> = (0..n).map(|row| left[row * n + best] / pivot).collect();
            for row in 0..n {
                for column in 0..n {
                    left[row * n + column] -= root[row] * root[column];
                }
            }
            roots.push(root);
        }
        roots
    }
}

/// Number of positive eigenvalues of a symmetric matrix: that of positive pivots of an elimination.
fn positive_pivots(mut matrix: Vec<Vec<f64>>) -> usize {
    let n = matrix.len();
    for column in 0..n {
        for row in column + 1..n {
            let part = matrix[row][column] / matrix[column][column];
            let pivot = matrix[column].clone();
            matrix[row]
                .iter_mut()
                .zip(pivot)
                .for_each(|(x, p)| *x -= part * p);
        }
    }
    (0..n).filter(|&row| matrix[row][row] > 0.0).count()
}
