//! Classification of a tile by one thread: interval pruning, then evaluation of the remaining cells.
use fidget::eval::{Function, MathFunction};
use fidget::shape::ShapeVars;
use fidget::types::Interval;

use crate::block::{Block, TileCells, TileContent};
use crate::compiled::{FloatEval, IntervalEval, Part};
use crate::error::SampleError;
use crate::layers::{Layers, spread};
use crate::range::Range;
use crate::sample::{INSIDE, OUTSIDE, SampleGrid, TIED, verdict};
use crate::shape::Shape;
use crate::tape::Tape;

/// Block edges below the tile, largest first.
const EDGES: [usize; 2] = [16, 8];

/// Block edges for sampled fields: the distance to a large mesh costs 0.1 ms for one point and a fifth of it in a
/// batch, so small blocks are sampled as a whole.
const SAMPLED_EDGES: [usize; 2] = [16, 4];

/// An error bound is inherited by smaller blocks while it is below this part of the range of
/// values.
const SHARP: f64 = 1e-4;

/// Tape, compiled code and tables of a shape, shared by the threads.
pub(crate) struct Classifier<F: Function> {
    tape: Tape,
    compiled: Option<Part<F>>,
    layers: Layers,
    grid: SampleGrid,
    /// Bound on |s| for a center on the surface, m
    tie: f64,
}

impl<F: MathFunction> Classifier<F> {
    pub fn new(shape: &Shape, grid: &SampleGrid, tie: f64) -> Result<Self, SampleError> {
        let (compiled, tables) = match Part::compile(&shape.expr) {
            Some((part, tables)) => (Some(part), tables),
            None => (None, vec![]),
        };
        Ok(Self {
            tape: Tape::new(&shape.expr),
            compiled,
            layers: Layers::new(&tables, grid)?,
            grid: *grid,
            tie,
        })
    }

    fn verdict(&self, low: f64, high: f64) -> Option<u8> {
        verdict(low, high, self.tie)
    }

    /// Range of the cell centers of a block along each axis, m.
    fn extent(&self, block: &Block) -> [Range; 3] {
        [0, 1, 2].map(|axis| {
            let center = |index| self.grid.center(axis, index);
            Range::new(center(block.low[axis]), center(block.high[axis] - 1))
        })
    }
}

/// Evaluators and buffers of one thread.
pub(crate) struct Worker<F: Function> {
    intervals: IntervalEval<F>,
    floats: FloatEval<F>,
    workspace: F::Workspace,
    ranges: Vec<Range>,
    layer_ranges: ShapeVars<Interval>,
    layer_values: ShapeVars<Vec<f32>>,
    singles: [Vec<f32>; 3],
    /// Cells of the leaf that need float64, as positions in the tile
    doubtful: Vec<usize>,
    points: Vec<[f64; 3]>,
    values: Vec<f64>,
}

/// The tile being filled.
struct Canvas {
    tile: Block,
    cells: Vec<u8>,
    undefined: Vec<[usize; 3]>,
}

impl Canvas {
    fn fill(&mut self, block: &Block, value: u8) {
        let row = block.shape()[2];
        for start in block.rows(self.tile.low, self.tile.shape()) {
            self.cells[start..start + row].fill(value);
        }
    }

    /// Indices in the sample grid of the cell at a position in the tile.
    fn index(&self, position: usize) -> [usize; 3] {
        let [_, ny, nz] = self.tile.shape();
        let local = [position / (ny * nz), position / nz % ny, position % nz];
        [0, 1, 2].map(|axis| self.tile.low[axis] + local[axis])
    }
}

