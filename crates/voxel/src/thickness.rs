//! Wall thickness of the material, in cells along the axes.
//!
//! A wall that is inclined to the axes is at most √3 times thinner than the shortest row of cells
//! through it; on a thin wall this is the measure that decides how many elements bend.
use crate::bits::BitGrid;
use crate::cavities::LabeledCavities;
use crate::grid::Grid;

/// A wall: its thickness and one of its cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wall {
    /// Thickness in cells.
    pub thickness: u16,
    /// A filled cell of the wall.
    pub cell: [u32; 3],
}

/// Thickness of the material, cell by cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WallThickness {
    /// Thickness at each cell in C order: the shortest of the three rows of filled cells along the axes through it; 0
    /// where empty.
    pub cells: Vec<u16>,
    /// Number of cells of each thickness; entry 0 is 0.
    pub histogram: Vec<u64>,
    /// The first in C order of the thinnest cells that are no bumps; `None` if none is filled.
    ///
    /// A bump is a cell alone in its row along an axis, at whose face lies a block of 2 × 2 × 2 filled cells: the rim of a
    /// disk and the pole of a ball end in rows of one cell, and are no walls.
    pub thinnest: Option<Wall>,
}

/// Computes the thickness of the material at each cell.
///
/// Takes two bytes per cell.
pub fn wall_thickness(grid: &Grid) -> WallThickness {
    let [nx, ny, nz] = grid.shape();
    let filled = |index: usize| grid.cells()[index] != 0;
    let mut cells: Vec<u16> = grid
        .cells()
        .iter()
        .map(|&part| u16::from(part != 0) * u16::MAX)
        .collect();
    // Lines along an axis start `lines` apart by one cell and step by `stride`.
    for plane in 0..nx {
        shorten(&mut cells, plane * ny * nz, ny, nz, nz, &filled);
    }
    for row in 0..ny {
        shorten(&mut cells, row * nz, nx, ny * nz, nz, &filled);
    }
    for row in 0..nx * ny {
        shorten(&mut cells, row * nz, nz, 1, 1, &filled);
    }

    let mut histogram = Vec::new();
    for &thickness in cells.iter().filter(|&&thickness| thickness != 0) {
        let place = usize::from(thickness);
        if place >= histogram.len() {
            histogram.resize(place + 1, 0);
        }
        histogram[place] += 1;
    }
    let cell_at = |index: usize| [index / (ny * nz), index / nz % ny, index % nz];
    let mut thinnest: Option<(u16, usize)> = None;
    for (index, &thickness) in cells.iter().enumerate() {
        if thickness != 0
            && thinnest.is_none_or(|(least, _)| thickness < least)
            && !(thickness == 1 && is_bump(grid, cell_at(index)))
        {
            thinnest = Some((thickness, index));
        }
    }
    let thinnest = thinnest.map(|(thickness, index)| Wall {
        thickness,
        cell: cell_at(index).map(|n| n as u32),
    });
    WallThickness {
        cells,
        histogram,
        thinnest,
    }
}

/// Returns true if a block of 2 × 2 × 2 filled cells lies at a face of a cell.
fn is_bump(grid: &Grid, cell: [usize; 3]) -> bool {
    (0..6).any(|direction| {
        beside(grid, cell, direction / 2, direction % 2 == 1)
            .is_some_and(|near| grid.get(near) != 0 && is_in_block(grid, near))
    })
}

/// Returns true if a filled cell is one of a block of 2 × 2 × 2 of them.
fn is_in_block(grid: &Grid, cell: [usize; 3]) -> bool {
    (0..8).any(|corner| {
        (0..8).all(|part| {
            let mut at = Some(cell);
            for axis in 0..3 {
                if part >> axis & 1 == 1 {
                    at = at.and_then(|at| beside(grid, at, axis, corner >> axis & 1 == 1));
                }
            }
            at.is_some_and(|at| grid.get(at) != 0)
        })
    })
}

