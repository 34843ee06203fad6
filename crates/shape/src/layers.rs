//! Tables of the parts of a function that depend on one coordinate only.
use fidget::shape::ShapeVars;
use fidget::types::Interval;
use fidget::var::VarIndex;

use crate::block::Block;
use crate::compiled::Table;
use crate::error::FieldError;
use crate::sample::SampleGrid;
use crate::tape::Tape;

/// Values of the tables of a compiled function, one per layer of cells along an axis.
pub(crate) struct Layers {
    columns: Vec<Column>,
}

struct Column {
    variable: VarIndex,
    axis: usize,
    values: Vec<f32>,
}

impl Layers {
    pub fn new(tables: &[Table], grid: &SampleGrid) -> Result<Self, FieldError> {
        let columns = tables.iter().map(|table| {
            let points: Vec<_> = (0..grid.shape[table.axis])
                .map(|index| [grid.center(table.axis, index); 3])
                .collect();
            let mut values = vec![0.0; points.len()];
            Tape::new(&table.expr).evaluate_into(&points, &mut values)?;
            let values = values.into_iter().map(|value| value as f32).collect();
            Ok(Column {
                variable: table.variable,
                axis: table.axis,
                values,
            })
        });
        Ok(Self {
            columns: columns.collect::<Result<_, _>>()?,
        })
    }

    /// Inserts the range of each table over a block: exact, as only these values are ever used.
    pub fn ranges(&self, block: &Block, ranges: &mut ShapeVars<Interval>) {
        for column in &self.columns {
            let values = &column.values[block.low[column.axis]..block.high[column.axis]];
            let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
            let mut is_defined = true;
            for &value in values {
                low = low.min(value);
                high = high.max(value);
                is_defined &= !value.is_nan();
            }
            let range = if is_defined {
                Interval::new(low, high)
            } else {
                f32::NAN.into()
            };
            ranges.insert(column.variable, range);
        }
    }

    /// Inserts the value of each table in every cell of a block, in C order.
    pub fn place(&self, block: &Block, cells: &mut ShapeVars<Vec<f32>>) {
        for column in &self.columns {
            let mut slice = cells
                .insert(column.variable, Vec::new())
                .unwrap_or_default();
            spread(block, column.axis, |index| column.values[index], &mut slice);
            cells.insert(column.variable, slice);
        }
    }
}

/// Fills `slice` with a value for each cell of a block, in C order, that depends on one index.
pub(crate) fn spread(
    block: &Block,
    axis: usize,
    value: impl Fn(usize) -> f32,
    slice: &mut Vec<f32>,
) {
    slice.clear();
    let [nx, ny, nz] = block.shape();
    let layers = || block.low[axis]..block.high[axis];
    match axis {
        0 => layers().for_each(|i| slice.resize(slice.len() + ny * nz, value(i))),
        1 => (0..nx).for_each(|_| layers().for_each(|j| slice.resize(slice.len() + nz, value(j)))),
        _ => (0..nx * ny).for_each(|_| slice.extend(layers().map(&value))),
    }
}
