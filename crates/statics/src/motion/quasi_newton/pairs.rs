//! Limited-memory BFGS update: corrects the tangent since its factorization by the last steps (Liu, Bouaziz and Kavan
//! 2017, doi 10.1145/2990496).

use std::collections::VecDeque;

/// Smallest fraction of the expected curvature (Powell 1978, doi 10.1007/BFb0067703).
const LEAST_CURVATURE: f64 = 0.2;
/// Most pairs in memory.
const MEMORY: usize = 6;

/// Move with the change of the gradient along it.
struct Pair {
    step: Vec<f64>,
    change: Vec<f64>,
    inverse: f64,
}

/// Pairs of the last moves.
#[derive(Default)]
pub(super) struct QuasiNewtonMemory {
    pairs: VecDeque<Pair>,
}

impl QuasiNewtonMemory {
    /// Removes all pairs, after the tangent was factorized anew.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Stores a move and the change of the gradient along it, if they have a curvature that is positive and not much
    /// less than `expected`: if contact was lost on the way, a pair would have no stiffness.
    pub fn note(&mut self, step: Vec<f64>, change: Vec<f64>, expected: f64) {
        let along = product(&step, &change);
        let least = 1e-10 * product(&step, &step).sqrt() * product(&change, &change).sqrt();
        if along > least.max(LEAST_CURVATURE * expected) {
            if self.pairs.len() == MEMORY {
                self.pairs.pop_front();
            }
            let inverse = 1.0 / along;
            self.pairs.push_back(Pair {
                step,
                change,
                inverse,
            });
        }
    }

    /// Approximate inverse Hessian times a vector, where `apply` multiplies by that of the factor.
    pub fn direction(&self, mut side: Vec<f64>, apply: impl FnOnce(&mut Vec<f64>)) -> Vec<f64> {
        let mut parts = Vec::with_capacity(self.pairs.len());
        for pair in self.pairs.iter().rev() {
            let part = pair.inverse * product(&pair.step, &side);
            add_scaled(&mut side, -part, &pair.change);
            parts.push(part);
        }
        apply(&mut side);
        for (pair, part) in self.pairs.iter().zip(parts.iter().rev()) {
            let other = pair.inverse * product(&pair.change, &side);
            add_scaled(&mut side, part - other, &pair.step);
        }
        side
    }
}

/// Scalar product.
pub(super) fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn add_scaled(a: &mut [f64], factor: f64, b: &[f64]) {
    for (x, y) in a.iter_mut().zip(b) {
        *x += factor * y;
    }
}
