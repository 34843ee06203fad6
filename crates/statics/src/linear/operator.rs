//! Seams of iterative solutions: a linear operator and a preconditioner for it.
//!
//! Conjugate gradients ([`crate::conjugate_gradients`]) see nothing else of a tangent, so that another way to multiply
//! with it or to precondition it (a graphics card, another code) implements these two traits and leaves the rest alone.
//!
//! # Vectors
//!
//! A vector has three coordinates for each row, x, y and z of one vertex, in an order of the rows that the operator
//! chooses; `as_flattened` gives its `3 · rows` numbers one after the other. Held coordinates are part of a vector: the
//! rows and the columns of the operator are zero there, and so is its diagonal, which is positive on every free
//! coordinate of a positive definite operator. For a tangent, moves are in m, forces in N, and the operator is in N/m.

use voxsoft_solid::vector::{Vec3, axpy, dot};

use super::multigrid::{for_each, sum};

/// Symmetric linear operator on vectors of three coordinates for each row.
///
/// [`crate::conformance::check_operator`] checks these contracts for every operator.
pub trait LinearOperator: Sync {
    /// Name of the operator.
    fn name(&self) -> &'static str;

    /// Number of rows: the length of its vectors.
    fn rows(&self) -> usize;

    /// Computes `y = A x`, forces in N of moves in m; both of the length [`LinearOperator::rows`]. Numbers of `x` on
    /// held coordinates have no influence; those of `y` are zero there, and its former ones are overwritten.
    ///
    /// Any number of threads gives the same bits.
    fn apply(&self, x: &[Vec3], y: &mut [Vec3]);

    /// Diagonal in N/m, of the length [`LinearOperator::rows`]: zero on held coordinates.
    fn diagonal(&self) -> Vec<Vec3>;
}

/// Approximate inverse of a linear operator, symmetric and positive definite on free coordinates.
///
/// [`crate::conformance::check_preconditioner`] checks these contracts for every preconditioner.
pub trait Preconditioner {
    /// Name of the preconditioner.
    fn name(&self) -> &'static str;

    /// Approximates `answer = A⁻¹ residual`, moves in m for forces in N; both of the length of the operator's rows. The
    /// answer is zero on held coordinates, where the residual is zero too; its former numbers are overwritten.
    ///
    /// It may use buffers of its own, but gives the same bits for the same residual, on any number of threads. Single
    /// precision is enough.
    fn apply(&mut self, residual: &[Vec3], answer: &mut [Vec3]);
}

/// Sum of an operator and of outer products of vectors, each with a factor: `A + Σ f v ⊗ v`.
pub struct RankUpdated<'a> {
    /// Operator `A`.
    pub base: &'a dyn LinearOperator,
    /// Vectors `v`, zero on held coordinates, and their factors `f`.
    pub terms: Vec<(&'a [Vec3], f64)>,
}

impl LinearOperator for RankUpdated<'_> {
    fn name(&self) -> &'static str {
        "an operator with outer products"
    }

    fn rows(&self) -> usize {
        self.base.rows()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        self.base.apply(x, y);
        for (vector, factor) in &self.terms {
            let along = factor * sum(x.len(), |row| dot(vector[row], x[row]));
            for_each(y, |row, y| axpy(y, along, vector[row]));
        }
    }

    fn diagonal(&self) -> Vec<Vec3> {
        let mut diagonal = self.base.diagonal();
        for (vector, factor) in &self.terms {
            for (own, v) in diagonal.iter_mut().zip(*vector) {
                for axis in 0..3 {
                    own[axis] += factor * v[axis] * v[axis];
                }
            }
        }
        diagonal
    }
}

/// Inverse of the diagonal of an operator: the preconditioner with which a new operator can begin.
pub struct Jacobi {
    /// Reciprocal diagonal in m/N, zero on held coordinates.
    reciprocals: Vec<Vec3>,
}

impl Jacobi {
    /// Preconditioner for an operator, from its diagonal.
    pub fn new(operator: &dyn LinearOperator) -> Self {
        let reciprocal = |entry: f64| if entry > 0.0 { 1.0 / entry } else { 0.0 };
        let mut reciprocals = operator.diagonal();
        for row in &mut reciprocals {
            *row = row.map(reciprocal);
        }
        Self { reciprocals }
    }
}

impl Preconditioner for Jacobi {
    fn name(&self) -> &'static str {
        "Jacobi"
    }

    fn apply(&mut self, residual: &[Vec3], answer: &mut [Vec3]) {
        for_each(answer, |row, answer| {
            let (own, side) = (self.reciprocals[row], residual[row]);
            *answer = std::array::from_fn(|axis| own[axis] * side[axis]);
        });
    }
}
