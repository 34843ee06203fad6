//! Leaks: chambers that are not closed, and the openings through which air would escape.
//!
//! A flood fill only shows that there is no cavity. A chamber with a hole is found by the size of the hole: a cube of w
//! × w × w cells fits into the chamber, but cannot get out by moving in steps of one cell. With w = 2 all openings are
//! one cell wide in some direction, with w = 3 at most two.
//!
//! Let E be the empty cells, C those that such captured cubes can cover, and O the part of E \ C that is connected with
//! the outside. The components of E \ O that touch O are the open chambers, side channels and chambers behind other
//! chambers included; the cells of O that they touch are their openings. Components that do not touch O are cavities.
use crate::bits::BitGrid;
use crate::components::{CellRun, Component, Contact, sort_largest_first};
use crate::grid::Grid;
use crate::runs::LabeledRuns;

/// A chamber with openings to the outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Leak {
    /// Its cells, up to the openings.
    pub region: Component,
    /// Its volume (m³).
    pub volume: f64,
    /// Largest width of its openings in one direction, in cells.
    pub width: usize,
    /// First cell in C order of each opening where it meets the chamber.
    pub openings: Vec<[u32; 3]>,
}

/// The chambers whose openings are at most `max_width` cells wide, largest first.
///
/// A chamber must be wider than its openings to differ from a bore: at least two cells in each direction for openings
/// of one. Regions with openings wider than `max_width` count as outside. Open lattices have chambers in this sense
/// wherever a pore is wider than its entrances.
pub fn leaks(grid: &Grid, max_width: usize) -> Vec<Leak> {
    let mut found: Vec<Leak> = Vec::new();
    for width in 1..=max_width {
        let wider = leaks_of_width(grid, width);
        let known: Vec<Component> = found.iter().map(|leak| leak.region.clone()).collect();
        found.extend(
            wider
                .into_iter()
                .filter(|leak| !known.iter().any(|r| share_cell(r, &leak.region))),
        );
    }
    sort_largest_first(&mut found, |leak| leak.region.cell_count());
    found
}

fn leaks_of_width(grid: &Grid, width: usize) -> Vec<Leak> {
    // Padding lets the cube move around the grid.
    let cube = width + 1;
    let empty = padded_empty(grid, cube);
    let outside = |runs: &LabeledRuns| runs.label(0, 0, 0);

    let cubes = LabeledRuns::new(&eroded(&empty, cube - 1), Contact::Face);
    let free = outside(&cubes);
    let captured = covered(&cubes, |label| Some(label) != free, empty.shape(), cube);
    let ways = LabeledRuns::new(&empty.without(&captured), Contact::Face);
    let open = outside(&ways);
    let outer = covered(&ways, |label| Some(label) == open, empty.shape(), 1);

    let volume = grid.voxel_size().powi(3);
    LabeledRuns::new(&empty.without(&outer), Contact::Face)
        .to_components(|_| true)
        .into_iter()
        .filter_map(|region| {
            let openings = openings(&region, &outer, cube);
            let region =
                Component::from_runs(region.runs().iter().map(|&run| unpad(run, cube)).collect());
            let volume = region.cell_count() as f64 * volume;
            (!openings.is_empty()).then_some(Leak {
                region,
                volume,
                width,
                openings,
            })
        })
        .collect()
}

/// Empty cells of the grid with a margin of empty cells around it.
fn padded_empty(grid: &Grid, margin: usize) -> BitGrid {
    let mut filled = BitGrid::new(grid.shape().map(|n| n + 2 * margin));
    let inner = BitGrid::filled(grid);
    for i in 0..grid.shape()[0] {
        for j in 0..grid.shape()[1] {
            inner.for_each_run(i, j, |first, last| {
                filled.insert_between(i + margin, j + margin, first + margin, last + margin);
            });
        }
    }
    filled.complement()
}

fn unpad(run: CellRun, margin: usize) -> CellRun {
    let margin = margin as u16;
    CellRun {
        i: run.i - margin,
        j: run.j - margin,
        first: run.first - margin,
        last: run.last - margin,
    }
}

/// Erosion: the lowest cells of the cubes of `steps + 1` cells a side that fit into the set.
fn eroded(bits: &BitGrid, steps: usize) -> BitGrid {
    let mut fitting = bits.clone();
    for _ in 0..steps {
        let mut next = BitGrid::new(fitting.shape());
        for i in 0..fitting.shape()[0] {
            for j in 0..fitting.shape()[1] {
                let (x, y) = (i as isize, j as isize);
                for (w, word) in next.row_mut(i, j).iter_mut().enumerate() {
                    *word = [(x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1)]
                        .map(|(i, j)| fitting.word(i, j, w) & fitting.ahead(i, j, w))
                        .iter()
                        .fold(u64::MAX, |all, word| all & word);
                }
            }
        }
        fitting = next;
    }
    fitting
}

/// Cells of cubes of `cube` cells a side whose lowest cell is in a region that `keep` selects.
fn covered(
    runs: &LabeledRuns,
    keep: impl Fn(u32) -> bool,
    shape: [usize; 3],
    cube: usize,
) -> BitGrid {
    let mut cells = BitGrid::new(shape);
    for (run, _) in runs.iter().filter(|&(_, label)| keep(label)) {
        let [i, j, first, last] = [run.i, run.j, run.first, run.last].map(usize::from);
        for i in i..i + cube {
            for j in j..j + cube {
                cells.insert_between(i, j, first, last + cube - 1);
            }
        }
    }
    cells
}

