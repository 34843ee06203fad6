//! Connected components of cells.
use crate::bits::BitGrid;
use crate::grid::Grid;
use crate::runs::LabeledRuns;

/// Contact that connects two cells: through faces, edges or corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// Through a face: 6 neighbors. The material of a component is solidly connected.
    Face,
    /// Through a face or an edge: 18 neighbors. A component may hang on a hinge line.
    Edge,
    /// Through a face, an edge or a corner: 26 neighbors. A component may hang on a point.
    Corner,
}

/// A run of cells (i, j, first..=last) of the array, in eight bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellRun {
    /// First index.
    pub i: u16,
    /// Second index.
    pub j: u16,
    /// Third index of the first cell.
    pub first: u16,
    /// Third index of the last cell.
    pub last: u16,
}

/// A connected component of cells, stored as runs along z in C order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    runs: Vec<CellRun>,
    cell_count: u64,
    lower: [u32; 3],
    upper: [u32; 3],
}

impl Component {
    /// Makes a component of at least one run; runs come in C order.
    pub(crate) fn from_runs(runs: Vec<CellRun>) -> Self {
        let (mut lower, mut upper, mut cell_count) = ([u32::MAX; 3], [0; 3], 0);
        for run in &runs {
            cell_count += u64::from(run.last - run.first) + 1;
            let from = [run.i, run.j, run.first].map(u32::from);
            let to = [run.i, run.j, run.last].map(u32::from);
            for axis in 0..3 {
                lower[axis] = lower[axis].min(from[axis]);
                upper[axis] = upper[axis].max(to[axis] + 1);
            }
        }
        Self {
            runs,
            cell_count,
            lower,
            upper,
        }
    }

    /// The cells as runs along z, in C order.
    pub fn runs(&self) -> &[CellRun] {
        &self.runs
    }

    /// Number of cells.
    pub fn cell_count(&self) -> u64 {
        self.cell_count
    }

    /// The cells one by one, in C order.
    pub fn cells(&self) -> impl Iterator<Item = [u32; 3]> {
        self.runs
            .iter()
            .flat_map(|run| (run.first..=run.last).map(move |k| [run.i, run.j, k].map(u32::from)))
    }

    /// First and one-past-last cell of the bounding box along each axis.
    pub fn bounds(&self) -> [[u32; 3]; 2] {
        [self.lower, self.upper]
    }
}

/// The connected components of the filled cells, largest first; equal ones by their first cell in C order.
///
/// Parts are not distinguished: two parts that touch are one component.
pub fn components(grid: &Grid, contact: Contact) -> Vec<Component> {
    let mut components = LabeledRuns::new(&BitGrid::filled(grid), contact).to_components(|_| true);
    sort_largest_first(&mut components, |component| component.cell_count());
    components
}

/// Sorts by size; the sort is stable, so equal ones keep the C order of their first cells.
pub(crate) fn sort_largest_first<T>(regions: &mut [T], size: impl Fn(&T) -> u64) {
    regions.sort_by_key(|region| std::cmp::Reverse(size(region)));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(filled: &[[usize; 3]]) -> Grid {
        let mut grid = Grid::empty([3; 3], [0.0; 3], 1.0, 27).unwrap();
        for &cell in filled {
            grid.set(cell, 1);
        }
        grid
    }

    #[test]
    fn contact_distinguishes_faces_edges_and_corners() {
        let count = |grid: &Grid| {
            [Contact::Face, Contact::Edge, Contact::Corner].map(|c| components(grid, c).len())
        };
        assert_eq!(count(&cells(&[[1, 1, 1], [1, 1, 2]])), [1, 1, 1]);
        assert_eq!(count(&cells(&[[1, 1, 1], [1, 2, 2]])), [2, 1, 1]);
        assert_eq!(count(&cells(&[[1, 1, 1], [2, 0, 1]])), [2, 1, 1]);
        assert_eq!(count(&cells(&[[1, 1, 1], [2, 0, 2]])), [2, 2, 1]);
        assert_eq!(count(&cells(&[[1, 1, 1], [0, 0, 0]])), [2, 2, 1]);
        assert_eq!(count(&cells(&[[0, 0, 0], [2, 0, 0]])), [2, 2, 2]);
        assert_eq!(count(&cells(&[])), [0, 0, 0]);
    }

    #[test]
    fn largest_component_comes_first() {
        let components = components(
            &cells(&[[0, 0, 0], [2, 2, 1], [2, 2, 2], [0, 2, 0]]),
            Contact::Face,
        );
        let first: Vec<_> = components
            .iter()
            .map(|component| component.cells().next().unwrap())
            .collect();
        assert_eq!(first, [[2, 2, 1], [0, 0, 0], [0, 2, 0]]);
        assert_eq!(components[0].bounds(), [[2, 2, 1], [3, 3, 3]]);
    }
}
