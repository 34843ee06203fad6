//! Lowering of an expression to fidget, which compiles it and prunes it by intervals.
use std::collections::HashMap;

use fidget::context::{Context, Node as Handle, Tree};
use fidget::eval::{BulkEvaluator, Function, MathFunction, TracingEvaluator};
use fidget::shape::{EzShape, Shape, ShapeBulkEval, ShapeTape, ShapeTracingEval};
use fidget::var::{Var, VarIndex};

use crate::expr::{Binary, Expr, Node, Unary};

/// Interpreter of fidget, which runs on any processor.
pub(crate) type Interpreted = fidget::vm::VmFunction;
/// JIT compiler of fidget.
#[cfg(all(feature = "jit", not(target_arch = "wasm32")))]
pub(crate) type MachineCode = fidget::jit::JitFunction;

/// True if this processor runs fidget's machine code, which needs AVX2 and does not check for it.
#[cfg(all(feature = "jit", target_arch = "x86_64"))]
pub(crate) fn runs_machine_code() -> bool {
    is_x86_feature_detected!("avx2")
}

/// True: every processor of these architectures runs fidget's machine code.
#[cfg(all(
    feature = "jit",
    not(any(target_arch = "x86_64", target_arch = "wasm32"))
))]
pub(crate) fn runs_machine_code() -> bool {
    true
}

/// Evaluator of fidget over blocks.
pub(crate) type IntervalEval<F> = ShapeTracingEval<<F as Function>::IntervalEval>;
/// Evaluator of fidget for many points.
pub(crate) type FloatEval<F> = ShapeBulkEval<<F as Function>::FloatSliceEval>;
type IntervalTape<F> = ShapeTape<<<F as Function>::IntervalEval as TracingEvaluator>::Tape>;
type FloatTape<F> = ShapeTape<<<F as Function>::FloatSliceEval as BulkEvaluator>::Tape>;

/// Largest size of a simplified function, relative to the present one, that is worth its compilation.
const WORTHWHILE: f64 = 0.75;

/// A function, or its simplification in a block, compiled for blocks and for points.
pub(crate) struct Part<F: Function> {
    shape: Shape<F>,
    pub intervals: IntervalTape<F>,
    pub floats: FloatTape<F>,
}

/// A subexpression of one coordinate, computed once for each cell layer along that axis.
///
/// A call of a sine from compiled code costs as much as forty multiplications, and a wave along three
/// axes has six in each cell: with tables there are three per layer instead.
pub(crate) struct Table {
    pub variable: VarIndex,
    pub axis: usize,
    pub expr: Expr,
}

impl<F: MathFunction> Part<F> {
    /// Compiles `expr`; `None` if it samples a field, which fidget cannot.
    pub fn compile(expr: &Expr) -> Option<(Self, Vec<Table>)> {
        let mut context = Context::new();
        let (root, mut tables) = lower(expr, &mut context)?;
        let shape = Shape::new(&context, root).expect("the root was made in this context");
        let part = Self::of(shape);
        let used = |table: &Table| part.floats.vars().get(&Var::V(table.variable)).is_some();
        tables.retain(used);
        Some((part, tables))
    }

    fn of(shape: Shape<F>) -> Self {
        Self {
            intervals: shape.ez_interval_tape(),
            floats: shape.ez_float_slice_tape(),
            shape,
        }
    }

    /// Simplifies the function by the choices in `trace`, if the result is markedly smaller.
    pub fn simplify(&self, trace: &F::Trace, workspace: &mut F::Workspace) -> Option<Self> {
        let simpler = self
            .shape
            .simplify(trace, Default::default(), workspace)
            .expect("the trace belongs to this function");
        let is_worthwhile = simpler.size() as f64 <= WORTHWHILE * self.shape.size() as f64;
        is_worthwhile.then(|| Self::of(simpler))
    }
}