/// One cell of `outer` for each opening of a chamber, in the indices of the grid.
///
/// Chambers never reach the border of the padded box, so all neighbors exist.
fn openings(chamber: &Component, outer: &BitGrid, margin: usize) -> Vec<[u32; 3]> {
    let mut mouths: Vec<[usize; 3]> = Vec::new();
    for run in chamber.runs() {
        let [i, j, first, last] = [run.i, run.j, run.first, run.last].map(usize::from);
        let ends = [[i, j, first - 1], [i, j, last + 1]];
        let sides = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)];
        let along = sides
            .iter()
            .flat_map(|&(i, j)| (first..=last).map(move |k| [i, j, k]));
        mouths.extend(
            ends.into_iter()
                .chain(along)
                .filter(|&[i, j, k]| outer.get(i, j, k)),
        );
    }
    let Some(&first) = mouths.first() else {
        return Vec::new();
    };
    // Groups the cells that touch, within a box around them.
    let (mut lower, mut upper) = (first, first);
    for mouth in &mouths {
        lower = std::array::from_fn(|a| lower[a].min(mouth[a]));
        upper = std::array::from_fn(|a| upper[a].max(mouth[a]));
    }
    let mut set = BitGrid::new(std::array::from_fn(|a| upper[a] - lower[a] + 1));
    for [i, j, k] in mouths {
        set.insert_between(i - lower[0], j - lower[1], k - lower[2], k - lower[2]);
    }
    LabeledRuns::new(&set, Contact::Corner)
        .to_components(|_| true)
        .iter()
        .filter_map(|group| group.cells().next())
        .map(|cell| std::array::from_fn(|a| cell[a] + (lower[a] - margin) as u32))
        .collect()
}

/// True if two regions have a cell in common; both list their runs in C order.
fn share_cell(a: &Component, b: &Component) -> bool {
    let (mut a, mut b) = (a.runs().iter().peekable(), b.runs().iter().peekable());
    while let (Some(p), Some(q)) = (a.peek(), b.peek()) {
        let (row_p, row_q) = ((p.i, p.j), (q.i, q.j));
        if row_p == row_q && p.first <= q.last && q.first <= p.last {
            return true;
        }
        if (row_p, p.last) < (row_q, q.last) {
            a.next();
        } else {
            b.next();
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cavities;

    /// Block of 12³ cells with a chamber of 6³ in it.
    fn chamber() -> Grid {
        let mut grid = Grid::from_cells([12; 3], [0.0; 3], 1.0, vec![1; 12 * 12 * 12]).unwrap();
        grid.fill_box([3.0; 3], [9.0; 3], 0);
        grid
    }

    #[test]
    fn closed_chamber_does_not_leak() {
        assert_eq!(
            (leaks(&chamber(), 2), cavities(&chamber()).len()),
            (vec![], 1)
        );
        let solid = Grid::from_cells([3; 3], [0.0; 3], 1.0, vec![1; 27]).unwrap();
        assert_eq!(leaks(&solid, 2), []);
    }

    #[test]
    fn bore_is_located_where_it_meets_the_chamber() {
        let mut grid = chamber();
        grid.fill_box([5.0, 4.0, 9.0], [6.0, 5.0, 12.0], 0);
        let found = leaks(&grid, 2);
        assert_eq!((found.len(), cavities(&grid).len()), (1, 0));
        assert_eq!((found[0].region.cell_count(), found[0].width), (216, 1));
        assert_eq!(found[0].openings, [[5, 4, 9]]);
        assert!((found[0].volume - 216.0).abs() < 1e-12);
    }

    #[test]
    fn every_opening_is_reported_once() {
        let mut grid = chamber();
        grid.fill_box([0.0, 4.0, 5.0], [3.0, 5.0, 8.0], 0); // a slot
        grid.fill_box([9.0, 4.0, 5.0], [12.0, 5.0, 6.0], 0); // a bore
        grid.fill_box([4.0, 9.0, 4.0], [5.0, 11.0, 5.0], 0); // a blind hole
        let found = leaks(&grid, 2);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].openings, [[2, 4, 5], [9, 4, 5]]);
        assert_eq!(found[0].region.cell_count(), 218);
    }

    #[test]
    fn leak_depends_on_the_width_of_the_opening() {
        let open_by = |width: f64| {
            let mut grid = chamber();
            grid.fill_box([4.0, 4.0, 9.0], [4.0 + width, 4.0 + width, 12.0], 0);
            let widths = |max| {
                leaks(&grid, max)
                    .iter()
                    .map(|leak| leak.width)
                    .collect::<Vec<_>>()
            };
            [widths(1), widths(2), widths(3)]
        };
        assert_eq!(open_by(1.0), [vec![1], vec![1], vec![1]]);
        assert_eq!(open_by(2.0), [vec![], vec![2], vec![2]]);
        assert_eq!(open_by(3.0), [vec![], vec![], vec![3]]);
        assert_eq!(open_by(4.0), [vec![], vec![], vec![]]);
    }

    #[test]
    fn chambers_joined_by_channels_leak_together() {
        let mut grid = Grid::from_cells([12, 12, 24], [0.0; 3], 1.0, vec![1; 3456]).unwrap();
        grid.fill_box([3.0; 3], [9.0; 3], 0);
        grid.fill_box([3.0, 3.0, 14.0], [9.0, 9.0, 20.0], 0);
        grid.fill_box([5.0, 5.0, 9.0], [6.0, 6.0, 14.0], 0);
        grid.fill_box([5.0, 5.0, 20.0], [6.0, 6.0, 24.0], 0);
        let found = leaks(&grid, 1);
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].region.cell_count(), &found[0].openings[..]),
            (437, &[[5, 5, 20]][..])
        );
    }

    #[test]
    fn cup_is_not_a_chamber() {
        let mut grid = chamber();
        grid.fill_box([3.0; 3], [9.0, 9.0, 12.0], 0);
        assert_eq!(leaks(&grid, 2), []);
    }
}
