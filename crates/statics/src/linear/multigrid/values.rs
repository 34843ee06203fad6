//! Blocks of a matrix, each number as the sum of two in single precision.
//!
//! The first is the rounded number, with which the V-cycle works: a preconditioner need not be exact, and half the
//! bytes are half the time where memory bandwidth is the limit. Both together have 48 binary digits, with which
//! conjugate gradients work; the rest is 10⁻¹⁵ of each number. So a matrix is stored once, for both.

use super::kernels::{BLOCK, fetch};
use super::parallel;

/// Block, row-major.
pub(crate) type Block = [f64; 9];

/// Blocks one after the other, each column by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Values {
    pub(super) high: Vec<[f32; BLOCK]>,
    pub(super) low: Vec<[f32; BLOCK]>,
}

/// Mutable part of the blocks.
pub(crate) struct Part<'a> {
    high: &'a mut [[f32; BLOCK]],
    low: &'a mut [[f32; BLOCK]],
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
        Self {
            high: vec![[0.0; BLOCK]; count],
            low: vec![[0.0; BLOCK]; count],
        }
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        for half in [&mut self.high, &mut self.low] {
            parallel::for_each(half, |_, block| *block = [0.0; BLOCK]);
        }
    }

    /// Tests whether all numbers are finite.
    pub fn are_finite(&self) -> bool {
        // A NaN or an overflow leaves a low part that is not finite.
        self.low
            .as_flattened()
            .iter()
            .all(|value| value.is_finite())
    }

    /// Block at a place.
    #[inline(always)]
    pub fn block(&self, place: usize) -> Block {
        let (high, low) = (&self.high[place], &self.low[place]);
        transposed(&std::array::from_fn(|k| {
            f64::from(high[k]) + f64::from(low[k])
        }))
    }

    /// Multiplies a number of a block.
    pub fn scale(&mut self, place: usize, row: usize, column: usize, factor: f64) {
        let at = 3 * column + row;
        let (high, low) = (&mut self.high[place][at], &mut self.low[place][at]);
        let value = f64::from(*high) + f64::from(*low);
        [*high, *low] = split(factor * value);
    }

    /// Sets a number of a block.
    pub fn set(&mut self, place: usize, row: usize, column: usize, value: f64) {
        let at = 3 * column + row;
        [self.high[place][at], self.low[place][at]] = split(value);
    }

    /// Splits into parts of `counts` blocks, one after the other.
    pub fn parts(&mut self, counts: impl Iterator<Item = usize>) -> Vec<Part<'_>> {
        let (mut high, mut low) = (self.high.as_mut_slice(), self.low.as_mut_slice());
        let mut parts = Vec::with_capacity(counts.size_hint().0);
        for count in counts {
            let (own_high, left_high) = high.split_at_mut(count);
            let (own_low, left_low) = low.split_at_mut(count);
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
        let (high, low) = (self.high[place], self.low[place]);
        let block = transposed(block);
        // One step after the other for all numbers, so that they share registers.
        let sums: Block =
            std::array::from_fn(|k| f64::from(high[k]) + f64::from(low[k]) + block[k]);
        let high = sums.map(|sum| sum as f32);
        self.high[place] = high;
        self.low[place] = std::array::from_fn(|k| (sums[k] - f64::from(high[k])) as f32);
    }

    /// Starts to fetch a block, which mostly reaches into a second line of the cache.
    #[inline(always)]
    pub fn fetch(&self, place: usize) {
        for block in [&self.high[place], &self.low[place]] {
            fetch(&block[0]);
            fetch(&block[BLOCK - 1]);
        }
    }

    /// Sets a block.
    #[inline(always)]
    pub fn set(&mut self, place: usize, block: &Block) {
        let (high, low) = (&mut self.high[place], &mut self.low[place]);
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
        for odd in [f64::NAN, f64::INFINITY, 1e300] {
            values.parts([2].into_iter())[0].set(0, &[odd; BLOCK]);
            assert!(!values.are_finite(), "{odd}");
        }
    }
}