impl<F: MathFunction> Worker<F> {
    pub fn new() -> Self {
        Self {
            intervals: IntervalEval::<F>::default(),
            floats: FloatEval::<F>::default(),
            workspace: F::Workspace::default(),
            ranges: Vec::new(),
            layer_ranges: ShapeVars::default(),
            layer_values: ShapeVars::default(),
            singles: [const { Vec::new() }; 3],
            doubtful: Vec::new(),
            points: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Classifies the cells of `tile`.
    pub fn classify(
        &mut self,
        of: &Classifier<F>,
        tile: Block,
    ) -> Result<TileContent, SampleError> {
        let range = of.tape.range(&of.extent(&tile), &mut self.ranges)?;
        if let Some(value) = of.verdict(range.low, range.high) {
            return Ok(TileContent {
                cells: TileCells::Uniform(value),
                undefined: vec![],
            });
        }
        let mut canvas = Canvas {
            tile,
            cells: vec![0; tile.cells()],
            undefined: vec![],
        };
        let edges: &[usize] = if of.compiled.is_some() {
            &EDGES
        } else {
            &SAMPLED_EDGES
        };
        self.open(of, &tile, of.compiled.as_ref(), range, edges, &mut canvas)?;
        let Canvas {
            cells, undefined, ..
        } = canvas;
        Ok(TileContent {
            cells: TileCells::Mixed(cells),
            undefined,
        })
    }

    /// Decides a block by fidget's intervals, or continues with the function simplified there.
    fn open(
        &mut self,
        of: &Classifier<F>,
        block: &Block,
        part: Option<&Part<F>>,
        range: Range,
        edges: &[usize],
        canvas: &mut Canvas,
    ) -> Result<(), SampleError> {
        let Some(part) = part else {
            return self.descend(of, block, None, range, edges, canvas);
        };
        let [x, y, z] = of
            .extent(block)
            .map(|r| Interval::new(r.low as f32, r.high as f32));
        of.layers.ranges(block, &mut self.layer_ranges);
        let (values, trace) = self
            .intervals
            .eval_with_vars(&part.intervals, x, y, z, &self.layer_ranges)
            .expect("every variable is a table");
        let margin = range.error;
        let (low, high) = (f64::from(values.lower()), f64::from(values.upper()));
        if let Some(value) = of.verdict(low - margin, high + margin) {
            canvas.fill(block, value);
            return Ok(());
        }
        // The last level is evaluated only once: compiling a simpler function for it does not pay off.
        let simpler = match trace {
            Some(trace) if !edges.is_empty() => part.simplify(trace, &mut self.workspace),
            _ => None,
        };
        self.descend(
            of,
            block,
            Some(simpler.as_ref().unwrap_or(part)),
            range,
            edges,
            canvas,
        )
    }

    /// Splits a block, or evaluates its cells when it is of the smallest size.
    fn descend(
        &mut self,
        of: &Classifier<F>,
        block: &Block,
        part: Option<&Part<F>>,
        range: Range,
        edges: &[usize],
        canvas: &mut Canvas,
    ) -> Result<(), SampleError> {
        let Some((&edge, finer)) = edges.split_first() else {
            return self.evaluate(of, block, part, range.error, canvas);
        };
        // Written so that an infinite or unknown range is not sharp.
        let is_sharp = range.error < SHARP * (range.high - range.low) && range.error.is_finite();
        for child in block.split(edge) {
            let mut child_range = range;
            if part.is_none() || !is_sharp {
                child_range = of.tape.range(&of.extent(&child), &mut self.ranges)?;
                if let Some(value) = of.verdict(child_range.low, child_range.high) {
                    canvas.fill(&child, value);
                    continue;
                }
            }
            // A field without a known range is sampled in one batch: it may be a Python function.
            let is_opaque = part.is_none() && child_range.high - child_range.low == f64::INFINITY;
            let finer = if is_opaque { &[] } else { finer };
            self.open(of, &child, part, child_range, finer, canvas)?;
        }
        Ok(())
    }

    /// Evaluates every cell of a block: in f32 where that is certain enough, else in float64.
    fn evaluate(
        &mut self,
        of: &Classifier<F>,
        block: &Block,
        part: Option<&Part<F>>,
        error: f64,
        canvas: &mut Canvas,
    ) -> Result<(), SampleError> {
        self.doubtful.clear();
        let row = block.shape()[2];
        let starts = block.rows(canvas.tile.low, canvas.tile.shape());
        match part {
            Some(part) if error.is_finite() => {
                for (axis, slice) in self.singles.iter_mut().enumerate() {
                    spread(
                        block,
                        axis,
                        |index| of.grid.center(axis, index) as f32,
                        slice,
                    );
                }
                of.layers.place(block, &mut self.layer_values);
                let [x, y, z] = &self.singles;
                let values = self
                    .floats
                    .eval_with_var_arrays(&part.floats, x, y, z, &self.layer_values)
                    .expect("slices of one length, and every variable is a table");
                let (inside, outside) = ((-of.tie - error) as f32, (of.tie + error) as f32);
                for (values, start) in values.chunks_exact(row).zip(starts) {
                    for (position, &value) in (start..).zip(values) {
                        canvas.cells[position] = if value < inside { INSIDE } else { OUTSIDE };
                        // Written so that NaN and the rounded limits themselves are doubtful too.
                        if !(value < inside || value > outside) {
                            self.doubtful.push(position);
                        }
                    }
                }
            }
            _ => self
                .doubtful
                .extend(starts.flat_map(|start| start..start + row)),
        }
        self.evaluate_doubtful(of, canvas)
    }

    fn evaluate_doubtful(
        &mut self,
        of: &Classifier<F>,
        canvas: &mut Canvas,
    ) -> Result<(), SampleError> {
        if self.doubtful.is_empty() {
            return Ok(());
        }
        self.points.clear();
        self.points.extend(self.doubtful.iter().map(|&position| {
            let index = canvas.index(position);
            [0, 1, 2].map(|axis| of.grid.center(axis, index[axis]))
        }));
        self.values.resize(self.points.len(), 0.0);
        of.tape.evaluate_into(&self.points, &mut self.values)?;
        for (&position, &value) in self.doubtful.iter().zip(&self.values) {
            canvas.cells[position] = of.verdict(value, value).unwrap_or(TIED);
            if value.is_nan() {
                canvas.undefined.push(canvas.index(position));
            }
        }
        Ok(())
    }
}
