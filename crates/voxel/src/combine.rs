//! Set operations between grids, and shifts of a grid on its cell lattice.
use thiserror::Error;

use crate::grid::{Grid, LATTICE_TOLERANCE, MAX_CELLS_PER_AXIS};

/// Error of combining two grids or of changing a grid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CombineError {
    /// The grids have cells of different sizes.
    #[error("the grids have voxels of {0} m and {1} m; they must be equal")]
    VoxelSize(f64, f64),
    /// The grids lie a fraction of a voxel apart.
    #[error("the grids are shifted by {0:?} voxels against each other; only whole numbers align")]
    Lattice([f64; 3]),
    /// The result would have too many cells along an axis.
    #[error("the result would have {0:?} cells; each axis may have {MAX_CELLS_PER_AXIS}")]
    Shape([usize; 3]),
    /// The result would exceed the memory limit; checked before allocation.
    #[error("a grid of {shape:?} cells needs {bytes} bytes, the limit is {limit}")]
    TooLarge {
        /// The shape of the result.
        shape: [usize; 3],
        /// Memory of its cells in bytes.
        bytes: u64,
        /// Given limit in bytes.
        limit: u64,
    },
    /// A move would leave the range of lattice indices.
    #[error("the grid would lie more than 2^30 voxels away from the origin")]
    TooFar,
    /// Cropping a grid without content.
    #[error("the grid is empty: there is nothing to crop to")]
    Empty,
}

impl Grid {
    /// Union: the cells of either grid, in a box that contains both; where both are filled, `self` wins.
    ///
    /// # Errors
    ///
    /// [`CombineError`] if the grids are not on one lattice, or the box that holds both is too
    /// large for `memory_limit` bytes (`u64::MAX` for no limit).
    pub fn union(&self, other: &Self, memory_limit: u64) -> Result<Self, CombineError> {
        let step = self.steps_to(other)?;
        let before: [usize; 3] = step.map(|s| (-s).max(0) as usize);
        let after = std::array::from_fn(|a| {
            let reach = step[a] + other.shape()[a] as i64 - self.shape()[a] as i64;
            reach.max(0) as usize
        });
        let mut union = self.padded(before, after, memory_limit)?;
        let nz = union.shape()[2];
        for (row, from) in other.cells().chunks_exact(other.shape()[2]).enumerate() {
            let [i, j] = [row / other.shape()[1], row % other.shape()[1]];
            let at = |a: usize, n: usize| (n as i64 + step[a].max(0)) as usize;
            let start = (at(0, i) * union.shape()[1] + at(1, j)) * nz + at(2, 0);
            for (cell, &part) in union.cells_mut()[start..start + from.len()]
                .iter_mut()
                .zip(from)
            {
                if *cell == 0 {
                    *cell = part;
                }
            }
        }
        Ok(union)
    }

    /// Intersection: the cells of `self` that are filled in `other` too, with the parts of `self`.
    ///
    /// # Errors
    ///
    /// [`CombineError`] if the grids are not on one lattice.
    pub fn intersection(&self, other: &Self) -> Result<Self, CombineError> {
        self.keep_where(other, true)
    }

    /// Difference: the cells of `self` that are empty in `other`.
    ///
    /// # Errors
    ///
    /// [`CombineError`] if the grids are not on one lattice.
    pub fn difference(&self, other: &Self) -> Result<Self, CombineError> {
        self.keep_where(other, false)
    }

    fn keep_where(&self, other: &Self, filled: bool) -> Result<Self, CombineError> {
        let step = self.steps_to(other)?;
        let [_, ny, nz] = self.shape();
        let mut kept = self.clone();
        for (index, cell) in kept
            .cells_mut()
            .iter_mut()
            .enumerate()
            .filter(|(_, c)| **c != 0)
        {
            let here = [index / (ny * nz), index / nz % ny, index % nz];
            let there: [i64; 3] = std::array::from_fn(|a| here[a] as i64 - step[a]);
            let inside = (0..3).all(|a| (0..other.shape()[a] as i64).contains(&there[a]));
            if (inside && other.get(there.map(|n| n as usize)) != 0) != filled {
                *cell = 0;
            }
        }
        Ok(kept)
    }

