//! Sparse Cholesky factors of symmetric matrices that are numbered in the order of elimination, on one thread: the same
//! input gives the same bits.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use crate::linear::error::FactorError;

/// Finds the pattern of the factor of a matrix with this pattern, both triangles.
pub(crate) fn analyze(
    pattern: SymbolicSparseColMatRef<'_, usize>,
) -> Result<SymbolicCholesky<usize>, FactorError> {
    // `SymmetricOrdering::Identity` would require one triangle only; a permutation makes faer select it.
    let size = pattern.nrows();
    let identity: Vec<usize> = (0..size).collect();
    factorize_symbolic_cholesky(
        pattern,
        Side::Lower,
        SymmetricOrdering::Custom(PermRef::new_checked(&identity, &identity, size)),
        // Dense blocks pay off for voxels even where faer would go column by column: a third less time for a
        // beam of 80.
        CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        },
    )
    .map_err(|_| FactorError::Memory(0))
}

/// Entries of the factor, if the matrix is positive definite.
pub(crate) fn factorize(
    symbolic: &SymbolicCholesky<usize>,
    matrix: SparseColMatRef<'_, usize, f64>,
) -> Result<Vec<f64>, FactorError> {
    let mut entries = vec![0.0; symbolic.len_val()];
    let par = Par::Seq;
    let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(par, Default::default());
    let mut buffer = MemBuffer::try_new(scratch).map_err(|_| FactorError::Memory(0))?;
    symbolic
        .factorize_numeric_llt::<f64>(
            &mut entries,
            matrix,
            Side::Lower,
            LltRegularization::default(),
            par,
            MemStack::new(&mut buffer),
            Default::default(),
        )
        .map_err(|_| FactorError::NotPositive)?;
    Ok(entries)
}

/// Solves in place with the entries of a factor.
pub(crate) fn solve(symbolic: &SymbolicCholesky<usize>, entries: &[f64], side: &mut [f64]) {
    let par = Par::Seq;
    let rhs = MatMut::from_column_major_slice_mut(side, symbolic.nrows(), 1);
    let mut buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, par));
    LltRef::<usize, f64>::new(symbolic, entries).solve_in_place_with_conj(
        Conj::No,
        rhs,
        par,
        MemStack::new(&mut buffer),
    );
}
