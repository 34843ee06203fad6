//! Hinges: contacts of cells only along an edge or at a corner.
use crate::bits::{BitGrid, ones};
use crate::components::Contact;
use crate::grid::Grid;
use crate::planes::by_plane;

/// A hinge: two filled cells whose only contact here is an edge or a corner.
///
/// The mesh is stitched there, so the cells stay connected, but they rotate about the edge or the corner without
/// resistance, and no mold or printer can make such a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Hinge {
    /// The two cells, in C order.
    pub cells: [[u32; 3]; 2],
}

impl Hinge {
    /// Contact of the two cells, [`Contact::Edge`] or [`Contact::Corner`].
    pub fn contact(&self) -> Contact {
        let [a, b] = self.cells;
        if (0..3).all(|axis| a[axis] != b[axis]) {
            Contact::Corner
        } else {
            Contact::Edge
        }
    }
}

/// All hinges, sorted by their first cell in C order.
///
/// An edge is a hinge if exactly two opposite cells of the four around it are filled; a corner, if exactly two opposite
/// cells of the eight around it are. Any further filled cell would join them.
pub fn hinges(grid: &Grid) -> Vec<Hinge> {
    let filled = BitGrid::filled(grid);
    by_plane(grid.shape()[0], |i| {
        let mut found = Vec::new();
        for j in 0..grid.shape()[1] {
            for w in 0..filled.words_per_row() {
                for (pattern, [from, to]) in around(&filled, i as isize, j as isize, w) {
                    for bit in ones(pattern) {
                        let start = [i, j, w * 64 + bit];
                        let cell = |step: [usize; 3]| -> [u32; 3] {
                            std::array::from_fn(|a| (start[a] + step[a]) as u32)
                        };
                        found.push(Hinge {
                            cells: [cell(from), cell(to)],
                        });
                    }
                }
            }
        }
        found.sort_unstable();
        found
    })
}

/// Hinges whose lowest of four or eight cells is (i, j, k): the bits k with a hinge, and the steps from this cell to
/// the two of the hinge.
fn around(filled: &BitGrid, i: isize, j: isize, w: usize) -> [(u64, [[usize; 3]; 2]); 10] {
    // Names give the offset (di, dj, dk) from the lowest cell: c011 is one further in j and k.
    let [c000, c010, c100, c110] =
        [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)].map(|(i, j)| filled.word(i, j, w));
    let [c001, c011, c101, c111] =
        [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)].map(|(i, j)| filled.ahead(i, j, w));
    let only = |pair: u64, others: &[u64]| pair & !others.iter().fold(0, |any, c| any | c);
    [
        (only(c000 & c011, &[c001, c010]), [[0, 0, 0], [0, 1, 1]]),
        (only(c001 & c010, &[c000, c011]), [[0, 0, 1], [0, 1, 0]]),
        (only(c000 & c101, &[c001, c100]), [[0, 0, 0], [1, 0, 1]]),
        (only(c001 & c100, &[c000, c101]), [[0, 0, 1], [1, 0, 0]]),
        (only(c000 & c110, &[c010, c100]), [[0, 0, 0], [1, 1, 0]]),
        (only(c010 & c100, &[c000, c110]), [[0, 1, 0], [1, 0, 0]]),
        (
            only(c000 & c111, &[c001, c010, c011, c100, c101, c110]),
            [[0, 0, 0], [1, 1, 1]],
        ),
        (
            only(c001 & c110, &[c000, c010, c011, c100, c101, c111]),
            [[0, 0, 1], [1, 1, 0]],
        ),
        (
            only(c010 & c101, &[c000, c001, c011, c100, c110, c111]),
            [[0, 1, 0], [1, 0, 1]],
        ),
        (
            only(c011 & c100, &[c000, c001, c010, c101, c110, c111]),
            [[0, 1, 1], [1, 0, 0]],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Finds hinges by their definition, cell by cell.
    fn searched(grid: &Grid) -> Vec<Hinge> {
        let end = grid.shape().map(|n| n as i64);
        let filled = |cell: [i64; 3]| {
            (0..3).all(|a| (0..end[a]).contains(&cell[a]))
                && grid.get(cell.map(|n| n as usize)) != 0
        };
        let mut found = Vec::new();
        for i in 0..end[0] {
            for j in 0..end[1] {
                for k in 0..end[2] {
                    for n in 0..27 {
                        let step = [n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1];
                        let other: [i64; 3] = std::array::from_fn(|a| [i, j, k][a] + step[a]);
                        let axes = step.iter().filter(|&&d| d != 0).count();
                        let later = other > [i, j, k];
                        if axes < 2 || !later || !filled([i, j, k]) || !filled(other) {
                            continue;
                        }
                        // Cells of the box that the two span, without them.
                        let between = (1..7).any(|mask| {
                            let cell: [i64; 3] = std::array::from_fn(|a| {
                                [i, j, k][a] + if mask >> a & 1 == 1 { step[a] } else { 0 }
                            });
                            cell != [i, j, k] && cell != other && filled(cell)
                        });
                        if !between {
                            found.push(Hinge {
                                cells: [[i, j, k], other].map(|c| c.map(|n| n as u32)),
                            });
                        }
                    }
                }
            }
        }
        found.sort_unstable();
        found
    }

    #[test]
    fn hinges_match_a_search_cell_by_cell() {
        for seed in 0..40 {
            let shape = [1 + seed % 5, 1 + seed % 4, 1 + 7 * (seed % 11)];
            let mut grid = Grid::empty(shape, [0.0; 3], 1.0, u64::MAX).unwrap();
            grid.fill_random(0.05 + 0.02 * seed as f64, seed as u64, 1);
            assert_eq!(hinges(&grid), searched(&grid), "seed {seed}");
        }
    }

    #[test]
    fn hinges_report_their_contact() {
        let contact = |cells| Hinge { cells }.contact();
        assert_eq!(contact([[0, 0, 0], [1, 1, 1]]), Contact::Corner);
        assert_eq!(contact([[0, 0, 0], [1, 0, 1]]), Contact::Edge);
    }
}