    /// Number of voxels from the first cell of `self` to the first cell of `other`.
    fn steps_to(&self, other: &Self) -> Result<[i64; 3], CombineError> {
        let size = self.voxel_size();
        if (size - other.voxel_size()).abs() > 1e-12 * size {
            return Err(CombineError::VoxelSize(size, other.voxel_size()));
        }
        let apart: [f64; 3] =
            std::array::from_fn(|a| (other.origin()[a] - self.origin()[a]) / size);
        if apart
            .iter()
            .any(|steps| (steps - steps.round()).abs() > 2.0 * LATTICE_TOLERANCE)
        {
            return Err(CombineError::Lattice(apart));
        }
        Ok(apart.map(|steps| steps.round() as i64))
    }

    /// Mirror image of the content inside the same box, along axis 0, 1 or 2.
    ///
    /// # Panics
    ///
    /// If `axis` is greater than 2.
    pub fn flipped(&self, axis: usize) -> Self {
        let mut flipped = self.clone();
        // Along an axis, cells come in chunks of the size `inner`; reversing the chunks mirrors the axis.
        let inner: usize = self.shape()[axis + 1..].iter().product();
        let slab = inner * self.shape()[axis];
        let slabs = flipped
            .cells_mut()
            .chunks_exact_mut(slab)
            .zip(self.cells().chunks_exact(slab));
        for (to, from) in slabs {
            for (to, from) in to
                .chunks_exact_mut(inner)
                .zip(from.chunks_exact(inner).rev())
            {
                to.copy_from_slice(from);
            }
        }
        flipped
    }

    /// The grid moved in space by whole voxels.
    ///
    /// # Errors
    ///
    /// [`CombineError::TooFar`] if it would leave the range of lattice indices.
    pub fn shifted(&self, steps: [i32; 3]) -> Result<Self, CombineError> {
        Ok(self.on_same_lattice(
            self.moved_offset(steps)?,
            self.shape(),
            self.cells().to_vec(),
        ))
    }

    /// The grid with empty cells added before and after each axis; the content stays in place.
    ///
    /// # Errors
    ///
    /// [`CombineError`] if the result is too large for an axis or for `memory_limit` bytes.
    pub fn padded(
        &self,
        before: [usize; 3],
        after: [usize; 3],
        memory_limit: u64,
    ) -> Result<Self, CombineError> {
        let old = self.shape();
        let shape: [usize; 3] =
            std::array::from_fn(|a| old[a].saturating_add(before[a]).saturating_add(after[a]));
        if shape.iter().any(|&n| n > MAX_CELLS_PER_AXIS) {
            return Err(CombineError::Shape(shape));
        }
        let bytes = shape.iter().map(|&n| n as u64).product();
        if bytes > memory_limit || usize::try_from(bytes).is_err() {
            return Err(CombineError::TooLarge {
                shape,
                bytes,
                limit: memory_limit,
            });
        }
        let offset = self.moved_offset(before.map(|n| -(n as i32)))?;
        let mut cells = vec![0; bytes as usize];
        for (row, from) in self.cells().chunks_exact(old[2]).enumerate() {
            let [i, j] = [row / old[1] + before[0], row % old[1] + before[1]];
            let start = (i * shape[1] + j) * shape[2] + before[2];
            cells[start..start + old[2]].copy_from_slice(from);
        }
        Ok(self.on_same_lattice(offset, shape, cells))
    }

    /// The smallest grid that holds all filled cells; they stay in place.
    ///
    /// # Errors
    ///
    /// [`CombineError::Empty`] if no cell is filled.
    pub fn cropped(&self) -> Result<Self, CombineError> {
        let [lower, upper] = self.content().ok_or(CombineError::Empty)?;
        let shape: [usize; 3] = std::array::from_fn(|a| upper[a] - lower[a]);
        let offset = self.moved_offset(lower.map(|n| n as i32))?;
        let [_, ny, nz] = self.shape();
        let mut cells = Vec::with_capacity(shape.iter().product());
        for i in lower[0]..upper[0] {
            for j in lower[1]..upper[1] {
                let row = (i * ny + j) * nz;
                cells.extend_from_slice(&self.cells()[row + lower[2]..row + upper[2]]);
            }
        }
        Ok(self.on_same_lattice(offset, shape, cells))
    }

