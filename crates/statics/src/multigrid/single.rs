//! Matrices and vectors of the V-cycle in single precision.
//!
//! A preconditioner need not be exact: what rounding to seven digits leaves out, the conjugate gradients around it take in
//! double precision. Half the bytes are half the time where memory is what takes it.

use voxsoft_solid::vector::Vec3;

use super::blocks::{BlockMatrix, pseudo_inverse};
use super::parallel;

/// A vector on a node; the fourth place fills a register, and means nothing.
pub(super) type Single = [f32; 4];

/// Numbers of a block.
const BLOCK: usize = 9;
/// Numbers that are read for a block: three columns of four, the last of which reaches into the next block.
const READ: usize = 12;

/// The values of a [`BlockMatrix`], block by block and column by column, and the inverses of its diagonal.
pub(super) struct SingleMatrix {
    values: Vec<f32>,
    inverses: Vec<[f32; READ]>,
}

impl SingleMatrix {
    /// Room for a matrix.
    pub fn for_matrix(matrix: &BlockMatrix) -> Self {
        Self {
            values: vec![0.0; BLOCK * matrix.values.len() + READ - BLOCK],
            inverses: vec![[0.0; READ]; matrix.diagonals.len()],
        }
    }

    /// Takes the values of the matrix.
    pub fn take(&mut self, matrix: &BlockMatrix) {
        let used = BLOCK * matrix.values.len();
        parallel::for_each_chunk(&mut self.values[..used], |place, out: &mut [f32; BLOCK]| {
            *out = transposed(&matrix.values[place]);
        });
        parallel::for_each(&mut self.inverses, |row, inverse| {
            let block = pseudo_inverse(&matrix.values[matrix.diagonals[row]]);
            inverse[..BLOCK].copy_from_slice(&transposed(&block));
        });
    }

    /// The sum of the given blocks of one row times what `value` says for their columns.
    #[inline(always)]
    pub fn product<'a>(
        &self,
        columns: &[u32],
        places: std::ops::Range<usize>,
        value: impl Fn(usize) -> &'a Single,
    ) -> Single {
        let mut sums = [[0.0f32; 4]; 3];
        for place in places {
            let x = value(columns[place] as usize);
            let block = &self.values[BLOCK * place..BLOCK * place + READ];
            for j in 0..3 {
                for i in 0..4 {
                    sums[j][i] += block[3 * j + i] * x[j];
                }
            }
        }
        std::array::from_fn(|i| sums[0][i] + (sums[1][i] + sums[2][i]))
    }

    /// The inverse of the diagonal of a row times a vector. Axes without stiffness get zero.
    #[inline(always)]
    pub fn solve(&self, row: usize, x: Single) -> Single {
        let inverse = &self.inverses[row];
        std::array::from_fn(|i| inverse[i] * x[0] + (inverse[3 + i] * x[1] + inverse[6 + i] * x[2]))
    }
}

fn transposed(block: &[f64; BLOCK]) -> [f32; BLOCK] {
    std::array::from_fn(|k| block[3 * (k % 3) + k / 3] as f32)
}

/// A vector rounded.
#[inline(always)]
pub(super) fn rounded(x: Vec3) -> Single {
    [x[0] as f32, x[1] as f32, x[2] as f32, 0.0]
}

/// And back.
#[inline(always)]
pub(super) fn widened(x: Single) -> Vec3 {
    [f64::from(x[0]), f64::from(x[1]), f64::from(x[2])]
}

/// `a − b`.
#[inline(always)]
pub(super) fn minus(a: Single, b: Single) -> Single {
    std::array::from_fn(|i| a[i] - b[i])
}

/// `a + factor b`.
#[inline(always)]
pub(super) fn plus(a: Single, factor: f32, b: Single) -> Single {
    std::array::from_fn(|i| a[i] + factor * b[i])
}
