//! Voxel grid: a box of cells, each empty (0) or of one part (1..=255).
use thiserror::Error;

/// Largest number of cells of a grid along one axis: ends of runs are stored in 16 bits, with room for some padding.
pub const MAX_CELLS_PER_AXIS: usize = 65_000;

/// Tolerance in voxels within which two positions on the lattice count as the same.
pub(crate) const LATTICE_TOLERANCE: f64 = 1e-6;

/// Error of making a grid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GridError {
    /// An axis without cells, or with more than [`MAX_CELLS_PER_AXIS`].
    #[error("the grid has {shape:?} cells; each axis needs 1 to {MAX_CELLS_PER_AXIS}")]
    Shape {
        /// Requested shape.
        shape: [usize; 3],
    },
    /// A voxel size that is not a positive number.
    #[error("the voxel size is {0} m; it must be positive and finite")]
    VoxelSize(f64),
    /// An origin that is not finite, or too many voxels away from zero to be numbered.
    #[error("the origin is {0:?} m; it must be finite and within 2^30 voxels of zero")]
    Origin([f64; 3]),
    /// A number of cells that does not match the shape.
    #[error("{found} cells were given for a grid of {shape:?} = {expected} cells")]
    CellCount {
        /// Requested shape.
        shape: [usize; 3],
        /// The product of the shape.
        expected: usize,
        /// The length of the given list.
        found: usize,
    },
    /// The grid exceeds the memory limit; checked before allocation.
    #[error("a grid of {shape:?} cells needs {bytes} bytes, the limit is {limit}")]
    TooLarge {
        /// Requested shape.
        shape: [usize; 3],
        /// Memory of the cells in bytes.
        bytes: u64,
        /// Given limit in bytes.
        limit: u64,
    },
}

/// A box of cubic cells, each empty (0) or of part 1..=255, one byte per cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    shape: [usize; 3],
    /// Position of lattice node (0, 0, 0) (m), within half a voxel of the world's origin.
    base: [f64; 3],
    /// Lattice index of the first cell.
    offset: [i32; 3],
    voxel_size: f64,
    cells: Vec<u8>,
}

impl Grid {
    /// Makes an empty grid of `shape` cells of side `voxel_size` (m), with its lower corner at `origin` (m).
    ///
    /// # Errors
    ///
    /// [`GridError`], among others [`GridError::TooLarge`] when the cells need more than
    /// `memory_limit` bytes (`u64::MAX` for no limit).
    pub fn empty(
        shape: [usize; 3],
        origin: [f64; 3],
        voxel_size: f64,
        memory_limit: u64,
    ) -> Result<Self, GridError> {
        let bytes = cell_count(shape)? as u64;
        if bytes > memory_limit {
            return Err(GridError::TooLarge {
                shape,
                bytes,
                limit: memory_limit,
            });
        }
        Self::from_cells(shape, origin, voxel_size, vec![0; bytes as usize])
    }

    /// Makes a grid of given cells in C order (the last index runs fastest).
    ///
    /// An origin within 1e-6 of a whole number of voxels is rounded to it: designs with the same voxel size then share
    /// the lattice, independent of their rounding.
    ///
    /// # Errors
    ///
    /// [`GridError`] if sizes are not positive, not finite, or do not match.
    pub fn from_cells(
        shape: [usize; 3],
        origin: [f64; 3],
        voxel_size: f64,
        cells: Vec<u8>,
    ) -> Result<Self, GridError> {
        let expected = cell_count(shape)?;
        if cells.len() != expected {
            return Err(GridError::CellCount {
                shape,
                expected,
                found: cells.len(),
            });
        }
        if !(voxel_size.is_finite() && voxel_size > 0.0) {
            return Err(GridError::VoxelSize(voxel_size));
        }
        let nearest = origin.map(|x| (x / voxel_size).round());
        // Two bits of headroom: offset + index + 1 must stay within i32.
        if !nearest.iter().all(|&n| n.abs() <= f64::from(1 << 30)) {
            return Err(GridError::Origin(origin));
        }
        let base = std::array::from_fn(|a| {
            let rest = origin[a] - nearest[a] * voxel_size;
            if rest.abs() < LATTICE_TOLERANCE * voxel_size {
                0.0
            } else {
                rest
            }
        });
        Ok(Self {
            shape,
            base,
            offset: nearest.map(|n| n as i32),
            voxel_size,
            cells,
        })
    }

