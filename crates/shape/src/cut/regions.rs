//! Regions that the small cubes of a cell belong to: that of the nearest empty cell.
use super::{ALL, CUBES, place};

/// A small cube belongs to the nearest empty cell no more cells away than this.
pub const REACH: usize = 2;

const WIDTH: usize = 2 * REACH + 1;

/// Cells of the window around a cell, in C order.
pub const WINDOW: usize = WIDTH * WIDTH * WIDTH;

/// Differences of squared distances, in cells, that are rounding.
const ALIKE: f64 = 1e-9;

/// The region of each small cube, from the regions of the cells in the window around its cell; cells below −1 are none.
/// Where no cell is empty it is −1, the outside, and of regions equally far the lowest.
///
/// ```
/// use voxsoft_shape::cut::{WINDOW, nearest_region};
///
/// let mut window = [-2; WINDOW];
/// window[62 + 1] = 0; // above along z
/// window[62 - 1] = -1; // below
/// let regions = nearest_region(&window);
/// assert_eq!(regions[..4], [-1, -1, 0, 0]);
/// ```
#[must_use]
pub fn nearest_region(window: &[i16; WINDOW]) -> [i16; ALL] {
    let mut empty: Vec<(i16, [f64; 3])> = Vec::new();
    for (index, &region) in window.iter().enumerate() {
        if region >= -1 {
            let at = [
                index / (WIDTH * WIDTH),
                index / WIDTH % WIDTH,
                index % WIDTH,
            ];
            empty.push((region, at.map(|i| i as f64 - REACH as f64)));
        }
    }
    empty.sort_by_key(|&(region, _)| region);
    std::array::from_fn(|cube| {
        let middle = place(cube).map(|i| (i as f64 + 0.5) / CUBES as f64);
        let mut nearest = (-1, f64::INFINITY);
        for &(region, low) in &empty {
            let gaps = [0, 1, 2].map(|a| {
                let gap: f64 = (low[a] - middle[a]).max(middle[a] - low[a] - 1.0);
                gap.max(0.0)
            });
            let square = gaps.iter().map(|gap| gap * gap).sum::<f64>();
            if square < nearest.1 - ALIKE {
                nearest = (region, square);
            }
        }
        nearest.0
    })
}
