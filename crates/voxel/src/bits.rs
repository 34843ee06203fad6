//! Bit sets of cells, one bit per cell, each row along z starting at a new word: 16 MiB for 512³ cells.
use crate::grid::Grid;

/// A set of cells of a box; rows run along the last axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BitGrid {
    shape: [usize; 3],
    words_per_row: usize,
    words: Vec<u64>,
}

impl BitGrid {
    /// Makes the empty set in a box of `shape` cells.
    pub fn new(shape: [usize; 3]) -> Self {
        let words_per_row = shape[2].div_ceil(64);
        Self {
            shape,
            words_per_row,
            words: vec![0; shape[0] * shape[1] * words_per_row],
        }
    }

    /// The filled cells of a grid.
    pub fn filled(grid: &Grid) -> Self {
        let mut bits = Self::new(grid.shape());
        let rows = bits.words.chunks_exact_mut(bits.words_per_row);
        for (row, cells) in rows.zip(grid.cells().chunks_exact(bits.shape[2])) {
            for (word, cells) in row.iter_mut().zip(cells.chunks(64)) {
                *word = pack(cells);
            }
        }
        bits
    }

    pub fn shape(&self) -> [usize; 3] {
        self.shape
    }

    pub fn words_per_row(&self) -> usize {
        self.words_per_row
    }

    pub fn words(&self) -> &[u64] {
        &self.words
    }

    /// The words of row (i, j).
    pub fn row(&self, i: usize, j: usize) -> &[u64] {
        let start = (i * self.shape[1] + j) * self.words_per_row;
        &self.words[start..start + self.words_per_row]
    }

    pub fn row_mut(&mut self, i: usize, j: usize) -> &mut [u64] {
        let start = (i * self.shape[1] + j) * self.words_per_row;
        &mut self.words[start..start + self.words_per_row]
    }

    /// Word `w` of row (i, j), 0 outside of the box.
    pub fn word(&self, i: isize, j: isize, w: usize) -> u64 {
        let inside = |n: isize, axis: usize| (0..self.shape[axis] as isize).contains(&n);
        if inside(i, 0) && inside(j, 1) {
            self.row(i as usize, j as usize)
                .get(w)
                .copied()
                .unwrap_or(0)
        } else {
            0
        }
    }

    /// Word `w` of row (i, j) shifted by one cell, see [`Self::word`]: bit k holds cell k − 1.
    pub fn behind(&self, i: isize, j: isize, w: usize) -> u64 {
        let carried = if w == 0 {
            0
        } else {
            self.word(i, j, w - 1) >> 63
        };
        self.word(i, j, w) << 1 | carried
    }

    /// Word `w` of row (i, j) shifted by one cell, see [`Self::word`]: bit k holds cell k + 1.
    pub fn ahead(&self, i: isize, j: isize, w: usize) -> u64 {
        self.word(i, j, w) >> 1 | self.word(i, j, w + 1) << 63
    }

    pub fn get(&self, i: usize, j: usize, k: usize) -> bool {
        self.row(i, j)[k / 64] >> (k % 64) & 1 == 1
    }

    /// The cells of the box that are not in the set.
    pub fn complement(&self) -> Self {
        let mut bits = self.clone();
        let tail = u64::MAX >> ((64 - self.shape[2] % 64) % 64);
        for row in bits.words.chunks_exact_mut(bits.words_per_row) {
            for word in row.iter_mut() {
                *word = !*word;
            }
            row[self.words_per_row - 1] &= tail;
        }
        bits
    }

    /// The cells of the set that are not in `other`, which has the same shape.
    pub fn without(&self, other: &Self) -> Self {
        let mut bits = self.clone();
        for (word, other) in bits.words.iter_mut().zip(&other.words) {
            *word &= !other;
        }
        bits
    }

    /// Number of cells of row (i, j) in the set with `first <= k <= last`.
    pub fn count_between(&self, i: usize, j: usize, first: usize, last: usize) -> u32 {
        let row = self.row(i, j);
        let (from, to) = (first / 64, last / 64);
        (from..=to)
            .map(|w| {
                let low = if w == from {
                    u64::MAX << (first % 64)
                } else {
                    u64::MAX
                };
                let high = if w == to {
                    u64::MAX >> (63 - last % 64)
                } else {
                    u64::MAX
                };
                (row[w] & low & high).count_ones()
            })
            .sum()
    }

