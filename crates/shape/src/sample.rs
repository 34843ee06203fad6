//! Classification of the cells of a grid: inside or outside of a shape at their centers.
//!
//! A cell is inside when s < −t at its center and outside when s > t, in float64. Between them the center lies on the
//! surface within rounding, a [`TIED`] cell: the caller decides it (`python/voxsoft/shapes/ties.py`).
//!
//! Blocks of cells are decided together where interval arithmetic proves one sign; the others are split, each with the
//! function simplified there, and the smallest are evaluated by compiled f32 code (grids of few cells in float64). A
//! cell whose f32 value lies within the error bound of [`crate::range`] is evaluated again in float64, so the result
//! equals a float64 evaluation of every cell.
use std::sync::atomic::{AtomicBool, Ordering};

use fidget::eval::MathFunction;

use crate::block::Block;
use crate::compiled::Interpreted;
#[cfg(all(feature = "jit", not(target_arch = "wasm32")))]
use crate::compiled::{MachineCode, runs_machine_code};
use crate::error::SampleError;
use crate::shape::Shape;
use crate::tape::Tape;
use crate::worker::{Classifier, Worker};

/// Cells along the edge of the blocks handed to threads.
const TILE: usize = 64;

/// A cell whose center is outside.
pub const OUTSIDE: u8 = 0;
/// A cell whose center is inside.
pub const INSIDE: u8 = 1;
/// A cell whose center lies on the surface.
pub const TIED: u8 = 2;

/// Number of float64 operations, over all cells, that take no longer than compiling the function.
const FEW_OPERATIONS: u128 = 100_000;

/// Cells in space: cell (i, j, k) is the cube from `origin + size·(i, j, k)` with edge `size`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleGrid {
    /// Lowest corner of cell (0, 0, 0), m
    pub origin: [f64; 3],
    /// Edge of a cell, m
    pub voxel_size: f64,
    /// Cells along x, y, z
    pub shape: [usize; 3],
}

impl SampleGrid {
    /// Number of cells.
    pub fn cells(&self) -> u128 {
        self.shape.iter().map(|&n| n as u128).product()
    }

    /// Center of a cell along one axis, m.
    pub fn center(&self, axis: usize, index: usize) -> f64 {
        self.origin[axis] + (index as f64 + 0.5) * self.voxel_size
    }

    fn center_of(&self, cell: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.center(axis, cell[axis]))
    }

    /// Estimate of the memory of [`sample`] in bytes: the cells, and the tiles before they are put
    /// together.
    pub fn memory(&self) -> u128 {
        2 * self.cells()
    }

    fn check(&self, memory_limit: u64) -> Result<(), SampleError> {
        if !(self.voxel_size.is_finite() && self.voxel_size > 0.0) {
            return Err(SampleError::BadLattice {
                name: "voxel_size",
                value: self.voxel_size,
            });
        }
        if let Some(&value) = self.origin.iter().find(|v| !v.is_finite()) {
            return Err(SampleError::BadLattice {
                name: "origin",
                value,
            });
        }
        let bytes = self.memory();
        if bytes > u128::from(memory_limit) {
            return Err(SampleError::TooLarge {
                shape: self.shape,
                bytes,
                limit: memory_limit,
            });
        }
        Ok(())
    }
}

/// Classifies each cell, in C order (x slowest), by its center: [`INSIDE`], [`OUTSIDE`], or [`TIED`] where the value is
/// within `tie` (m) of zero.
///
/// The result does not depend on the number of threads. `cancel` stops the work early.
///
/// # Errors
/// [`SampleError`]: a grid that is unusable or needs more than `memory_limit` bytes, a function
/// without a value.
///
/// ```
/// use std::sync::atomic::AtomicBool;
/// use voxsoft_shape::{SampleGrid, primitives, sample};
/// let ball = primitives::sphere([0.0; 3], 1.0)?;
/// let grid = SampleGrid { origin: [-1.0; 3], voxel_size: 0.1, shape: [20; 3] };
/// let cells = sample(&ball, &grid, 1e-10, u64::MAX, &AtomicBool::new(false))?;
/// let volume = cells.iter().filter(|&&c| c == 1).count() as f64 * 1e-3;
/// assert!((volume - 4.189).abs() < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sample(
    shape: &Shape,
    grid: &SampleGrid,
    tie: f64,
    memory_limit: u64,
    cancel: &AtomicBool,
) -> Result<Vec<u8>, SampleError> {
    grid.check(memory_limit)?;
    let tape = Tape::new(&shape.expr);
    if !tape.has_fields() && grid.cells() * tape.len() as u128 <= FEW_OPERATIONS {
        return evaluate_all(&tape, grid, tie);
    }
    #[cfg(all(feature = "jit", not(target_arch = "wasm32")))]
    if runs_machine_code() {
        return sample_by::<MachineCode>(shape, grid, tie, cancel);
    }
    sample_by::<Interpreted>(shape, grid, tie, cancel)
}

