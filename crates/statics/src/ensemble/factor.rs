//! Factorization `L D Lᵀ` of one tangent for each lane, on a shared envelope.

use pulp::{Simd, WithSimd};
use voxsoft_solid::lattice::lanes::Lanes;

use super::layout::{Layout, Row};

/// Block of 3×3 numbers for each lane, row by row.
type Block<S> = [<S as Simd>::f64s; 9];

/// Factorizes in place, and counts negative pivots.
///
/// There is no pivoting: near a stable equilibrium the tangent is positive definite, and elsewhere a bad step only
/// costs more steps. Diagonal blocks then hold their own factor: one over the pivots, and below them the unit triangle.
pub(super) struct Factor<'a> {
    pub layout: &'a Layout,
    pub blocks: &'a mut [f64],
    /// Number of negative pivots of each lane.
    pub negative: &'a mut [f64],
}

impl WithSimd for Factor<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = Lanes(simd);
        let (blocks, _) = S::as_mut_simd_f64s(self.blocks);
        let (blocks, _) = blocks.as_chunks_mut::<9>();
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let mut negative = zero;
        let rows = &self.layout.rows;
        for (i, row) in rows.iter().enumerate() {
            let (before, after) = blocks.split_at_mut(row.start as usize);
            let (own, after) = after.split_at_mut(i - row.first as usize);
            for j in 0..own.len() {
                let place = row.first as usize + j;
                let other = &rows[place];
                let from = row.first.max(other.first) as usize;
                let (known, rest) = own.split_at_mut(j);
                let start = (other.start as usize) + from - other.first as usize;
                let theirs = &before[start..=diagonal(other, place)];
                let (triangle, theirs) = theirs.split_last().expect("a row has its diagonal");
                let mut block = rest[0];
                for (g, l) in known[from - row.first as usize..].iter().zip(theirs) {
                    for r in 0..3 {
                        for c in 0..3 {
                            let mut entry = block[3 * r + c];
                            entry = lanes.fnma(g[3 * r], l[3 * c], entry);
                            entry = lanes.fnma(g[3 * r + 1], l[3 * c + 1], entry);
                            block[3 * r + c] = lanes.fnma(g[3 * r + 2], l[3 * c + 2], entry);
                        }
                    }
                }
                for r in 0..3 {
                    let first = block[3 * r];
                    let second = lanes.fnma(first, triangle[3], block[3 * r + 1]);
                    let third = lanes.fnma(first, triangle[6], block[3 * r + 2]);
                    block[3 * r + 1] = second;
                    block[3 * r + 2] = lanes.fnma(second, triangle[7], third);
                }
                rest[0] = block;
            }
            let mut pivot = after[0];
            for (j, block) in own.iter_mut().enumerate() {
                let place = row.first as usize + j;
                let theirs = &before[diagonal(&rows[place], place)];
                let whole = *block;
                for r in 0..3 {
                    for c in 0..3 {
                        block[3 * r + c] = lanes.mul(whole[3 * r + c], theirs[4 * c]);
                    }
                }
                for r in 0..3 {
                    for c in 0..=r {
                        let mut entry = pivot[3 * r + c];
                        for q in 0..3 {
                            entry = lanes.fnma(whole[3 * r + q], block[3 * c + q], entry);
                        }
                        pivot[3 * r + c] = entry;
                    }
                }
            }
            let first = pivot[0];
            let inverse = lanes.div(one, first);
            let (l10, l20) = (lanes.mul(pivot[3], inverse), lanes.mul(pivot[6], inverse));
            let second = lanes.fnma(l10, pivot[3], pivot[4]);
            let inverse_second = lanes.div(one, second);
            let l21 = lanes.mul(lanes.fnma(l20, pivot[3], pivot[7]), inverse_second);
            let third = lanes.fnma(l20, pivot[6], pivot[8]);
            let third = lanes.fnma(lanes.mul(l21, l21), second, third);
            for value in [first, second, third] {
                let count = lanes.choose(lanes.neg(value), one, zero);
                negative = lanes.add(negative, count);
            }
            let inverse_third = lanes.div(one, third);
            after[0] = [
                inverse,
                zero,
                zero,
                l10,
                inverse_second,
                zero,
                l20,
                l21,
                inverse_third,
            ];
        }
        S::as_mut_simd_f64s(self.negative).0[0] = negative;
    }
}

/// Index of the diagonal block of a row.
fn diagonal(row: &Row, place: usize) -> usize {
    row.start as usize + place - row.first as usize
}

/// Solves with the factors in place, for one right-hand side of each lane.
pub(super) struct Solve<'a> {
    pub layout: &'a Layout,
    pub blocks: &'a [f64],
    pub sides: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = Lanes(simd);
        let (blocks, _) = S::as_simd_f64s(self.blocks);
        let (blocks, _): (&[Block<S>], _) = blocks.as_chunks::<9>();
        let (sides, _) = S::as_mut_simd_f64s(self.sides);
        let (sides, _) = sides.as_chunks_mut::<3>();
        let rows = &self.layout.rows;
        for (i, row) in rows.iter().enumerate() {
            let (before, after) = sides.split_at_mut(i);
            let width = i - row.first as usize;
            let own = &blocks[row.start as usize..][..=width];
            let mut side = after[0];
            for (block, known) in own[..width].iter().zip(&before[row.first as usize..]) {
                for r in 0..3 {
                    for q in 0..3 {
                        side[r] = lanes.fnma(block[3 * r + q], known[q], side[r]);
                    }
                }
            }
            let triangle = &own[width];
            side[1] = lanes.fnma(triangle[3], side[0], side[1]);
            side[2] = lanes.fnma(triangle[6], side[0], side[2]);
            side[2] = lanes.fnma(triangle[7], side[1], side[2]);
            after[0] = side;
        }
        for (i, row) in rows.iter().enumerate() {
            let pivots = &blocks[diagonal(row, i)];
            for r in 0..3 {
                sides[i][r] = lanes.mul(sides[i][r], pivots[4 * r]);
            }
        }
        for (i, row) in rows.iter().enumerate().rev() {
            let (before, after) = sides.split_at_mut(i);
            let width = i - row.first as usize;
            let own = &blocks[row.start as usize..][..=width];
            let triangle = &own[width];
            let mut side = after[0];
            side[1] = lanes.fnma(triangle[7], side[2], side[1]);
            side[0] = lanes.fnma(triangle[3], side[1], side[0]);
            side[0] = lanes.fnma(triangle[6], side[2], side[0]);
            after[0] = side;
            for (block, open) in own[..width].iter().zip(&mut before[row.first as usize..]) {
                for q in 0..3 {
                    for r in 0..3 {
                        open[q] = lanes.fnma(block[3 * r + q], side[r], open[q]);
                    }
                }
            }
        }
    }
}
