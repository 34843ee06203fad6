//! Sparse matrices of 3 × 3 blocks.

use std::ops::Range;

use voxsoft_solid::vector::Vec3;

use super::cells::Interpolation;
use super::kernels::{Rounded, Single, Span, Whole};
use super::parallel::{self, CHUNK};
use super::values::{Block, Part, Values};
use crate::linear::operator::LinearOperator;

/// One half of each row: its columns, rising, and their blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Half {
    /// First place of each row, and the end.
    pub starts: Vec<usize>,
    /// Column at each place.
    pub columns: Vec<u32>,
    pub values: Values,
}

impl Half {
    /// Places of a row.
    #[inline(always)]
    pub fn places(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    /// Columns of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> &[u32] {
        &self.columns[self.places(row)]
    }

    fn with_pattern(starts: Vec<usize>, columns: Vec<u32>) -> Self {
        Self {
            values: Values::zeros(columns.len()),
            starts,
            columns,
        }
    }

    fn span(&self, skip: usize) -> Span<'_> {
        Span {
            starts: &self.starts,
            skip,
        }
    }

    /// Rounded blocks of each row from its place `skip` on, times vectors, of which `x` holds those from `from` on.
    fn rounded<'a>(&'a self, skip: usize, x: &'a [Single], from: usize) -> Rounded<'a> {
        Rounded {
            blocks: &self.values.high,
            columns: &self.columns,
            span: self.span(skip),
            x,
            from,
        }
    }

    /// Blocks of each row times vectors.
    fn whole<'a>(&'a self, x: &'a [Vec3]) -> Whole<'a> {
        Whole {
            high: &self.values.high,
            low: &self.values.low,
            columns: &self.columns,
            span: self.span(0),
            x,
        }
    }
}

/// Sparse matrix of 3 × 3 blocks by rows, with rising columns; every row has its diagonal.
///
/// Sweeps read the blocks before the diagonal of all rows, then those after it, so each half lies in one stretch of
/// memory: where they alternate, the processor fetches both to use one.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct BlockMatrix {
    /// Blocks before the diagonal.
    pub lower: Half,
    /// Diagonal of each row, and the blocks after it.
    pub upper: Half,
}

/// Mutable blocks of a range of rows.
pub(crate) struct RowsPart<'a> {
    pub rows: Range<usize>,
    pub lower: Part<'a>,
    pub upper: Part<'a>,
}

impl BlockMatrix {
    /// Matrix of zeros with the given columns in each row.
    pub fn with_pattern(starts: &[usize], columns: &[u32]) -> Self {
        let rows = starts.len() - 1;
        let (mut lower, mut upper) = (Vec::new(), Vec::with_capacity(columns.len() / 2 + rows));
        let (mut lower_starts, mut upper_starts) = (vec![0], vec![0]);
        for (row, ends) in starts.windows(2).enumerate() {
            let columns = &columns[ends[0]..ends[1]];
            let (before, rest) = columns.split_at(columns.partition_point(|&c| (c as usize) < row));
            lower.extend_from_slice(before);
            upper.extend_from_slice(rest);
            lower_starts.push(lower.len());
            upper_starts.push(upper.len());
        }
        Self {
            lower: Half::with_pattern(lower_starts, lower),
            upper: Half::with_pattern(upper_starts, upper),
        }
    }

    /// Pattern with node `n` renumbered to `places[n]`, filled with zeros.
    pub fn renumbered(&self, places: &[u32]) -> Self {
        let mut order = vec![0u32; places.len()];
        for (node, &place) in places.iter().enumerate() {
            order[place as usize] = node as u32;
        }
        let mut starts = Vec::with_capacity(order.len() + 1);
        starts.push(0);
        let mut columns = Vec::with_capacity(self.blocks());
        for &node in &order {
            let first = columns.len();
            let row = self.columns(node as usize);
            columns.extend(row.map(|c| places[c as usize]));
            columns[first..].sort_unstable();
            starts.push(columns.len());
        }
        Self::with_pattern(&starts, &columns)
    }