    fn moved_offset(&self, steps: [i32; 3]) -> Result<[i32; 3], CombineError> {
        let mut offset = self.lattice_offset();
        for (index, step) in offset.iter_mut().zip(steps) {
            let moved = index
                .checked_add(step)
                .filter(|moved| moved.unsigned_abs() <= 1 << 30);
            *index = moved.ok_or(CombineError::TooFar)?;
        }
        Ok(offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four cells of parts 1 to 4 in a row along x, y or z.
    fn row(axis: usize) -> Grid {
        let mut shape = [1; 3];
        shape[axis] = 4;
        Grid::from_cells(shape, [0.2, 0.0, 0.0], 0.1, vec![1, 2, 3, 4]).unwrap()
    }

    #[test]
    fn first_grid_wins_in_a_union() {
        let other = row(0).shifted([2, 0, 0]).unwrap();
        let union = row(0).union(&other, u64::MAX).unwrap();
        assert_eq!(union.cells(), [1, 2, 3, 4, 3, 4]);
        assert_eq!(union.lattice_offset(), [2, 0, 0]);
        let union = other.union(&row(0), u64::MAX).unwrap();
        assert_eq!(union.cells(), [1, 2, 1, 2, 3, 4]);
        assert_eq!(union.lattice_offset(), [2, 0, 0]);
    }

    #[test]
    fn union_spans_all_axes() {
        let union = row(1)
            .union(&row(2).shifted([-1, 2, -3]).unwrap(), u64::MAX)
            .unwrap();
        assert_eq!(union.shape(), [2, 4, 4]);
        assert_eq!(union.lattice_offset(), [1, 0, -3]);
        assert_eq!([0, 1, 2, 3].map(|j| union.get([1, j, 3])), [1, 2, 3, 4]);
        assert_eq!([0, 1, 2, 3].map(|k| union.get([0, 2, k])), [1, 2, 3, 4]);
        assert_eq!(union.count(), 8);
    }

    #[test]
    fn intersection_and_difference_split_a_grid() {
        let other = row(0).shifted([1, 0, 0]).unwrap();
        assert_eq!(row(0).intersection(&other).unwrap().cells(), [0, 2, 3, 4]);
        assert_eq!(row(0).difference(&other).unwrap().cells(), [1, 0, 0, 0]);
    }

    #[test]
    fn grids_off_the_lattice_do_not_combine() {
        let finer = Grid::from_cells([1; 3], [0.0; 3], 0.05, vec![1]).unwrap();
        assert_eq!(
            row(0).union(&finer, u64::MAX),
            Err(CombineError::VoxelSize(0.1, 0.05))
        );
        let between = Grid::from_cells([1; 3], [0.03, 0.0, 0.0], 0.1, vec![1]).unwrap();
        assert!(matches!(
            row(0).difference(&between),
            Err(CombineError::Lattice(_))
        ));
    }

    #[test]
    fn flipping_twice_changes_nothing() {
        let mut grid = Grid::empty([3, 4, 5], [0.0; 3], 1.0, 99).unwrap();
        grid.fill_random(0.5, 4, 1);
        for axis in 0..3 {
            assert_eq!(row(axis).flipped(axis).cells(), [4, 3, 2, 1]);
            assert_eq!(row(axis).flipped((axis + 1) % 3), row(axis));
            assert_eq!(grid.flipped(axis).flipped(axis), grid);
        }
    }

    #[test]
    fn cropping_undoes_padding() {
        let padded = row(1).padded([1, 0, 2], [0, 3, 1], u64::MAX).unwrap();
        assert_eq!(padded.shape(), [2, 7, 4]);
        assert_eq!(padded.cell_center([1, 0, 2]), row(1).cell_center([0; 3]));
        assert_eq!(padded.cropped().unwrap(), row(1));
        let nothing = Grid::empty([2; 3], [0.0; 3], 1.0, 8).unwrap();
        assert_eq!(nothing.cropped(), Err(CombineError::Empty));
    }

    #[test]
    fn results_that_do_not_fit_are_refused() {
        assert!(matches!(
            row(0).padded([0; 3], [65_000, 0, 0], u64::MAX),
            Err(CombineError::Shape(_))
        ));
        assert!(matches!(
            row(0).padded([0; 3], [60_000; 3], 1 << 30),
            Err(CombineError::TooLarge { .. })
        ));
        assert_eq!(row(0).shifted([i32::MAX, 0, 0]), Err(CombineError::TooFar));
    }
}
