//! Blocks of cells and their classified contents.

/// Block of cells from `low` (included) to `high` (excluded).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    pub low: [usize; 3],
    pub high: [usize; 3],
}

impl Block {
    pub fn whole(shape: [usize; 3]) -> Self {
        Self {
            low: [0; 3],
            high: shape,
        }
    }

    pub fn shape(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.high[axis] - self.low[axis])
    }

    pub fn cells(&self) -> usize {
        self.shape().iter().product()
    }

    /// Blocks with edges of at most `edge` cells, in C order.
    pub fn split(&self, edge: usize) -> Vec<Self> {
        let starts = |axis: usize| (self.low[axis]..self.high[axis]).step_by(edge);
        let mut blocks = Vec::new();
        for i in starts(0) {
            for j in starts(1) {
                for k in starts(2) {
                    let low = [i, j, k];
                    let high = [0, 1, 2].map(|axis| (low[axis] + edge).min(self.high[axis]));
                    blocks.push(Self { low, high });
                }
            }
        }
        blocks
    }

    /// Index in C order of the first cell of each row along z, within a box of cells that starts at
    /// `origin` and has `shape`.
    pub fn rows(&self, origin: [usize; 3], shape: [usize; 3]) -> impl Iterator<Item = usize> {
        let [low, high] = [self.low, self.high];
        (low[0]..high[0]).flat_map(move |i| {
            (low[1]..high[1]).map(move |j| {
                ((i - origin[0]) * shape[1] + j - origin[1]) * shape[2] + low[2] - origin[2]
            })
        })
    }
}

/// Classified cells of one tile.
pub(crate) struct TileContent {
    pub cells: TileCells,
    /// Cells where the function is NaN
    pub undefined: Vec<[usize; 3]>,
}

pub(crate) enum TileCells {
    /// One value for all cells
    Uniform(u8),
    /// One value for each cell, in C order
    Mixed(Vec<u8>),
}

impl TileContent {
    /// Copies the tile into the cells of the whole lattice.
    pub fn write(&self, tile: &Block, shape: [usize; 3], cells: &mut [u8]) {
        let row = tile.shape()[2];
        for (n, start) in tile.rows([0; 3], shape).enumerate() {
            let target = &mut cells[start..start + row];
            match &self.cells {
                TileCells::Uniform(value) => target.fill(*value),
                TileCells::Mixed(values) => target.copy_from_slice(&values[n * row..][..row]),
            }
        }
    }
}