    pub fn rows(&self) -> usize {
        self.upper.starts.len() - 1
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.lower.columns.len() + self.upper.columns.len()
    }

    /// Columns of a row, rising.
    pub fn columns(&self, row: usize) -> impl Iterator<Item = u32> + '_ {
        let halves = [self.lower.row(row), self.upper.row(row)];
        halves.into_iter().flatten().copied()
    }

    /// Blocks of a row, in the order of its columns.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (u32, Block)> + '_ {
        let halves = [&self.lower, &self.upper];
        halves.into_iter().flat_map(move |half| {
            let places = half.places(row);
            places.map(|place| (half.columns[place], half.values.block(place)))
        })
    }

    /// Place of the block on the diagonal of a row, in the upper half.
    pub fn diagonal_place(&self, row: usize) -> usize {
        self.upper.starts[row]
    }

    /// Block on the diagonal of a row.
    pub fn diagonal_block(&self, row: usize) -> Block {
        self.upper.values.block(self.diagonal_place(row))
    }

    /// Half and place of a block; `None` if the row has no such column.
    fn find(&self, row: usize, column: u32) -> Option<(bool, usize)> {
        let in_upper = column as usize >= row;
        let half = if in_upper { &self.upper } else { &self.lower };
        let place = half.row(row).binary_search(&column).ok()?;
        Some((in_upper, half.places(row).start + place))
    }

    /// Block of a row and a column; zero if there is none.
    pub fn block(&self, row: usize, column: u32) -> Block {
        match self.find(row, column) {
            Some((true, place)) => self.upper.values.block(place),
            Some((false, place)) => self.lower.values.block(place),
            None => [0.0; 9],
        }
    }

    /// Sets the block of a row and a column of the pattern.
    pub fn set_block(&mut self, row: usize, column: u32, block: &Block) {
        if let Some((in_upper, place)) = self.find(row, column) {
            let half = if in_upper {
                &mut self.upper
            } else {
                &mut self.lower
            };
            for (k, value) in block.iter().enumerate() {
                half.values.set(place, k / 3, k % 3, *value);
            }
        }
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        self.lower.values.clear();
        self.upper.values.clear();
    }

    /// Tests whether all numbers are finite.
    pub fn are_finite(&self) -> bool {
        self.lower.values.are_finite() && self.upper.values.are_finite()
    }

    /// Splits into ranges of rows, one after the other, beside the columns of both halves.
    pub fn parts(
        &mut self,
        ranges: impl Iterator<Item = Range<usize>> + Clone,
    ) -> (Vec<RowsPart<'_>>, [Columns<'_>; 2]) {
        let counts = |starts: &[usize]| {
            let count = |rows: Range<usize>| starts[rows.end] - starts[rows.start];
            ranges.clone().map(count).collect::<Vec<usize>>()
        };
        let lower_counts = counts(&self.lower.starts);
        let upper_counts = counts(&self.upper.starts);
        let lower = self.lower.values.parts(lower_counts.into_iter());
        let upper = self.upper.values.parts(upper_counts.into_iter());
        let parts = ranges.zip(lower).zip(upper);
        let parts = parts.map(|((rows, lower), upper)| RowsPart { rows, lower, upper });
        let columns = [
            (&*self.lower.starts, &*self.lower.columns),
            (&*self.upper.starts, &*self.upper.columns),
        ];
        (parts.collect(), columns)
    }

    /// Computes `y = A x`.
    pub fn multiply(&self, x: &[Vec3], y: &mut [Vec3]) {
        let (lower, upper) = (self.lower.whole(x), self.upper.whole(x));
        parallel::for_each_chunk(y, |first, y| {
            lower.set(first, y);
            let mut room = [[0.0; 3]; CHUNK];
            let right = &mut room[..y.len()];
            upper.set(first, right);
            for (y, right) in y.iter_mut().zip(right) {
                *y = std::array::from_fn(|axis| y[axis] + right[axis]);
            }
        });
    }

    /// Rounded blocks left of the diagonal of each row, times vectors.
    pub fn before<'a>(&'a self, x: &'a [Single]) -> Rounded<'a> {
        self.lower.rounded(0, x, 0)
    }

    /// Rounded blocks right of the diagonal of each row, times vectors, of which `x` holds those from `from` on.
    pub fn after<'a>(&'a self, x: &'a [Single], from: usize) -> Rounded<'a> {
        self.upper.rounded(1, x, from)
    }

    /// Pattern of `Pᵀ A P`, with `fine_of`, the transpose of the interpolation `p`.
    pub fn coarse_pattern(&self, p: &Interpolation, fine_of: &Interpolation) -> Self {
        let count = fine_of.starts.len() - 1;
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); count];
        parallel::for_each(&mut rows, |row, columns| {
            for &(fine, _) in fine_of.row(row) {
                for neighbor in self.columns(fine as usize) {
                    columns.extend(p.row(neighbor as usize).iter().map(|&(coarse, _)| coarse));
                }
                columns.sort_unstable();
                columns.dedup();
            }
            if columns.is_empty() {
                columns.push(row as u32);
            }
        });
        let mut starts = Vec::with_capacity(count + 1);
        starts.push(0);
        let mut columns = Vec::new();
        for row in rows {
            columns.extend(row);
            starts.push(columns.len());
        }
        Self::with_pattern(&starts, &columns)
    }

    /// Sets `coarse = Pᵀ A P`.
    pub fn project(&self, p: &Interpolation, fine_of: &Interpolation, coarse: &mut Self) {
        let count = coarse.rows();
        let (mut rows, [before, after]) = coarse.parts((0..count).map(|row| row..row + 1));
        let scratch = || (vec![0u32; count], Vec::<Block>::new());
        parallel::for_each_with(&mut rows, scratch, |(place_of, sums), row, blocks| {
            let (before, after) = (columns_of(before, row), columns_of(after, row));
            let columns = before.iter().chain(after);
            for (place, &column) in columns.enumerate() {
                place_of[column as usize] = place as u32;
            }
            sums.clear();
            sums.resize(before.len() + after.len(), [0.0; 9]);
            for &(fine, weight) in fine_of.row(row) {
                for half in [&self.lower, &self.upper] {
                    for place in half.places(fine as usize) {
                        let block = half.values.block(place);
                        let weighted = block.map(|entry| weight * entry);
                        for &(column, share) in p.row(half.columns[place] as usize) {
                            let sum = &mut sums[place_of[column as usize] as usize];
                            for (sum, entry) in sum.iter_mut().zip(&weighted) {
                                *sum += share * entry;
                            }
                        }
                    }
                }
            }
            let (left, right) = sums.split_at(before.len());
            for (place, sum) in left.iter().enumerate() {
                blocks.lower.set(place, sum);
            }
            for (place, sum) in right.iter().enumerate() {
                blocks.upper.set(place, sum);
            }
        });
    }
}