    /// Makes a grid on the same lattice with another box; `shape` must match the number of `cells`.
    pub(crate) fn on_same_lattice(
        &self,
        offset: [i32; 3],
        shape: [usize; 3],
        cells: Vec<u8>,
    ) -> Self {
        debug_assert_eq!(cells.len(), shape.iter().product::<usize>());
        Self {
            shape,
            offset,
            cells,
            ..*self
        }
    }

    /// Number of cells along x, y and z.
    pub fn shape(&self) -> [usize; 3] {
        self.shape
    }

    /// Side of a cell (m).
    pub fn voxel_size(&self) -> f64 {
        self.voxel_size
    }

    /// Lower corner of the grid (m).
    pub fn origin(&self) -> [f64; 3] {
        self.node_position(self.offset)
    }

    /// Index of the first cell on the infinite lattice that contains the grid.
    pub fn lattice_offset(&self) -> [i32; 3] {
        self.offset
    }

    /// The part of every cell in C order, 0 where empty.
    pub fn cells(&self) -> &[u8] {
        &self.cells
    }

    pub(crate) fn cells_mut(&mut self) -> &mut [u8] {
        &mut self.cells
    }

    /// Takes the cells, in C order, out of the grid.
    pub fn into_cells(self) -> Vec<u8> {
        self.cells
    }

    /// The part of a cell, 0 where empty.
    ///
    /// # Panics
    ///
    /// If `cell` lies outside the grid.
    pub fn get(&self, cell: [usize; 3]) -> u8 {
        self.cells[self.index(cell)]
    }

    /// Assigns a cell to `part`, or empties it with 0.
    ///
    /// # Panics
    ///
    /// If `cell` lies outside the grid.
    pub fn set(&mut self, cell: [usize; 3], part: u8) {
        let index = self.index(cell);
        self.cells[index] = part;
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, nz] = self.shape;
        assert!(
            i < nx && j < ny && k < nz,
            "cell {:?} outside {:?}",
            [i, j, k],
            self.shape
        );
        (i * ny + j) * nz + k
    }

    /// Position of a lattice node (m).
    pub fn node_position(&self, node: [i32; 3]) -> [f64; 3] {
        std::array::from_fn(|a| self.base[a] + self.voxel_size * f64::from(node[a]))
    }

    /// Position of a cell's center (m).
    pub fn cell_center(&self, cell: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|a| {
            let steps = f64::from(self.offset[a]) + cell[a] as f64 + 0.5;
            self.base[a] + self.voxel_size * steps
        })
    }

    /// Number of filled cells.
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|&&part| part != 0).count()
    }

    /// Number of cells of each part id; entry 0 counts the empty ones.
    pub fn part_counts(&self) -> [u64; 256] {
        let mut counts = [0; 256];
        for &part in &self.cells {
            counts[usize::from(part)] += 1;
        }
        counts
    }

    /// Volume of the filled cells (m³).
    pub fn volume(&self) -> f64 {
        self.count() as f64 * self.voxel_size.powi(3)
    }

    /// Center of mass of the filled cells (m) for equal densities; `None` for an empty grid.
    ///
    /// Sums whole indices, so the result does not depend on the order of summation.
    pub fn center_of_mass(&self) -> Option<[f64; 3]> {
        let [_, ny, nz] = self.shape;
        let (mut count, mut sums) = (0_u64, [0_u64; 3]);
        for (row, cells) in self.cells.chunks_exact(nz).enumerate() {
            let (mut in_row, mut sum_k) = (0_u64, 0_u64);
            for (k, _) in cells.iter().enumerate().filter(|&(_, &part)| part != 0) {
                in_row += 1;
                sum_k += k as u64;
            }
            count += in_row;
            sums[0] += in_row * (row / ny) as u64;
            sums[1] += in_row * (row % ny) as u64;
            sums[2] += sum_k;
        }
        (count > 0).then(|| {
            std::array::from_fn(|a| {
                let mean = sums[a] as f64 / count as f64 + f64::from(self.offset[a]) + 0.5;
                self.base[a] + self.voxel_size * mean
            })
        })
    }

    /// First and one-past-last filled cell along each axis; `None` for an empty grid.
    pub fn content(&self) -> Option<[[usize; 3]; 2]> {
        let [_, ny, nz] = self.shape;
        let (mut lower, mut upper) = ([usize::MAX; 3], [0; 3]);
        for (row, cells) in self.cells.chunks_exact(nz).enumerate() {
            let Some(first) = cells.iter().position(|&part| part != 0) else {
                continue;
            };
            let last = cells.iter().rposition(|&part| part != 0).unwrap_or(first);
            let (from, to) = ([row / ny, row % ny, first], [row / ny, row % ny, last]);
            for axis in 0..3 {
                lower[axis] = lower[axis].min(from[axis]);
                upper[axis] = upper[axis].max(to[axis] + 1);
            }
        }
        (upper[0] > 0).then_some([lower, upper])
    }
}