fn lower(expr: &Expr, context: &mut Context) -> Option<(Handle, Vec<Table>)> {
    let mut lowering = Lowering::default();
    for node in expr.postorder() {
        let tree = lowering.lower(&node)?;
        lowering.trees.insert(node.key(), tree);
    }
    Some((
        context.import(&lowering.trees[&expr.key()]),
        lowering.tables,
    ))
}

/// State of the lowering: results and dependence of the nodes lowered so far.
#[derive(Default)]
struct Lowering {
    trees: HashMap<*const Node, Tree>,
    squared_lengths: HashMap<*const Node, Tree>,
    dependence: HashMap<*const Node, Dependence>,
    tables: Vec<Table>,
}

/// Dependence of a node on coordinates, and its cost.
#[derive(Clone, Copy, Default)]
struct Dependence {
    /// One bit per coordinate
    axes: u8,
    /// True if it calls a library function
    is_costly: bool,
}

impl Lowering {
    fn lower(&mut self, node: &Expr) -> Option<Tree> {
        let dependence = self.depend(node);
        self.dependence.insert(node.key(), dependence);
        if dependence.is_costly && dependence.axes.count_ones() == 1 {
            let axis = dependence.axes.trailing_zeros() as usize;
            let variable = Var::new();
            let index = variable.index().expect("a new variable has an index");
            self.tables.push(Table {
                variable: index,
                axis,
                expr: node.clone(),
            });
            return Some(Tree::from(variable));
        }
        let of = |child: &Expr| self.trees[&child.key()].clone();
        Some(match node.node() {
            Node::Axis(axis) => Tree::from([Var::X, Var::Y, Var::Z][*axis]),
            Node::Constant(c) => Tree::constant(*c as f32),
            Node::Unary(op, a) => lower_unary(*op, of(a)),
            Node::Binary(Binary::Hypot, a, b) => {
                // A length of a length needs one root only.
                let square = |child: &Expr| match self.squared_lengths.get(&child.key()) {
                    Some(sum) => sum.clone(),
                    None => of(child).square(),
                };
                let sum = square(a) + square(b);
                self.squared_lengths.insert(node.key(), sum.clone());
                sum.sqrt()
            }
            Node::Binary(op, a, b) => lower_binary(*op, of(a), of(b)),
            Node::Field(..) => return None,
        })
    }

    fn depend(&self, node: &Expr) -> Dependence {
        let of = |child: &Expr| self.dependence[&child.key()];
        match node.node() {
            Node::Axis(axis) => Dependence {
                axes: 1 << axis,
                is_costly: false,
            },
            Node::Unary(op, a) => {
                let is_costly = of(a).is_costly || is_library_call(*op);
                Dependence { is_costly, ..of(a) }
            }
            Node::Binary(op, a, b) => Dependence {
                axes: of(a).axes | of(b).axes,
                is_costly: of(a).is_costly || of(b).is_costly || *op == Binary::Atan2,
            },
            Node::Constant(_) | Node::Field(..) => Dependence::default(),
        }
    }
}

fn is_library_call(op: Unary) -> bool {
    use Unary::{Acos, Asin, Atan, Cos, Exp, Log, Sin, Tan};
    matches!(op, Sin | Cos | Tan | Asin | Acos | Atan | Exp | Log)
}

fn lower_unary(op: Unary, a: Tree) -> Tree {
    match op {
        Unary::Neg => -a,
        Unary::Abs => a.abs(),
        Unary::Sqrt => a.sqrt(),
        Unary::Square => a.square(),
        Unary::Floor => a.floor(),
        Unary::Triangle => (a.clone() - (a + 0.5).floor()).abs(),
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        Unary::Tan => a.tan(),
        Unary::Asin => a.asin(),
        Unary::Acos => a.acos(),
        Unary::Atan => a.atan(),
        Unary::Exp => a.exp(),
        Unary::Log => a.ln(),
    }
}

fn lower_binary(op: Binary, a: Tree, b: Tree) -> Tree {
    match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        Binary::Atan2 => a.atan2(b),
        Binary::Hypot => (a.square() + b.square()).sqrt(),
    }
}
