//! The limited-memory BFGS update: what the last steps have shown of the change of the tangent since it was
//! factorized (Liu, Bouaziz and Kavan 2017, doi 10.1145/2990496).

use std::collections::VecDeque;

/// The least part of the curvature that was expected (Powell 1978, doi 10.1007/BFb0067703).
const LEAST_CURVATURE: f64 = 0.2;
/// Pairs that are kept.
const MEMORY: usize = 6;

/// A move with the change of the gradient along it.
struct Pair {
    step: Vec<f64>,
    change: Vec<f64>,
    inverse: f64,
}

/// The pairs of the last moves.
#[derive(Default)]
pub(super) struct Memory {
    pairs: VecDeque<Pair>,
}

impl Memory {
    /// Forgets all pairs, as the tangent was factorized anew.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Notes a move and the change of the gradient along it, if that shows a curvature that is positive and not much less
    /// than was `expected`: where contact was lost on the way, a pair would promise that nothing resists.
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

    /// About the inverse Hessian times a vector, where `apply` multiplies by that of the factor.
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

/// The scalar product.
pub(super) fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn add_scaled(a: &mut [f64], factor: f64, b: &[f64]) {
    for (x, y) in a.iter_mut().zip(b) {
        *x += factor * y;
    }
}