/// Starts of the rows of a half, and its columns.
pub(crate) type Columns<'a> = (&'a [usize], &'a [u32]);

/// Columns of a row of a half.
#[inline(always)]
pub(crate) fn columns_of<'a>((starts, columns): Columns<'a>, row: usize) -> &'a [u32] {
    &columns[starts[row]..starts[row + 1]]
}

impl LinearOperator for &BlockMatrix {
    fn name(&self) -> &'static str {
        "the assembled tangent"
    }

    fn rows(&self) -> usize {
        BlockMatrix::rows(self)
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        self.multiply(x, y);
    }

    fn diagonal(&self) -> Vec<Vec3> {
        let diagonal = |row| {
            let block = self.diagonal_block(row);
            [block[0], block[4], block[8]]
        };
        (0..BlockMatrix::rows(self)).map(diagonal).collect()
    }
}

/// Transpose of an interpolation to `count` coarse nodes: the fine nodes interpolated from each of them.
pub(crate) fn transposed(p: &Interpolation, count: usize) -> Interpolation {
    let mut starts = vec![0u32; count + 1];
    for &(coarse, _) in &p.entries {
        starts[coarse as usize + 1] += 1;
    }
    for row in 0..count {
        starts[row + 1] += starts[row];
    }
    let mut next = starts.clone();
    let mut entries = vec![(0, 0.0); p.entries.len()];
    for fine in 0..p.starts.len() - 1 {
        for &(coarse, weight) in p.row(fine) {
            let place = &mut next[coarse as usize];
            entries[*place as usize] = (fine as u32, weight);
            *place += 1;
        }
    }
    Interpolation { starts, entries }
}

