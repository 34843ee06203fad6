//! Preconditioned conjugate gradients on any operator.

use voxsoft_solid::vector::{Vec3, axpy, dot};

use super::multigrid::{for_each, sum};
use super::operator::{LinearOperator, Preconditioner};

/// Iterations after which a solution counts as stalled.
const MAX_ITERATIONS: usize = 400;
/// Relative error that is still of use to Newton's method.
const USEFUL: f64 = 0.1;
/// Iterations between two polls of `stop`.
const LOOK: usize = 5;

/// Linear system `A x = side`.
pub struct Equation<'a> {
    /// Operator `A`.
    pub operator: &'a dyn LinearOperator,
    /// Right-hand side in N, zero on held coordinates.
    pub side: &'a [Vec3],
    /// Initial guess of the solution in m.
    pub guess: Option<&'a [Vec3]>,
}

/// End of an iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The relative error is below the tolerance, or still of use to Newton's method after the last iteration.
    Converged,
    /// Direction along which the operator is not positive; the solution is the one before.
    NegativeCurvature,
    /// The iterations ran out.
    Stalled,
    /// The caller asked to stop.
    Cancelled,
}

/// Solves by conjugate gradients; returns the solution in m and how it ended.
///
/// It stops at the relative error `tolerance` in the norm of the preconditioner: residual forces would hardly measure
/// soft bending modes, which carry most of a slender body's displacement. Where the operator turns out not to be
/// positive definite and the solution must be a descent direction (`downhill`), it ends with the current iterate
/// (Steihaug 1983, doi 10.1137/0720042). Otherwise it continues, which nearly always works for the few negative
/// eigenvalues of a tangent far from equilibrium. It polls `stop` now and then.
pub fn conjugate_gradients(
    equation: &Equation<'_>,
    preconditioner: &mut dyn Preconditioner,
    tolerance: f64,
    downhill: bool,
    stop: &mut dyn FnMut() -> bool,
) -> (Vec<Vec3>, End) {
    let operator = equation.operator;
    let count = operator.rows();
    let mut residual = equation.side.to_vec();
    let inner = |a: &[Vec3], b: &[Vec3]| sum(count, |row| dot(a[row], b[row]));
    let mut answer = vec![[0.0; 3]; count];
    let mut image = vec![[0.0; 3]; count];
    let mut fresh = vec![[0.0; 3]; count];
    preconditioner.apply(&residual, &mut fresh);
    let goal = tolerance * tolerance * inner(&residual, &fresh);
    if let Some(guess) = equation.guess {
        answer.copy_from_slice(guess);
        operator.apply(&answer, &mut image);
        for_each(&mut residual, |row, r| axpy(r, -1.0, image[row]));
        preconditioner.apply(&residual, &mut fresh);
    }
    let mut direction = fresh.clone();
    let mut gain = inner(&residual, &direction);
    if gain == 0.0 || gain.abs() < goal {
        return (answer, End::Converged);
    }
    for iteration in 0..MAX_ITERATIONS {
        if iteration % LOOK == 0 && stop() {
            return (answer, End::Cancelled);
        }
        operator.apply(&direction, &mut image);
        let curvature = inner(&direction, &image);
        let positive = curvature > 0.0 && gain > 0.0;
        let lost = !(curvature.abs() > 0.0 && gain.is_finite());
        if lost || (downhill && !positive) {
            if iteration == 0 {
                answer = direction;
            }
            return (answer, End::NegativeCurvature);
        }
        let step = gain / curvature;
        for_each(&mut answer, |row, x| axpy(x, step, direction[row]));
        for_each(&mut residual, |row, r| axpy(r, -step, image[row]));
        preconditioner.apply(&residual, &mut fresh);
        let next = inner(&residual, &fresh);
        if next.abs() <= goal {
            return (answer, End::Converged);
        }
        let keep = next / gain;
        gain = next;
        for_each(&mut direction, |row, d| {
            for axis in 0..3 {
                d[axis] = keep * d[axis] + fresh[row][axis];
            }
        });
    }
    let useful = gain.abs() * tolerance * tolerance <= USEFUL * USEFUL * goal;
    (answer, if useful { End::Converged } else { End::Stalled })
}
