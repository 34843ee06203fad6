//! Blocks of a matrix, each number as the sum of two in single precision.
//!
//! The first is the rounded number, with which the V-cycle works: a preconditioner need not be exact, and half the
//! bytes are half the time where memory bandwidth is the limit. Both together have 48 binary digits, with which
//! conjugate gradients work; the rest is 10⁻¹⁵ of each number. So a matrix is stored once, for both.

use super::parallel;

/// Block, row-major.
pub(crate) type Block = [f64; 9];

/// Vector on a node; the fourth place fills a register, and has no meaning.
pub(crate) type Single = [f32; 4];

/// Numbers of a block.
pub(crate) const BLOCK: usize = 9;
/// Numbers read for a block: three columns of four, the last of which reaches into the next block.
const READ: usize = 12;

/// Blocks one after the other, each column by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Values {
    high: Vec<f32>,
    low: Vec<f32>,
}

/// Mutable part of the blocks.
pub(crate) struct Part<'a> {
    high: &'a mut [f32],
    low: &'a mut [f32],
}

#[inline(always)]
fn split(value: f64) -> [f32; 2] {
    let high = value as f32;
    [high, (value - f64::from(high)) as f32]
}

/// Transposes a block.
#[inline(always)]
fn transposed<T: Copy>(block: &[T; BLOCK]) -> [T; BLOCK] {
    std::array::from_fn(|k| block[3 * (k % 3) + k / 3])
}

impl Values {
    /// Allocates `count` blocks of zeros.
    pub fn zeros(count: usize) -> Self {
        let room = BLOCK * count + READ - BLOCK;
        Self {
            high: vec![0.0; room],
            low: vec![0.0; room],
        }
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        for half in [&mut self.high, &mut self.low] {
            let (blocks, _) = half.as_chunks_mut::<BLOCK>();
            parallel::for_each(blocks, |_, block| *block = [0.0; BLOCK]);
        }
    }

    /// Tests whether all numbers are finite.
    pub fn are_finite(&self) -> bool {
        // A NaN or an overflow leaves a low part that is not finite.
        self.low.iter().all(|value| value.is_finite())
    }

    /// Block at a place.
    #[inline(always)]
    pub fn block(&self, place: usize) -> Block {
        let range = BLOCK * place..BLOCK * (place + 1);
        let (high, low) = (&self.high[range.clone()], &self.low[range]);
        transposed(&std::array::from_fn(|k| {
            f64::from(high[k]) + f64::from(low[k])
        }))
    }

    /// Multiplies a number of a block.
    pub fn scale(&mut self, place: usize, row: usize, column: usize, factor: f64) {
        let at = BLOCK * place + 3 * column + row;
        let value = f64::from(self.high[at]) + f64::from(self.low[at]);
        [self.high[at], self.low[at]] = split(factor * value);
    }

    /// Adds a block times `x`; the fourth place of the sum has no meaning.
    #[inline(always)]
    pub fn add_product(&self, place: usize, x: [f64; 3], sum: &mut [f64; 4]) {
        let range = BLOCK * place..BLOCK * place + READ;
        let (high, low) = (&self.high[range.clone()], &self.low[range]);
        for j in 0..3 {
            for i in 0..4 {
                let value = f64::from(high[3 * j + i]) + f64::from(low[3 * j + i]);
                sum[i] += value * x[j];
            }
        }
    }

    /// Sum of the given blocks of one row, rounded, times the vectors that `value` returns for their columns.
    #[inline(always)]
    pub fn rounded_product<'a>(
        &self,
        columns: &[u32],
        places: std::ops::Range<usize>,
        value: impl Fn(usize) -> &'a Single,
    ) -> Single {
        let mut sums = [[0.0f32; 4]; 3];
        for place in places {
            let x = value(columns[place] as usize);
            let block = &self.high[BLOCK * place..BLOCK * place + READ];
            for j in 0..3 {
                for i in 0..4 {
                    sums[j][i] += block[3 * j + i] * x[j];
                }
            }
        }
        std::array::from_fn(|i| sums[0][i] + (sums[1][i] + sums[2][i]))
    }

    /// Splits into parts of `counts` blocks, one after the other.
    pub fn parts(&mut self, counts: impl Iterator<Item = usize>) -> Vec<Part<'_>> {
        let (mut high, mut low) = (self.high.as_mut_slice(), self.low.as_mut_slice());
        let mut parts = Vec::with_capacity(counts.size_hint().0);
        for count in counts {
            let (own_high, left_high) = high.split_at_mut(BLOCK * count);
            let (own_low, left_low) = low.split_at_mut(BLOCK * count);
            (high, low) = (left_high, left_low);
            parts.push(Part {
                high: own_high,
                low: own_low,
            });
        }
        parts
    }
}

impl Part<'_> {
    /// Adds to a block.
    #[inline(always)]
    pub fn add(&mut self, place: usize, block: &Block) {
        let range = BLOCK * place..BLOCK * (place + 1);
        let (high, low) = (&mut self.high[range.clone()], &mut self.low[range]);
        let block = transposed(block);
        for k in 0..BLOCK {
            let sum = f64::from(high[k]) + f64::from(low[k]) + block[k];
            [high[k], low[k]] = split(sum);
        }
    }

    /// Sets a block.
    #[inline(always)]
    pub fn set(&mut self, place: usize, block: &Block) {
        let range = BLOCK * place..BLOCK * (place + 1);
        let (high, low) = (&mut self.high[range.clone()], &mut self.low[range]);
        for (k, value) in transposed(block).into_iter().enumerate() {
            [high[k], low[k]] = split(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_keep_48_digits_and_detect_nan() {
        let mut values = Values::zeros(2);
        let block: Block = std::array::from_fn(|k| (k as f64 + 1.0) / 3.0);
        for part in &mut values.parts([1, 1].into_iter()) {
            part.add(0, &block);
            part.add(0, &block);
        }
        for (sum, entry) in values.block(1).iter().zip(&block) {
            // Rounding of the low part, twice.
            assert!((sum - 2.0 * entry).abs() <= 2.0 * f64::powi(2.0, -48) * sum.abs());
        }
        assert!(values.are_finite());
        let mut sum = [0.0; 4];
        values.add_product(0, [1.0, 2.0, 3.0], &mut sum);
        for i in 0..3 {
            let row = 3 * i;
            let expected = 2.0 * (block[row] + 2.0 * block[row + 1] + 3.0 * block[row + 2]);
            assert!((sum[i] - expected).abs() < 1e-13 * expected);
        }
        for odd in [f64::NAN, f64::INFINITY, 1e300] {
            values.parts([2].into_iter())[0].set(0, &[odd; BLOCK]);
            assert!(!values.are_finite(), "{odd}");
        }
    }
}