    /// Adds the cells of row (i, j) with `first <= k <= last`.
    pub fn insert_between(&mut self, i: usize, j: usize, first: usize, last: usize) {
        let row = self.row_mut(i, j);
        let (from, to) = (first / 64, last / 64);
        for (w, word) in row.iter_mut().enumerate().take(to + 1).skip(from) {
            let low = if w == from {
                u64::MAX << (first % 64)
            } else {
                u64::MAX
            };
            let high = if w == to {
                u64::MAX >> (63 - last % 64)
            } else {
                u64::MAX
            };
            *word |= low & high;
        }
    }

    /// Number of cells of plane i in the set.
    pub fn count_in_plane(&self, i: usize) -> usize {
        let plane = self.shape[1] * self.words_per_row;
        let words = &self.words[i * plane..(i + 1) * plane];
        words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Number of maximal runs of cells.
    pub fn count_runs(&self) -> usize {
        let rows = self.words.chunks_exact(self.words_per_row);
        let starts = rows.flat_map(|row| {
            row.iter().scan(0, |carried, &word| {
                let starts = word & !(word << 1 | *carried);
                *carried = word >> 63;
                Some(starts.count_ones() as usize)
            })
        });
        starts.sum()
    }

    /// Calls `visit(first, last)` for each maximal run of cells in row (i, j), in order.
    pub fn for_each_run(&self, i: usize, j: usize, mut visit: impl FnMut(usize, usize)) {
        let row = self.row(i, j);
        let mut open = None;
        for (w, &word) in row.iter().enumerate() {
            // Bit k is set where membership changes between cell k − 1 and k.
            let carried = u64::from(open.is_some());
            let mut changes = word ^ (word << 1 | carried);
            while changes != 0 {
                let k = w * 64 + changes.trailing_zeros() as usize;
                open = match open {
                    None => Some(k),
                    Some(first) => {
                        visit(first, k - 1);
                        None
                    }
                };
                changes &= changes - 1;
            }
        }
        if let Some(first) = open {
            // A run is still open only if the row ends with its last word.
            visit(first, self.shape[2] - 1);
        }
    }
}

/// Packs at most 64 cells into a word: bit k is set where cell k is filled.
fn pack(cells: &[u8]) -> u64 {
    cells
        .iter()
        .enumerate()
        .fold(0, |word, (k, &part)| word | u64::from(part != 0) << k)
}

/// Positions of the set bits of a word, ascending.
pub(crate) fn ones(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (word != 0).then(|| {
            let bit = word.trailing_zeros() as usize;
            word &= word - 1;
            bit
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row_of(cells: &[u8]) -> BitGrid {
        let shape = [1, 1, cells.len()];
        BitGrid::filled(&Grid::from_cells(shape, [0.0; 3], 1.0, cells.to_vec()).unwrap())
    }

    #[test]
    fn runs_match_a_cell_by_cell_scan() {
        for length in [1, 63, 64, 65, 128, 130] {
            for seed in 0..20_u64 {
                let mut grid = Grid::empty([1, 1, length], [0.0; 3], 1.0, 999).unwrap();
                grid.fill_random(0.1 * (seed % 11) as f64, seed, 1);
                let bits = BitGrid::filled(&grid);
                let mut rebuilt = BitGrid::new(bits.shape());
                let (mut last_end, mut runs) = (None, 0);
                bits.for_each_run(0, 0, |first, last| {
                    runs += 1;
                    assert!(
                        last_end.is_none_or(|end| first > end + 1),
                        "runs must be maximal"
                    );
                    rebuilt.insert_between(0, 0, first, last);
                    last_end = Some(last);
                });
                assert_eq!((&rebuilt, runs), (&bits, bits.count_runs()));
                let empty = bits.complement();
                assert!((0..length).all(|k| empty.get(0, 0, k) == (grid.get([0, 0, k]) == 0)));
                assert_eq!(empty.complement(), bits);
            }
        }
    }

    #[test]
    fn counts_between_two_cells() {
        let cells: Vec<u8> = (0..200).map(|k| u8::from(k % 3 == 0)).collect();
        let bits = row_of(&cells);
        for (first, last) in [(0, 0), (0, 199), (5, 63), (63, 64), (64, 127), (100, 190)] {
            let expected = cells[first..=last].iter().filter(|&&c| c == 1).count();
            assert_eq!(bits.count_between(0, 0, first, last) as usize, expected);
        }
    }
}