/// Returns the next cell along an axis, if it is in the grid.
fn beside(grid: &Grid, mut cell: [usize; 3], axis: usize, forward: bool) -> Option<[usize; 3]> {
    let next = if forward {
        cell[axis].checked_add(1)
    } else {
        cell[axis].checked_sub(1)
    };
    cell[axis] = next.filter(|&n| n < grid.shape()[axis])?;
    Some(cell)
}

/// Updates the thickness by the runs of filled cells in `lines` adjacent lines.
///
/// Line n holds the cells `start + n`, `start + n + stride`, … (`length` of them). The lines are
/// walked together so that memory is read in order.
fn shorten(
    cells: &mut [u16],
    start: usize,
    length: usize,
    stride: usize,
    lines: usize,
    filled: &impl Fn(usize) -> bool,
) {
    let mut run = vec![0_u16; lines];
    for step in 0..=length {
        for (line, run) in run.iter_mut().enumerate() {
            let here = start + line + step * stride;
            if step < length && filled(here) {
                *run += 1;
            } else if *run > 0 {
                for back in 1..=usize::from(*run) {
                    let cell = &mut cells[here - back * stride];
                    *cell = (*cell).min(*run);
                }
                *run = 0;
            }
        }
    }
}

/// Thinnest wall around each cavity, in the order of [`crate::cavities()`].
///
/// A wall is a row of filled cells along an axis with this cavity at one end, and the outside or
/// another cavity at the other.
pub fn cavity_walls(grid: &Grid) -> Vec<Wall> {
    let labeled = LabeledCavities::new(grid, &BitGrid::filled(grid));
    let walls = labeled.cavities.iter().enumerate().map(|(place, cavity)| {
        let mut thinnest: Option<Wall> = None;
        for cell in cavity.region.cells() {
            for direction in 0..6 {
                let most = thinnest.map_or(u16::MAX, |wall| wall.thickness - 1);
                let wall = wall_behind(grid, cell, direction, most);
                if let Some((wall, beyond)) = wall {
                    let other_side = beyond.and_then(|[i, j, k]| labeled.place(i, j, k));
                    if other_side != Some(place as u32) {
                        thinnest = Some(wall);
                    }
                }
            }
        }
        thinnest
    });
    // The outermost cells of a cavity have the outside or another cavity behind their wall.
    walls.flatten().collect()
}

