//! Sparse matrices of 3 × 3 blocks.

use voxsoft_solid::vector::Vec3;

use super::cells::Interpolation;
use super::parallel;
use super::values::{Block, Values};
use crate::linear::operator::LinearOperator;

/// Sparse matrix of 3 × 3 blocks by rows, with rising columns; every row has its diagonal.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct BlockMatrix {
    pub starts: Vec<usize>,
    pub columns: Vec<u32>,
    pub values: Values,
    /// Index of the diagonal block of each row.
    pub diagonals: Vec<usize>,
}

impl BlockMatrix {
    /// Matrix of zeros with the given columns in each row.
    pub fn with_pattern(starts: Vec<usize>, columns: Vec<u32>) -> Self {
        let diagonals = starts
            .windows(2)
            .enumerate()
            .map(|(row, ends)| {
                let place = columns[ends[0]..ends[1]].partition_point(|&c| (c as usize) < row);
                ends[0] + place
            })
            .collect();
        Self {
            values: Values::zeros(columns.len()),
            starts,
            columns,
            diagonals,
        }
    }

    /// Pattern with node `n` renumbered to `places[n]`, filled with zeros.
    pub fn renumbered(&self, places: &[u32]) -> Self {
        let mut order = vec![0u32; places.len()];
        for (node, &place) in places.iter().enumerate() {
            order[place as usize] = node as u32;
        }
        let mut starts = Vec::with_capacity(self.starts.len());
        starts.push(0);
        let mut columns = Vec::with_capacity(self.columns.len());
        for &node in &order {
            let first = columns.len();
            let row = self.row(node as usize).1;
            columns.extend(row.iter().map(|&c| places[c as usize]));
            columns[first..].sort_unstable();
            starts.push(columns.len());
        }
        Self::with_pattern(starts, columns)
    }

    pub fn rows(&self) -> usize {
        self.diagonals.len()
    }

    /// Columns of a row and the index of their first block.
    pub fn row(&self, row: usize) -> (usize, &[u32]) {
        let (start, end) = (self.starts[row], self.starts[row + 1]);
        (start, &self.columns[start..end])
    }

    /// Computes `y = A x`.
    pub fn multiply(&self, x: &[Vec3], y: &mut [Vec3]) {
        parallel::for_each(y, |row, y| {
            let mut sum = [0.0; 4];
            for place in self.starts[row]..self.starts[row + 1] {
                let x = x[self.columns[place] as usize];
                self.values.add_product(place, x, &mut sum);
            }
            *y = [sum[0], sum[1], sum[2]];
        });
    }

    /// Pattern of `Pᵀ A P`, with `fine_of`, the transpose of the interpolation `p`.
    pub fn coarse_pattern(&self, p: &Interpolation, fine_of: &Interpolation) -> Self {
        let count = fine_of.starts.len() - 1;
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); count];
        parallel::for_each(&mut rows, |row, columns| {
            for &(fine, _) in fine_of.row(row) {
                for &neighbor in self.row(fine as usize).1 {
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
        Self::with_pattern(starts, columns)
    }

    /// Sets `coarse = Pᵀ A P`.
    pub fn project(&self, p: &Interpolation, fine_of: &Interpolation, coarse: &mut Self) {
        let Self {
            starts,
            columns,
            values,
            ..
        } = coarse;
        let mut rows = values.parts(starts.windows(2).map(|ends| ends[1] - ends[0]));
        let count = starts.len() - 1;
        let scratch = || (vec![0u32; count], Vec::<Block>::new());
        parallel::for_each_with(&mut rows, scratch, |(place_of, sums), row, blocks| {
            let columns = &columns[starts[row]..starts[row + 1]];
            for (place, &column) in columns.iter().enumerate() {
                place_of[column as usize] = place as u32;
            }
            sums.clear();
            sums.resize(columns.len(), [0.0; 9]);
            for &(fine, weight) in fine_of.row(row) {
                let (start, neighbors) = self.row(fine as usize);
                for (offset, &neighbor) in neighbors.iter().enumerate() {
                    let block = self.values.block(start + offset);
                    let weighted = block.map(|entry| weight * entry);
                    for &(column, share) in p.row(neighbor as usize) {
                        let sum = &mut sums[place_of[column as usize] as usize];
                        for (sum, entry) in sum.iter_mut().zip(&weighted) {
                            *sum += share * entry;
                        }
                    }
                }
            }
            for (place, sum) in sums.iter().enumerate() {
                blocks.set(place, sum);
            }
        });
    }
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
        let diagonal = |&place: &usize| {
            let block = self.values.block(place);
            [block[0], block[4], block[8]]
        };
        self.diagonals.iter().map(diagonal).collect()
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