/// Runs [`sample`] with one of fidget's evaluators.
fn sample_by<F: MathFunction>(
    shape: &Shape,
    grid: &SampleGrid,
    tie: f64,
    cancel: &AtomicBool,
) -> Result<Vec<u8>, SampleError> {
    let classifier = Classifier::<F>::new(shape, grid, tie)?;
    let tiles = Block::whole(grid.shape).split(TILE);
    let done = for_each_tile(&tiles, |worker, tile| {
        if cancel.load(Ordering::Relaxed) {
            return Err(SampleError::Canceled);
        }
        worker.classify(&classifier, *tile)
    })?;

    let mut cells = vec![0; grid.cells() as usize];
    let mut undefined: Vec<[usize; 3]> = Vec::new();
    for (tile, content) in tiles.iter().zip(done) {
        content.write(tile, grid.shape, &mut cells);
        undefined.extend(content.undefined);
    }
    match undefined.iter().min() {
        Some(first) => Err(not_a_number(grid.center_of(*first), undefined.len())),
        None => Ok(cells),
    }
}

/// Samples by evaluating every cell in float64.
fn evaluate_all(tape: &Tape, grid: &SampleGrid, tie: f64) -> Result<Vec<u8>, SampleError> {
    let [nx, ny, nz] = grid.shape;
    let mut centers = Vec::with_capacity(nx * ny * nz);
    for i in 0..nx {
        for j in 0..ny {
            centers.extend((0..nz).map(|k| grid.center_of([i, j, k])));
        }
    }
    let mut values = vec![0.0; centers.len()];
    tape.evaluate_into(&centers, &mut values)?;
    let mut undefined = (0..values.len()).filter(|&cell| values[cell].is_nan());
    if let Some(first) = undefined.next() {
        return Err(not_a_number(centers[first], 1 + undefined.count()));
    }
    Ok(values
        .iter()
        .map(|s| verdict(*s, *s, tie).unwrap_or(TIED))
        .collect())
}

/// Class of all cells with values between two bounds; `None` if it is undecided.
pub(crate) fn verdict(low: f64, high: f64, tie: f64) -> Option<u8> {
    if high < -tie {
        Some(INSIDE)
    } else if low > tie {
        Some(OUTSIDE)
    } else {
        None
    }
}

fn not_a_number(at: [f64; 3], count: usize) -> SampleError {
    SampleError::NotANumber { count, at }
}

#[cfg(feature = "threads")]
fn for_each_tile<F: MathFunction, T: Send>(
    tiles: &[Block],
    work: impl Fn(&mut Worker<F>, &Block) -> Result<T, SampleError> + Sync,
) -> Result<Vec<T>, SampleError> {
    use rayon::prelude::*;
    tiles
        .par_iter()
        .map_init(Worker::new, |worker, tile| work(worker, tile))
        .collect()
}

#[cfg(not(feature = "threads"))]
fn for_each_tile<F: MathFunction, T>(
    tiles: &[Block],
    work: impl Fn(&mut Worker<F>, &Block) -> Result<T, SampleError>,
) -> Result<Vec<T>, SampleError> {
    let mut worker = Worker::new();
    tiles.iter().map(|tile| work(&mut worker, tile)).collect()
}

#[cfg(all(test, feature = "jit", not(target_arch = "wasm32")))]
mod tests {
    use super::*;
    use crate::operators::intersection;
    use crate::parse;
    use crate::primitives;

    /// Checks the fallback for processors without the instructions of the machine code.
    #[test]
    fn interpreter_agrees_with_machine_code() {
        let ball = primitives::sphere([0.0; 3], 0.02).unwrap();
        let waves = "sin(x/a)*cos(y/a) + sin(y/a)*cos(z/a) + sin(z/a)*cos(x/a)";
        let gyroid = Shape::unknown(parse(&waves.replace('a', "0.0013")).unwrap());
        let shape = intersection(&[ball, gyroid]).unwrap();
        let grid = SampleGrid {
            origin: [-0.021; 3],
            voxel_size: 0.0007,
            shape: [60; 3],
        };
        let go_on = AtomicBool::new(false);
        let interpreted = sample_by::<Interpreted>(&shape, &grid, 1e-12, &go_on).unwrap();
        assert!(interpreted.contains(&1) && interpreted.contains(&0));
        if runs_machine_code() {
            let compiled = sample_by::<MachineCode>(&shape, &grid, 1e-12, &go_on).unwrap();
            assert!(compiled == interpreted);
        }
    }
}
