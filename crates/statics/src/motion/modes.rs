//! Natural frequencies and modes of small vibrations about an equilibrium: `K φ = ω² M φ`.
//!
//! Subspace iteration (Bathe and Wilson 1972, doi 10.1016/0045-7949(73)90040-6): `Y = K⁻¹ M X`, and the small
//! eigenproblem `Yᵀ K Y a = ω² Yᵀ M Y a` in its span, whose first matrix is `Yᵀ M X`. A mode converges in each step by
//! the ratio of its `ω²` and that of the first one left out of the subspace.

use faer::linalg::solvers::Llt;
use faer::{Mat, Side};
use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use crate::sensitivity::adjoint::{AdjointError, with_tangent};

/// Relative change of `ω²` in a step at which a mode has converged.
const CONVERGED: f64 = 1e-9;
/// Most steps; ten suffice for well-separated frequencies.
const MOST_STEPS: usize = 200;
/// Relative tolerance of iterative solutions.
const TOLERANCE: f64 = 1e-11;

/// Natural mode of vibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Square of the angular frequency in 1/s².
    pub square: f64,
    /// Mode shape on the vertices, normalized to `φᵀ M φ = 1`, so that it is in kg^-1/2.
    pub shape: Vec<Vec3>,
}

/// Computes the `count` slowest modes about an equilibrium under all loads, the slowest first. The tangent may take
/// `memory` bytes; `stop` is polled between the steps of the work.
pub fn modes(
    problem: &Problem,
    positions: &[Vec3],
    count: usize,
    memory: u64,
    stop: &mut dyn FnMut() -> bool,
) -> Result<Vec<Mode>, AdjointError> {
    let mut equilibrium = with_tangent(problem, positions, memory)?;
    let system = &mut equilibrium.system;
    let size = system.size();
    let factor = system.factor_positive(0.0)?;
    let lumped: Vec<Vec3> = problem.body().masses().iter().map(|&m| [m; 3]).collect();
    let masses = system.gather(&lumped);
    let count = count.min(size);
    let width = (2 * count).min(count + 8).min(size);
    let mut basis = first_vectors(size, width);
    let mut squares = vec![f64::INFINITY; width];
    for _ in 0..MOST_STEPS {
        if stop() {
            return Err(AdjointError::Cancelled);
        }
        let loads = scaled_rows(&basis, &masses);
        let mut answers = loads.clone();
        for column in 0..width {
            let side = answers.col_as_slice_mut(column);
            system.solve(&factor, side, false, TOLERANCE, stop)?;
        }
        let stiffness = answers.transpose() * &loads;
        let mass = answers.transpose() * scaled_rows(&answers, &masses);
        let (found, turn) = small_problem(&stiffness, &mass)?;
        basis = &answers * turn;
        let change = |index: usize| (found[index] - squares[index]).abs() / found[index].abs();
        let converged = (0..count).all(|index| change(index) < CONVERGED);
        squares = found;
        if converged {
            return Ok((0..count)
                .map(|index| Mode {
                    square: squares[index],
                    shape: system.spread(basis.col_as_slice(index)),
                })
                .collect());
        }
    }
    Err(AdjointError::Unsettled)
}

/// Start vectors that no mode is orthogonal to, the same each time: a linear congruential generator (Knuth's).
fn first_vectors(size: usize, width: usize) -> Mat<f64> {
    let mut state = 1_u64;
    Mat::from_fn(size, width, |_, _| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    })
}

fn scaled_rows(matrix: &Mat<f64>, factors: &[f64]) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        factors[row] * matrix[(row, column)]
    })
}

/// Eigenvalues of `A a = λ B a`, rising, and the vectors with `aᵀ B a = 1`: with `B = L Lᵀ` those of `L⁻¹ A L⁻ᵀ`.
fn small_problem(a: &Mat<f64>, b: &Mat<f64>) -> Result<(Vec<f64>, Mat<f64>), AdjointError> {
    let lower = Llt::new(b.as_ref(), Side::Lower).map_err(|_| AdjointError::Singular)?;
    let lower = lower.L().to_owned();
    let mut half = a.clone();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        lower.as_ref(),
        half.as_mut(),
        faer::Par::Seq,
    );
    let mut whole = half.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        lower.as_ref(),
        whole.as_mut(),
        faer::Par::Seq,
    );
    let found = whole
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| AdjointError::Singular)?;
    let mut vectors = found.U().to_owned();
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(
        lower.transpose(),
        vectors.as_mut(),
        faer::Par::Seq,
    );
    let values = found.S().column_vector().iter().copied().collect();
    Ok((values, vectors))
}
