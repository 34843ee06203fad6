//! Cavities: enclosed empty regions, the chambers in which pressure can act.
use crate::bits::BitGrid;
use crate::components::{Component, Contact, sort_largest_first};
use crate::grid::Grid;
use crate::runs::LabeledRuns;

/// A cavity: an empty region that no path through faces connects with the outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Cavity {
    /// Its cells.
    pub region: Component,
    /// Its volume (m³).
    pub volume: f64,
    /// Its surface, the faces it shares with filled cells (m²).
    pub area: f64,
}

/// The cavities of a grid, largest first; equal ones by their first cell in C order.
///
/// Everything beyond the grid is outside: an empty region is a cavity if it touches no border of the box. A flood fill
/// of the padded grid gives the same regions.
pub fn cavities(grid: &Grid) -> Vec<Cavity> {
    LabeledCavities::new(grid, &BitGrid::filled(grid)).cavities
}

/// Cavities with a lookup from a cell to its cavity.
pub(crate) struct LabeledCavities {
    pub cavities: Vec<Cavity>,
    runs: LabeledRuns,
    /// Index in `cavities` of each region of empty cells; `None` for those that are outside.
    places: Vec<Option<u32>>,
}

impl LabeledCavities {
    pub fn new(grid: &Grid, filled: &BitGrid) -> Self {
        let runs = LabeledRuns::new(&filled.complement(), Contact::Face);
        let outside = runs.touching_border();
        let inside: Vec<u32> = (0..outside.len())
            .filter(|&label| !outside[label])
            .map(|label| label as u32)
            .collect();
        let regions = runs.to_components(|label| !outside[label as usize]);
        let size = grid.voxel_size();
        let mut numbered: Vec<(u32, Cavity)> = inside
            .into_iter()
            .zip(regions)
            .map(|(label, region)| {
                let volume = region.cell_count() as f64 * size.powi(3);
                let area = exposed_faces(&region, filled) as f64 * size.powi(2);
                (
                    label,
                    Cavity {
                        region,
                        volume,
                        area,
                    },
                )
            })
            .collect();
        sort_largest_first(&mut numbered, |(_, cavity)| cavity.region.cell_count());
        let mut places = vec![None; outside.len()];
        for (place, (label, _)) in numbered.iter().enumerate() {
            places[*label as usize] = Some(place as u32);
        }
        Self {
            cavities: numbered.into_iter().map(|(_, cavity)| cavity).collect(),
            runs,
            places,
        }
    }

    /// Index in `cavities` of the cavity that contains a cell.
    pub fn place(&self, i: usize, j: usize, k: usize) -> Option<u32> {
        let label = self.runs.label(i, j, k)?;
        self.places[label as usize]
    }
}

/// Number of faces between the cells of an enclosed region and filled cells.
fn exposed_faces(region: &Component, filled: &BitGrid) -> u64 {
    region
        .runs()
        .iter()
        .map(|run| {
            let [i, j, first, last] = [run.i, run.j, run.first, run.last].map(usize::from);
            let sides = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)];
            let walls: u32 = sides
                .iter()
                .map(|&(i, j)| filled.count_between(i, j, first, last))
                .sum();
            // Both ends of a maximal run of empty cells are filled.
            u64::from(walls) + 2
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(n: usize) -> Grid {
        Grid::from_cells([n; 3], [0.0; 3], 0.1, vec![1; n.pow(3)]).unwrap()
    }

    #[test]
    fn cavities_come_largest_first_with_volume_and_area() {
        let mut grid = block(9);
        grid.set([7, 7, 7], 0);
        grid.set([1, 1, 1], 0);
        grid.fill_box([0.3; 3], [0.6, 0.5, 0.4], 0);
        let found = cavities(&grid);
        assert_eq!(
            found
                .iter()
                .map(|c| c.region.cell_count())
                .collect::<Vec<_>>(),
            [6, 1, 1]
        );
        assert_eq!(found[0].region.bounds(), [[3, 3, 3], [6, 5, 4]]);
        assert_eq!(found[1].region.bounds()[0], [1, 1, 1]);
        assert!((found[0].volume - 6e-3).abs() < 1e-15);
        assert!((found[0].area - 0.22).abs() < 1e-15);
    }

    #[test]
    fn bore_to_the_outside_leaves_no_cavity() {
        let mut grid = block(5);
        grid.fill_box([0.2, 0.2, 0.1], [0.3, 0.3, 0.4], 0);
        assert_eq!(cavities(&grid).len(), 1);
        grid.set([2, 2, 4], 0);
        assert_eq!(cavities(&grid), []);
    }

    #[test]
    fn gap_along_an_edge_does_not_leak() {
        let mut grid = block(3);
        grid.set([1, 1, 1], 0);
        for (i, j) in [(0, 0), (0, 2), (2, 0), (2, 2)] {
            grid.set([i, j, 1], 0);
        }
        assert_eq!(cavities(&grid).len(), 1);
    }

    #[test]
    fn island_in_a_cavity_belongs_to_its_surface() {
        let mut grid = block(7);
        grid.fill_box([0.1; 3], [0.6; 3], 0);
        grid.set([3, 3, 3], 2);
        let found = cavities(&grid);
        assert_eq!((found.len(), found[0].region.cell_count()), (1, 124));
        assert!((found[0].area - 1.56).abs() < 1e-12);
    }
}