fn cell_count(shape: [usize; 3]) -> Result<usize, GridError> {
    // The bound on each axis keeps the product under 2^48, so it cannot overflow 64 bits; on a
    // 32-bit target (the browser) it still could.
    let allowed = shape.iter().all(|&n| (1..=MAX_CELLS_PER_AXIS).contains(&n));
    let product = shape[0]
        .checked_mul(shape[1])
        .and_then(|n| n.checked_mul(shape[2]));
    product
        .filter(|_| allowed)
        .ok_or(GridError::Shape { shape })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_large_grid_is_refused_before_allocation() {
        let refused = Grid::empty([60_000; 3], [0.0; 3], 1e-3, 1 << 30);
        assert!(matches!(
            refused,
            Err(GridError::TooLarge {
                bytes: 216_000_000_000_000,
                ..
            })
        ));
    }

    #[test]
    fn impossible_sizes_are_refused() {
        assert!(matches!(
            Grid::empty([0, 1, 1], [0.0; 3], 1e-3, 9),
            Err(GridError::Shape { .. })
        ));
        for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let refused = Grid::empty([1; 3], [0.0; 3], size, 9);
            assert!(matches!(refused, Err(GridError::VoxelSize(_))), "{size}");
        }
        let refused = Grid::empty([1; 3], [f64::NAN, 0.0, 0.0], 1.0, 9);
        assert!(matches!(refused, Err(GridError::Origin(_))));
        let refused = Grid::from_cells([2, 1, 1], [0.0; 3], 1.0, vec![1]);
        assert_eq!(
            refused.unwrap_err(),
            GridError::CellCount {
                shape: [2, 1, 1],
                expected: 2,
                found: 1
            }
        );
    }

    #[test]
    fn rounded_origin_snaps_to_the_lattice() {
        let grid = Grid::empty([1; 3], [0.1 + 0.2, 0.0, -0.3], 0.1, 9).unwrap();
        assert_eq!(grid.lattice_offset(), [3, 0, -3]);
        assert_eq!(grid.base, [0.0; 3]);
        let between = Grid::empty([1; 3], [0.13, 0.0, 0.0], 0.1, 9).unwrap();
        assert!((between.origin()[0] - 0.13).abs() < 1e-15);
    }

    #[test]
    fn content_and_center_of_mass() {
        let mut grid = Grid::empty([4, 5, 6], [0.0; 3], 0.5, 1000).unwrap();
        assert_eq!((grid.content(), grid.center_of_mass()), (None, None));
        grid.set([1, 2, 3], 7);
        grid.set([2, 2, 5], 1);
        assert_eq!(grid.content(), Some([[1, 2, 3], [3, 3, 6]]));
        assert_eq!(grid.center_of_mass(), Some([1.0, 1.25, 2.25]));
        assert_eq!((grid.count(), grid.volume()), (2, 0.25));
        assert_eq!((grid.part_counts()[7], grid.part_counts()[0]), (1, 118));
    }
}
