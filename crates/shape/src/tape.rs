//! Tape: an expression as a list of operations, evaluated in float64.
use std::collections::HashMap;
use std::sync::Arc;

use crate::error::FieldError;
use crate::expr::{Binary, Expr, Node, Unary};
use crate::field::Field;
use crate::range::Range;

/// Points evaluated together: few enough that the intermediate values stay in cache.
const CHUNK: usize = 256;

/// One operation; numbers refer to earlier operations.
#[derive(Clone, Debug)]
pub enum Step {
    /// A coordinate or another variable
    Axis(usize),
    /// A number
    Constant(f64),
    /// A function of one value
    Unary(Unary, usize),
    /// A function of two values
    Binary(Binary, usize, usize),
    /// A sampled field at the point of three values
    Field(Arc<dyn Field>, [usize; 3]),
}

/// An expression ready to evaluate; equal subexpressions appear once.
#[derive(Clone, Debug)]
pub struct Tape {
    steps: Vec<Step>,
}

#[derive(PartialEq, Eq, Hash)]
enum StepKey {
    Axis(usize),
    Constant(u64),
    Unary(Unary, usize),
    Binary(Binary, usize, usize),
    Field(*const (), [usize; 3]),
}

impl Tape {
    /// Flattens `expr`.
    pub fn new(expr: &Expr) -> Self {
        let mut steps = Vec::new();
        let mut index_of_node = HashMap::new();
        let mut index_of_step: HashMap<StepKey, usize> = HashMap::new();
        for node in expr.postorder() {
            let at = |child: &Expr| index_of_node[&child.key()];
            let (key, step) = match node.node() {
                Node::Axis(axis) => (StepKey::Axis(*axis), Step::Axis(*axis)),
                Node::Constant(c) => (StepKey::Constant(c.to_bits()), Step::Constant(*c)),
                Node::Unary(op, a) => (StepKey::Unary(*op, at(a)), Step::Unary(*op, at(a))),
                Node::Binary(op, a, b) => (
                    StepKey::Binary(*op, at(a), at(b)),
                    Step::Binary(*op, at(a), at(b)),
                ),
                Node::Field(field, p) => {
                    let p = [at(&p[0]), at(&p[1]), at(&p[2])];
                    let identity = Arc::as_ptr(field).cast::<()>();
                    (StepKey::Field(identity, p), Step::Field(field.clone(), p))
                }
            };
            let index = *index_of_step.entry(key).or_insert_with(|| {
                steps.push(step);
                steps.len() - 1
            });
            index_of_node.insert(node.key(), index);
        }
        // Sharing may leave the result in the middle; everything after it would be unused.
        steps.truncate(index_of_node[&expr.key()] + 1);
        Self { steps }
    }

    /// All operations, the result last.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Number of operations.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// True for no operation; a tape made from an expression has at least one.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// True when some value comes from a sampled field.
    pub fn has_fields(&self) -> bool {
        self.steps
            .iter()
            .any(|step| matches!(step, Step::Field(..)))
    }

    /// Values at `points` (m); a failing field gives NaN.
    pub fn evaluate(&self, points: &[[f64; 3]]) -> Vec<f64> {
        let mut values = vec![f64::NAN; points.len()];
        if self.evaluate_into(points, &mut values).is_err() {
            values.fill(f64::NAN);
        }
        values
    }

    /// Writes the values at `points` (m) into `values` of the same length.
    pub fn evaluate_into(&self, points: &[[f64; 3]], values: &mut [f64]) -> Result<(), FieldError> {
        // A field is sampled at all points at once: a call into Python costs more than the cache saves.
        let most = if self.has_fields() {
            points.len()
        } else {
            CHUNK
        };
        let chunk = most.min(points.len()).max(1);
        let mut work = vec![0.0; self.steps.len() * chunk];
        for (points, values) in points.chunks(chunk).zip(values.chunks_mut(chunk)) {
            self.evaluate_chunk(points, chunk, &mut work)?;
            let last = (self.steps.len() - 1) * chunk;
            values.copy_from_slice(&work[last..last + points.len()]);
        }
        Ok(())
    }

    fn evaluate_chunk(
        &self,
        points: &[[f64; 3]],
        stride: usize,
        work: &mut [f64],
    ) -> Result<(), FieldError> {
        let n = points.len();
        for (index, step) in self.steps.iter().enumerate() {
            let (done, rest) = work.split_at_mut(index * stride);
            let out = &mut rest[..n];
            let of = |i: usize| &done[i * stride..i * stride + n];
            match step {
                Step::Axis(axis) => {
                    out.iter_mut().zip(points).for_each(|(o, p)| *o = p[*axis]);
                }
                Step::Constant(c) => out.fill(*c),
                Step::Unary(op, a) => op.apply_all(of(*a), out),
                Step::Binary(op, a, b) => op.apply_all(of(*a), of(*b), out),
                Step::Field(field, at) => {
                    let [x, y, z] = at.map(of);
                    let moved: Vec<_> = (0..n).map(|i| [x[i], y[i], z[i]]).collect();
                    field.sample(&moved, out)?;
                }
            }
        }
        Ok(())
    }

    /// Range of the values, with the f32 error, over a box of coordinates (m).
    pub fn range(&self, at: &[Range; 3], work: &mut Vec<Range>) -> Result<Range, FieldError> {
        work.clear();
        for step in &self.steps {
            let range = match step {
                Step::Axis(axis) => at[*axis],
                Step::Constant(c) => Range::new(*c, *c),
                Step::Unary(op, a) => Range::unary(*op, work[*a]),
                Step::Binary(op, a, b) => Range::binary(*op, work[*a], work[*b]),
                Step::Field(field, p) => field.range(&p.map(|i| work[i]))?,
            };
            work.push(range);
        }
        Ok(work[work.len() - 1])
    }
}
