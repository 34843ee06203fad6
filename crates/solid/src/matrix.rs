//! Operations on 3×3 matrices; row-major.

use crate::vector::Vec3;

/// A 3×3 matrix, `m[row][column]`.
pub type Mat3 = [[f64; 3]; 3];

/// The unit matrix.
pub const IDENTITY: Mat3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// `A B`.
#[inline(always)]
pub fn multiply(a: &Mat3, b: &Mat3) -> Mat3 {
    let mut product = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    product
}

/// `Aᵀ`.
#[inline(always)]
pub fn transpose(a: &Mat3) -> Mat3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// `A + s B`.
#[inline(always)]
pub fn plus(a: &Mat3, s: f64, b: &Mat3) -> Mat3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + s * b[i][j]))
}

/// `a bᵀ`.
#[inline(always)]
pub fn outer(a: Vec3, b: Vec3) -> Mat3 {
    a.map(|x| b.map(|y| x * y))
}

/// `A x`.
#[inline(always)]
pub fn apply(a: &Mat3, x: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2])
}

/// `Aᵀ x`.
#[inline(always)]
pub fn apply_transposed(a: &Mat3, x: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[0][i] * x[0] + a[1][i] * x[1] + a[2][i] * x[2])
}

/// The determinant.
#[inline(always)]
pub fn determinant(a: &Mat3) -> f64 {
    a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1])
        - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
        + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
}

/// The matrix of cofactors, the derivative of the determinant.
#[inline(always)]
pub fn cofactors(a: &Mat3) -> Mat3 {
    let minor = |i: usize, j: usize| {
        let (r, s, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        a[r][c] * a[s][d] - a[r][d] * a[s][c]
    };
    std::array::from_fn(|i| std::array::from_fn(|j| minor(i, j)))
}

/// The matrix of `x ↦ a × x`.
#[inline(always)]
pub fn cross_matrix(a: Vec3) -> Mat3 {
    [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]]
}

/// The vector `v` with `[v]× = A − Aᵀ`.
#[inline(always)]
pub fn axial(a: &Mat3) -> Vec3 {
    [a[2][1] - a[1][2], a[0][2] - a[2][0], a[1][0] - a[0][1]]
}

/// Eigenvalues and eigenvectors (columns) of a symmetric matrix, by Jacobi rotations.
///
/// Rotations are accurate to rounding also for equal eigenvalues, and the vectors always form a
/// rotation or reflection to machine precision.
pub fn symmetric_eigen(a: &Mat3) -> (Vec3, Mat3) {
    let mut a = *a;
    let mut vectors = IDENTITY;
    for _ in 0..MAX_SWEEPS {
        let off = a[0][1].powi(2) + a[0][2].powi(2) + a[1][2].powi(2);
        let size = a[0][0].powi(2) + a[1][1].powi(2) + a[2][2].powi(2);
        if off <= f64::EPSILON * f64::EPSILON * 1e-4 * size {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate_away(&mut a, &mut vectors, p, q);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], vectors)
}

/// Jacobi converges quadratically: 3×3 matrices take four to six sweeps.
const MAX_SWEEPS: usize = 12;

#[inline(always)]
fn rotate_away(a: &mut Mat3, vectors: &mut Mat3, p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let r = 3 - p - q;
    let (apq, apr, aqr) = (a[p][q], a[p][r], a[q][r]);
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    a[p][r] = c * apr - s * aqr;
    a[r][p] = a[p][r];
    a[q][r] = s * apr + c * aqr;
    a[r][q] = a[q][r];
    for row in vectors.iter_mut() {
        let (vp, vq) = (row[p], row[q]);
        row[p] = c * vp - s * vq;
        row[q] = s * vp + c * vq;
    }
}