/// Row of filled cells next to an empty cell, if there are 1 to `most` of them, and the empty cell beyond it (`None`
/// outside of the grid). Directions are −x, +x, −y, +y, −z, +z.
fn wall_behind(
    grid: &Grid,
    cell: [u32; 3],
    direction: usize,
    most: u16,
) -> Option<(Wall, Option<[usize; 3]>)> {
    let (axis, forward) = (direction / 2, direction % 2 == 1);
    let mut at = cell.map(|n| n as usize);
    let mut wall: Option<Wall> = None;
    loop {
        let beyond = beside(grid, at, axis, forward);
        match beyond {
            Some(cell) if grid.get(cell) != 0 => {
                let thickness = wall.map_or(1, |wall| wall.thickness + 1);
                if thickness > most {
                    return None;
                }
                let first = wall.map_or(cell.map(|n| n as u32), |wall| wall.cell);
                wall = Some(Wall {
                    thickness,
                    cell: first,
                });
                at = cell;
            }
            _ => return wall.map(|wall| (wall, beyond)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(shape: [usize; 3]) -> Grid {
        Grid::from_cells(shape, [0.0; 3], 1.0, vec![1; shape.iter().product()]).unwrap()
    }

    /// Finds the shortest row through each cell, by walking from it.
    fn walked(grid: &Grid) -> Vec<u16> {
        let [nx, ny, nz] = grid.shape();
        (0..nx * ny * nz)
            .map(|index| {
                let cell = [index / (ny * nz), index / nz % ny, index % nz];
                let reach = |axis: usize, step: isize| {
                    let mut at = cell;
                    let mut count = 0;
                    while at[axis] < grid.shape()[axis] && grid.get(at) != 0 {
                        count += 1;
                        at[axis] = at[axis].wrapping_add_signed(step);
                    }
                    count
                };
                let row = |axis| (reach(axis, 1) + reach(axis, -1)).max(1) - 1;
                (0..3).map(row).min().unwrap_or(0) as u16
            })
            .collect()
    }

    #[test]
    fn thickness_is_the_shortest_row_through_a_cell() {
        for seed in 0..20 {
            let mut grid = Grid::empty([5, 6, 7 + seed], [0.0; 3], 1.0, u64::MAX).unwrap();
            grid.fill_random(0.04 * (seed + 5) as f64, seed as u64, 1);
            let found = wall_thickness(&grid);
            assert_eq!(found.cells, walked(&grid));
            assert_eq!(found.histogram.iter().sum::<u64>() as usize, grid.count());
        }
    }

    #[test]
    fn thinnest_wall_is_reported() {
        let found = wall_thickness(&block([4, 3, 9]));
        assert_eq!(
            found.thinnest,
            Some(Wall {
                thickness: 3,
                cell: [0; 3]
            })
        );
        assert_eq!(found.histogram, [0, 0, 0, 108]);
        let empty = Grid::empty([2; 3], [0.0; 3], 1.0, 8).unwrap();
        assert_eq!(wall_thickness(&empty).thinnest, None);
    }

    /// Cells within a distance of a point in cells, along some axes.
    fn round(shape: [usize; 3], radius: f64, axes: &[usize]) -> Grid {
        let middle = |axis: usize| shape[axis] as f64 / 2.0;
        let mut grid = Grid::empty(shape, [0.0; 3], 1.0, u64::MAX).unwrap();
        for index in 0..shape.iter().product::<usize>() {
            let cell = [
                index / (shape[1] * shape[2]),
                index / shape[2] % shape[1],
                index % shape[2],
            ];
            let away = |&axis: &usize| (cell[axis] as f64 + 0.5 - middle(axis)).powi(2);
            if axes.iter().map(away).sum::<f64>() <= radius * radius {
                grid.set(cell, 1);
            }
        }
        grid
    }

    #[test]
    fn rims_and_poles_of_round_bodies_are_no_walls() {
        for tenths in 20..120 {
            let radius = f64::from(tenths) / 10.0;
            for size in [24, 25] {
                let ball = round([size; 3], radius, &[0, 1, 2]);
                let disk = round([size, 5, size], radius, &[0, 2]);
                for (body, name) in [(ball, "ball"), (disk, "disk")] {
                    let thickness = wall_thickness(&body).thinnest.unwrap().thickness;
                    assert!(thickness > 1, "{name} of {radius} in {size}");
                }
            }
        }
    }

    #[test]
    fn wall_of_one_cell_beside_a_block_is_a_wall() {
        let mut grid = block([6, 6, 9]);
        grid.fill_box([1.0, 0.0, 4.0], [6.0, 6.0, 9.0], 0);
        let found = wall_thickness(&grid).thinnest;
        let cell = [0, 0, 5];
        assert_eq!(found, Some(Wall { thickness: 1, cell }));
    }

    #[test]
    fn walls_are_measured_from_cavity_to_outside_or_to_cavity() {
        let mut grid = block([9, 9, 12]);
        grid.fill_box([3.0, 3.0, 3.0], [6.0, 6.0, 6.0], 0);
        grid.fill_box([3.0, 3.0, 8.0], [6.0, 7.0, 10.0], 0);
        // Adds an island: the rows across the first cavity that end at it are not walls.
        grid.set([4, 4, 4], 1);
        let walls = cavity_walls(&grid);
        assert_eq!(
            walls.iter().map(|wall| wall.thickness).collect::<Vec<_>>(),
            [2, 2]
        );
        assert_eq!([walls[0].cell, walls[1].cell], [[3, 3, 6], [3, 3, 7]]);
    }
}