/// Inverse of a symmetric block on the axes that have stiffness, zero on the others: coordinates that are held, or
/// without an interpolated node, stay in place.
pub(crate) fn pseudo_inverse(block: &Block) -> Block {
    let mut a = *block;
    let mut inverse = [0.0; 9];
    let mut live = [false; 3];
    // Sweeps that keep the block symmetric and end at minus the inverse; a pivot lost to cancellation counts as zero.
    for k in 0..3 {
        let pivot = a[4 * k];
        if !(pivot > 1e-12 * block[4 * k].abs()) {
            continue;
        }
        live[k] = true;
        let row: Vec3 = std::array::from_fn(|j| a[3 * k + j]);
        for i in 0..3 {
            for j in 0..3 {
                if i != k && j != k {
                    a[3 * i + j] -= row[i] * row[j] / pivot;
                }
            }
        }
        for i in 0..3 {
            if i != k {
                a[3 * k + i] = row[i] / pivot;
                a[3 * i + k] = row[i] / pivot;
            }
        }
        a[4 * k] = -1.0 / pivot;
    }
    for i in 0..3 {
        for j in 0..3 {
            if live[i] && live[j] {
                inverse[3 * i + j] = -a[3 * i + j];
            }
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns 0, 3, 7, … before each diagonal and beyond it, as many as rows 0, 1, 2, … have room for.
    fn pattern(count: usize) -> BlockMatrix {
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for row in 0..count {
            columns.extend((0..count as u32).filter(|&c| {
                let apart = row.abs_diff(c as usize);
                apart == 0 || (apart * apart) % 7 == 1 && apart * row % 5 < 3
            }));
            starts.push(columns.len());
        }
        BlockMatrix::with_pattern(&starts, &columns)
    }

    #[test]
    fn halves_hold_the_rows_that_parts_set() {
        let mut matrix = pattern(40);
        let block = |row: usize, column: u32| -> Block {
            std::array::from_fn(|k| (row * 1000 + column as usize * 10 + k) as f64)
        };
        let (mut parts, halves) = matrix.parts([0..25, 25..40].into_iter());
        for part in &mut parts {
            for row in part.rows.clone() {
                let first = halves.map(|(starts, _)| starts[row] - starts[part.rows.start]);
                for (place, &column) in columns_of(halves[0], row).iter().enumerate() {
                    part.lower.set(first[0] + place, &block(row, column));
                }
                for (place, &column) in columns_of(halves[1], row).iter().enumerate() {
                    part.upper.set(first[1] + place, &block(row, column));
                }
            }
        }
        for row in 0..matrix.rows() {
            let columns: Vec<u32> = matrix.columns(row).collect();
            assert!(columns.is_sorted_by(|a, b| a < b));
            let expected: Vec<(u32, Block)> = columns
                .iter()
                .map(|&column| (column, block(row, column)))
                .collect();
            assert_eq!(matrix.row(row).collect::<Vec<_>>(), expected);
            assert_eq!(matrix.diagonal_block(row), block(row, row as u32));
        }
        // Reversed and reversed again.
        let reversed: Vec<u32> = (0..40).rev().collect();
        assert_eq!(
            matrix.renumbered(&reversed).renumbered(&reversed),
            pattern(40)
        );
    }
}