/// The polar decomposition `F = R S` with a proper rotation `R` and a symmetric `S`, which has one
/// negative eigenvalue, the smallest in size, if `F` is inside out.
///
/// `F V = U diag(λ)` with `V` the eigenvectors of `FᵀF`; the columns of `U` for the two largest
/// stretches are `F v` made orthonormal, the third is their cross product. A body pressed flat keeps
/// a well-defined rotation as long as two stretches are left; pressed to a line or a point it gets
/// one of the possible rotations.
pub fn polar(f: &Mat3) -> (Mat3, Mat3) {
    let (squares, mut v) = symmetric_eigen(&multiply(&transpose(f), f));
    let mut order = [0, 1, 2];
    order.sort_unstable_by(|&i, &j| squares[j].total_cmp(&squares[i]));
    v = std::array::from_fn(|row| std::array::from_fn(|k| v[row][order[k]]));
    if determinant(&v) < 0.0 {
        for row in &mut v {
            row[2] = -row[2];
        }
    }
    let column = |k: usize| [v[0][k], v[1][k], v[2][k]];
    let first = unit_or(apply(f, column(0)), [1.0, 0.0, 0.0]);
    let along = apply(f, column(1));
    let overlap = crate::vector::dot(first, along);
    let across = std::array::from_fn(|i| along[i] - overlap * first[i]);
    let second = unit_or(across, any_normal(first));
    let third = crate::vector::cross(first, second);
    let rotation: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| first[i] * v[j][0] + second[i] * v[j][1] + third[i] * v[j][2])
    });
    let stretch = multiply(&transpose(&rotation), f);
    let symmetric =
        std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (stretch[i][j] + stretch[j][i])));
    (rotation, symmetric)
}

fn unit_or(a: Vec3, otherwise: Vec3) -> Vec3 {
    let length = crate::vector::norm(a);
    if length > f64::MIN_POSITIVE.sqrt() {
        crate::vector::scale(1.0 / length, a)
    } else {
        otherwise
    }
}

fn any_normal(a: Vec3) -> Vec3 {
    let axis = if a[0].abs() < 0.6 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    unit_or(crate::vector::cross(a, axis), [0.0, 0.0, 1.0])
}

/// The solution of `A x = b` for a symmetric positive definite `A`; a matrix that is nearly singular
/// is lifted by a small part of its trace, so that the answer stays finite.
#[inline(always)]
pub fn solve_spd(a: &Mat3, b: Vec3) -> Vec3 {
    let trace = a[0][0] + a[1][1] + a[2][2];
    let lifted = if determinant(a).abs() > 1e-12 * trace.powi(3).abs() {
        *a
    } else {
        plus(a, 1e-4 * trace.abs() + f64::MIN_POSITIVE, &IDENTITY)
    };
    let adjugate = cofactors(&lifted);
    let inverse = 1.0 / determinant(&lifted);
    crate::vector::scale(inverse, apply_transposed(&adjugate, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix() -> impl Strategy<Value = Mat3> {
        prop::array::uniform3(prop::array::uniform3(-2.0..2.0))
    }

    fn distance(a: &Mat3, b: &Mat3) -> f64 {
        a.as_flattened()
            .iter()
            .zip(b.as_flattened())
            .map(|(x, y)| (x - y).abs())
            .fold(0.0, f64::max)
    }

    proptest! {
        #[test]
        fn polar_gives_a_rotation_and_a_symmetric_stretch(f in matrix()) {
            let (r, s) = polar(&f);
            prop_assert!(distance(&multiply(&transpose(&r), &r), &IDENTITY) < 1e-13);
            prop_assert!((determinant(&r) - 1.0).abs() < 1e-13);
            // Squaring F doubles the digits that a near-singular F loses.
            prop_assert!(distance(&multiply(&r, &s), &f) < 1e-7);
        }

        #[test]
        fn eigenvectors_rebuild_the_matrix(f in matrix()) {
            let a = multiply(&transpose(&f), &f);
            let (values, v) = symmetric_eigen(&a);
            let scaled: Mat3 = std::array::from_fn(|i| std::array::from_fn(|k| v[i][k] * values[k]));
            prop_assert!(distance(&multiply(&scaled, &transpose(&v)), &a) < 1e-13 * 12.0);
        }
    }

    #[test]
    fn polar_of_singular_gradients_is_a_rotation() {
        for f in [[[0.0; 3]; 3], [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]] {
            let (r, s) = polar(&f);
            assert!((determinant(&r) - 1.0).abs() < 1e-13);
            assert!(distance(&multiply(&r, &s), &f) < 1e-13);
        }
    }
}
