//! Sums over the facets of the surface in cells.
//!
//! Small cubes give facets of the surface: one in each that the surface cuts, with the normal of its plane, and one
//! between each full and empty pair, with that of their common face.
use super::{ALL, CUBES, STEPS, place};

/// Powers of x, y, z in the sums of a cell: of degree 3, then of degree 4.
pub const POWERS: [[usize; 3]; 25] = powers();

/// Sums of a cell, of the monomials of [`POWERS`].
pub type FacetSums = [f64; 25];

/// A small cube counts as cut in full from this part on, and up to the rest of it.
const CUT: f64 = 0.125;

/// Neighbors of some cells by their numbers, below and above along each axis; negative for none.
#[derive(Debug, Clone, Copy)]
pub struct Neighbors<'a> {
    /// Cells at the faces of each, whose small cubes end its surface.
    pub beyond: &'a [[[i32; 2]; 3]],
    /// Cells that take the facets of each in front of material of their own.
    pub behind: &'a [[[i32; 2]; 3]],
    /// Marks of cells that give facets to those behind them; the others keep all.
    pub gives: &'a [bool],
}

/// The sums of all cells: a facet belongs to its cell by the depth of the material behind it there, and with the rest to
/// the cell behind: a film at the face of a voxel ends the next voxel, as if it were not there.
pub(super) fn facets(
    filled: &[[f64; ALL]],
    units: &[[[f64; 3]; ALL]],
    neighbors: Neighbors<'_>,
) -> Vec<FacetSums> {
    let of_cell = |cell: usize| {
        let mut sums = CellSums::default();
        sums.add_within(&filled[cell], &units[cell]);
        for (axis, sides) in neighbors.beyond[cell].iter().enumerate() {
            for (side, &other) in sides.iter().enumerate() {
                if let Ok(other) = usize::try_from(other) {
                    sums.add_common(axis, side, &filled[cell], &units[cell], &filled[other]);
                }
            }
        }
        sums
    };
    #[cfg(feature = "threads")]
    let each: Vec<CellSums> = {
        use rayon::prelude::*;
        (0..filled.len()).into_par_iter().map(of_cell).collect()
    };
    #[cfg(not(feature = "threads"))]
    let each: Vec<CellSums> = (0..filled.len()).map(of_cell).collect();
    let mut found = vec![[0.0; 25]; filled.len()];
    for (cell, sums) in each.iter().enumerate() {
        add(&mut found[cell], &sums.own);
        for (axis, sides) in sums.rest.iter().enumerate() {
            for (side, rest) in sides.iter().enumerate() {
                let behind = neighbors.behind[cell][axis][1 - side];
                let taker = usize::try_from(behind).ok();
                let taker = taker.filter(|_| neighbors.gives[cell]).unwrap_or(cell);
                add(&mut found[taker], rest);
            }
        }
    }
    found
}

fn add(sums: &mut FacetSums, more: &FacetSums) {
    for (sum, more) in sums.iter_mut().zip(more) {
        *sum += more;
    }
}

/// Sums of one cell: its own, and those in front of material of the next one, by the way that facets look.
#[derive(Default)]
struct CellSums {
    own: FacetSums,
    rest: [[FacetSums; 2]; 3],
}

impl CellSums {
    /// Adds the facets in the small cubes of the cell and between them.
    fn add_within(&mut self, filled: &[f64; ALL], units: &[[f64; 3]; ALL]) {
        for cube in 0..ALL {
            let unit = units[cube];
            for axis in 0..3 {
                let area = cut(filled[cube]) * unit[axis] * unit[axis];
                let side = usize::from(unit[axis] > 0.0);
                self.add(axis, side, area, unit, depth(filled, cube, axis, side));
                for side in 0..2 {
                    let at = place(cube)[axis];
                    let other = match side {
                        0 if at > 0 => cube - STEPS[axis],
                        1 if at + 1 < CUBES => cube + STEPS[axis],
                        _ => continue,
                    };
                    let behind = depth(filled, cube, axis, side);
                    self.add_face(axis, side, [filled[cube], filled[other]], unit, behind);
                }
            }
        }
    }

    /// Adds the facets at the common face with another cell.
    fn add_common(
        &mut self,
        axis: usize,
        side: usize,
        filled: &[f64; ALL],
        units: &[[f64; 3]; ALL],
        other: &[f64; ALL],
    ) {
        let far = (CUBES - 1) * STEPS[axis];
        for cube in (0..ALL).filter(|&cube| place(cube)[axis] == side * (CUBES - 1)) {
            let beyond = if side == 0 { cube + far } else { cube - far };
            let behind = depth(filled, cube, axis, side);
            self.add_face(
                axis,
                side,
                [filled[cube], other[beyond]],
                units[cube],
                behind,
            );
        }
    }

    /// Adds the facet between a small cube and one that is less full.
    fn add_face(
        &mut self,
        axis: usize,
        side: usize,
        [own, other]: [f64; 2],
        unit: [f64; 3],
        depth: f64,
    ) {
        let area = (1.0 - cut(own)) * (1.0 - cut(other)) * (own - other).max(0.0);
        let way = if side == 0 { -1.0 } else { 1.0 };
        // A cube in a corner has the normal of one of its faces alone.
        let normal = if unit[axis] * way > 0.5 {
            unit
        } else {
            let mut straight = [0.0; 3];
            straight[axis] = way;
            straight
        };
        self.add(axis, side, area, normal, depth);
    }

    fn add(&mut self, axis: usize, side: usize, area: f64, normal: [f64; 3], depth: f64) {
        if area == 0.0 {
            return;
        }
        let area = area / (CUBES * CUBES) as f64;
        let mut powers = [[1.0; 5]; 3];
        for (of_axis, n) in powers.iter_mut().zip(normal) {
            for degree in 1..5 {
                of_axis[degree] = of_axis[degree - 1] * n;
            }
        }
        let rest = &mut self.rest[axis][side];
        for (number, [a, b, c]) in POWERS.into_iter().enumerate() {
            let facet = area * powers[0][a] * powers[1][b] * powers[2][c];
            self.own[number] += facet * depth;
            rest[number] += facet * (1.0 - depth);
        }
    }
}

fn cut(filled: f64) -> f64 {
    (filled.min(1.0 - filled) / CUT).clamp(0.0, 1.0)
}

/// Material behind a surface in a small cube that looks down (0) or up (1) an axis, in edges of the cell.
fn depth(filled: &[f64; ALL], cube: usize, axis: usize, side: usize) -> f64 {
    let at = place(cube)[axis];
    let low = cube - at * STEPS[axis];
    let behind = if side == 0 { at..CUBES } else { 0..at + 1 };
    behind.map(|i| filled[low + i * STEPS[axis]]).sum::<f64>() / CUBES as f64
}

const fn powers() -> [[usize; 3]; 25] {
    let mut found = [[0; 3]; 25];
    let mut number = 0;
    let mut degree = 3;
    while degree <= 4 {
        let mut a = degree + 1;
        while a > 0 {
            a -= 1;
            let mut b = degree - a + 1;
            while b > 0 {
                b -= 1;
                found[number] = [a, b, degree - a - b];
                number += 1;
            }
        }
        degree += 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_all_monomials_of_degree_three_and_four() {
        assert_eq!(POWERS[0], [3, 0, 0]);
        assert_eq!(POWERS[10], [4, 0, 0]);
        assert_eq!(POWERS[24], [0, 0, 4]);
        let degrees = POWERS.map(|powers| powers.iter().sum::<usize>());
        assert_eq!(degrees.iter().filter(|&&degree| degree == 3).count(), 10);
    }
}
