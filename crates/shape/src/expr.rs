//! Scalar expressions in the coordinates x, y, z, with float64 constants.
//!
//! fidget keeps its constants in f32, which moves a wall of 5 mm by up to half an ulp of f32. The
//! classification of a cell must equal a float64 evaluation, so VoxSoft keeps its own expression
//! and lowers it to fidget (see [`crate::compiled`]) for the bulk of the work.
use std::collections::HashMap;
use std::sync::Arc;

use crate::field::Field;

/// A function of one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// −a
    Neg,
    /// |a|
    Abs,
    /// √a, NaN below zero
    Sqrt,
    /// a²
    Square,
    /// Largest integer not above a
    Floor,
    /// Distance to the nearest integer, |a − round(a)|: a triangle wave of period 1
    Triangle,
    /// Sine of an angle in rad
    Sin,
    /// Cosine of an angle in rad
    Cos,
    /// Tangent of an angle in rad
    Tan,
    /// Inverse sine, rad
    Asin,
    /// Inverse cosine, rad
    Acos,
    /// Inverse tangent, rad
    Atan,
    /// eᵃ
    Exp,
    /// Natural logarithm, NaN below zero
    Log,
}

/// A function of two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b
    Add,
    /// a − b
    Sub,
    /// a · b
    Mul,
    /// a / b
    Div,
    /// The smaller; NaN when either is
    Min,
    /// The larger; NaN when either is
    Max,
    /// Angle of the point (b, a) in rad
    Atan2,
    /// Length of the vector (a, b), √(a² + b²)
    Hypot,
}

/// One node of an expression.
#[derive(Debug)]
pub enum Node {
    /// Coordinate 0 = x, 1 = y, 2 = z, in m; other numbers are variables of functions that are no shapes
    Axis(usize),
    /// A number
    Constant(f64),
    /// A function of one expression
    Unary(Unary, Expr),
    /// A function of two expressions
    Binary(Binary, Expr, Expr),
    /// A sampled field at the point given by three expressions
    Field(Arc<dyn Field>, [Expr; 3]),
}

/// An immutable expression; cloning shares it.
///
/// ```
/// use voxsoft_shape::Expr;
/// let [x, y, _] = Expr::axes();
/// let circle = (x.square() + y.square()).sqrt() - 2.0;
/// assert_eq!(circle.evaluate(&[[3.0, 4.0, 0.0]]), vec![3.0]);
/// ```
#[derive(Clone, Debug)]
pub struct Expr(Arc<Node>);

impl Expr {
    /// The coordinates x, y, z.
    pub fn axes() -> [Self; 3] {
        [0, 1, 2].map(Self::variable)
    }

    /// A coordinate by its number, or another variable of a function that is no shape.
    pub fn variable(number: usize) -> Self {
        Self(Arc::new(Node::Axis(number)))
    }

    /// A number.
    pub fn constant(value: f64) -> Self {
        Self(Arc::new(Node::Constant(value)))
    }

    /// `field` sampled at the point `at`.
    pub fn field(field: Arc<dyn Field>, at: [Self; 3]) -> Self {
        Self(Arc::new(Node::Field(field, at)))
    }

    /// The outermost node.
    pub fn node(&self) -> &Node {
        &self.0
    }

    /// Identity of the shared node, for memoizing.
    pub(crate) fn key(&self) -> *const Node {
        Arc::as_ptr(&self.0)
    }

    /// The number this expression is, when it holds no coordinate.
    pub fn as_constant(&self) -> Option<f64> {
        match self.node() {
            Node::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// Applies a function of one value; a constant is folded.
    pub fn unary(op: Unary, a: Self) -> Self {
        match a.as_constant() {
            Some(value) => Self::constant(op.apply(value)),
            None => Self(Arc::new(Node::Unary(op, a))),
        }
    }

    /// Applies a function of two values; constants are folded, neutral elements dropped.
    pub fn binary(op: Binary, a: Self, b: Self) -> Self {
        match (op, a.as_constant(), b.as_constant()) {
            (_, Some(x), Some(y)) => Self::constant(op.apply(x, y)),
            (Binary::Add, Some(0.0), _) | (Binary::Mul, Some(1.0), _) => b,
            (Binary::Add | Binary::Sub, _, Some(0.0)) => a,
            (Binary::Mul | Binary::Div, _, Some(1.0)) => a,
            _ => Self(Arc::new(Node::Binary(op, a, b))),
        }
    }

    /// The expression with x, y, z replaced by `to`: a change of coordinates.
    pub fn remap(&self, to: &[Self; 3]) -> Self {
        let mut done: HashMap<*const Node, Self> = HashMap::new();
        for expr in self.postorder() {
            let of = |child: &Self| done[&child.key()].clone();
            let mapped = match expr.node() {
                Node::Axis(axis) => to[*axis].clone(),
                Node::Constant(_) => expr.clone(),
                Node::Unary(op, a) => Self::unary(*op, of(a)),
                Node::Binary(op, a, b) => Self::binary(*op, of(a), of(b)),
                Node::Field(field, at) => {
                    Self::field(field.clone(), [of(&at[0]), of(&at[1]), of(&at[2])])
                }
            };
            done.insert(expr.key(), mapped);
        }
        done[&self.key()].clone()
    }

    /// Every distinct node, children before parents.
    ///
    /// The walk keeps its own stack: a long sum is a deep expression, and threads have short
    /// stacks.
    pub(crate) fn postorder(&self) -> Vec<Self> {
        let mut order = Vec::new();
        let mut seen = std::collections::HashSet::new();
        let mut stack = vec![(self.clone(), false)];
        while let Some((expr, children_done)) = stack.pop() {
            if children_done {
                order.push(expr);
            } else if seen.insert(expr.key()) {
                stack.push((expr.clone(), true));
                for child in expr.children() {
                    stack.push((child.clone(), false));
                }
            }
        }
        order
    }

    fn children(&self) -> Vec<&Self> {
        match self.node() {
            Node::Axis(_) | Node::Constant(_) => vec![],
            Node::Unary(_, a) => vec![a],
            Node::Binary(_, a, b) => vec![a, b],
            Node::Field(_, at) => at.iter().collect(),
        }
    }

    /// Values in float64 at `points` (m).
    pub fn evaluate(&self, points: &[[f64; 3]]) -> Vec<f64> {
        crate::tape::Tape::new(self).evaluate(points)
    }
}

impl Unary {
    /// The value in float64.
    #[inline]
    pub fn apply(self, a: f64) -> f64 {
        match self {
            Self::Neg => -a,
            Self::Abs => a.abs(),
            Self::Sqrt => a.sqrt(),
            Self::Square => a * a,
            Self::Floor => a.floor(),
            Self::Triangle => (a - (a + 0.5).floor()).abs(),
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Exp => a.exp(),
            Self::Log => a.ln(),
        }
    }

    /// Writes the values at many numbers; asked once which operation it is, for all of them.
    pub fn apply_all(self, a: &[f64], out: &mut [f64]) {
        macro_rules! each {
            ($($op:ident)*) => {
                match self {
                    $(Self::$op => {
                        for (out, &a) in out.iter_mut().zip(a) {
                            *out = Self::$op.apply(a);
                        }
                    })*
                }
            };
        }
        each!(Neg Abs Sqrt Square Floor Triangle Sin Cos Tan Asin Acos Atan Exp Log);
    }
}

impl Binary {
    /// The value in float64.
    #[inline]
    pub fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            // A NaN compares false: it must come out, not be skipped as `f64::min` would.
            Self::Min if a.is_nan() || b.is_nan() => f64::NAN,
            Self::Max if a.is_nan() || b.is_nan() => f64::NAN,
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Atan2 => a.atan2(b),
            Self::Hypot => (a * a + b * b).sqrt(),
        }
    }

    /// Writes the values at many pairs; asked once which operation it is, for all of them.
    pub fn apply_all(self, a: &[f64], b: &[f64], out: &mut [f64]) {
        macro_rules! each {
            ($($op:ident)*) => {
                match self {
                    $(Self::$op => {
                        for (out, (&a, &b)) in out.iter_mut().zip(a.iter().zip(b)) {
                            *out = Self::$op.apply(a, b);
                        }
                    })*
                }
            };
        }
        each!(Add Sub Mul Div Min Max Atan2 Hypot);
    }
}

macro_rules! unary_methods {
    ($($name:ident $op:ident $doc:literal),* $(,)?) => {
        impl Expr {
            $(#[doc = $doc] pub fn $name(&self) -> Self { Self::unary(Unary::$op, self.clone()) })*
        }
    };
}
unary_methods! {
    abs Abs "Absolute value.", square Square "Square.",
    floor Floor "Largest integer not above.", triangle Triangle "Distance to the nearest integer.",
    sin Sin "Sine.", cos Cos "Cosine.", tan Tan "Tangent.", asin Asin "Inverse sine.",
    acos Acos "Inverse cosine.", atan Atan "Inverse tangent.", exp Exp "Exponential.",
    log Log "Natural logarithm.",
}

impl Expr {
    /// Square root, NaN below zero.
    ///
    /// The root of a sum of squares becomes [`Binary::Hypot`], whose rounding error stays small at
    /// zero, where that of a root does not.
    pub fn sqrt(&self) -> Self {
        self.length_of_squares()
            .unwrap_or_else(|| Self::unary(Unary::Sqrt, self.clone()))
    }

    /// √self where self is a² + b² + ..., with at least two terms or one square.
    fn length_of_squares(&self) -> Option<Self> {
        match self.node() {
            Node::Unary(Unary::Square, a) => Some(a.abs()),
            Node::Binary(Binary::Add, a, b) => {
                let (a, b) = (a.length_of_squares()?, b.length_of_squares()?);
                Some(Self::binary(Binary::Hypot, a, b))
            }
            _ => None,
        }
    }

    /// The smaller of two.
    pub fn min(&self, other: impl Into<Self>) -> Self {
        Self::binary(Binary::Min, self.clone(), other.into())
    }

    /// The larger of two.
    pub fn max(&self, other: impl Into<Self>) -> Self {
        Self::binary(Binary::Max, self.clone(), other.into())
    }

    /// Angle of the point (`other`, `self`).
    pub fn atan2(&self, other: impl Into<Self>) -> Self {
        Self::binary(Binary::Atan2, self.clone(), other.into())
    }

    /// Limits the value to [low, high].
    pub fn clamp(&self, low: f64, high: f64) -> Self {
        self.max(low).min(high)
    }

    /// The power `self ^ exponent`.
    ///
    /// Whole exponents up to 64 multiply, so that negative bases work and results stay exact; 1/2
    /// is a square root; anything else is exp(exponent · log self), NaN for a negative base.
    pub fn pow(&self, exponent: &Self) -> Self {
        match exponent.as_constant() {
            Some(0.5) => self.sqrt(),
            Some(n) if n.fract() == 0.0 && n.abs() <= 64.0 => {
                let power = self.whole_power(n.abs() as u32);
                if n < 0.0 {
                    Self::constant(1.0) / power
                } else {
                    power
                }
            }
            _ => (exponent.clone() * self.log()).exp(),
        }
    }

    fn whole_power(&self, n: u32) -> Self {
        match n {
            0 => Self::constant(1.0),
            1 => self.clone(),
            _ if n.is_multiple_of(2) => self.whole_power(n / 2).square(),
            _ => self.whole_power(n - 1) * self.clone(),
        }
    }
}

impl From<f64> for Expr {
    fn from(value: f64) -> Self {
        Self::constant(value)
    }
}

impl From<&Expr> for Expr {
    fn from(shared: &Expr) -> Self {
        shared.clone()
    }
}

macro_rules! operator {
    ($trait:ident $method:ident $op:ident) => {
        impl<T: Into<Expr>> std::ops::$trait<T> for Expr {
            type Output = Expr;
            fn $method(self, other: T) -> Expr {
                Expr::binary(Binary::$op, self, other.into())
            }
        }
        impl std::ops::$trait<Expr> for f64 {
            type Output = Expr;
            fn $method(self, other: Expr) -> Expr {
                Expr::binary(Binary::$op, self.into(), other)
            }
        }
    };
}
operator!(Add add Add);
operator!(Sub sub Sub);
operator!(Mul mul Mul);
operator!(Div div Div);

impl std::ops::Neg for Expr {
    type Output = Self;
    fn neg(self) -> Self {
        Self::unary(Unary::Neg, self)
    }
}

/// Euclidean length of a vector of expressions.
pub fn length(components: &[Expr]) -> Expr {
    let squares = components.iter().map(Expr::square);
    squares
        .reduce(|a, b| a + b)
        .unwrap_or_else(|| 0.0.into())
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NUMBERS: [f64; 9] = [
        0.0,
        -0.0,
        0.3,
        -2.7,
        1.0,
        1e300,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];

    /// Equal numbers, or both none; the smaller of two zeros may have either sign.
    fn alike(one: f64, other: f64) -> bool {
        one == other || (one.is_nan() && other.is_nan())
    }

    #[test]
    fn many_numbers_have_the_values_of_each() {
        for op in [
            Unary::Neg,
            Unary::Abs,
            Unary::Sqrt,
            Unary::Square,
            Unary::Floor,
            Unary::Triangle,
            Unary::Sin,
            Unary::Asin,
            Unary::Exp,
            Unary::Log,
        ] {
            let mut all = [0.0; NUMBERS.len()];
            op.apply_all(&NUMBERS, &mut all);
            let each = NUMBERS.map(|number| op.apply(number));
            assert!(
                all.into_iter().zip(each).all(|(a, b)| alike(a, b)),
                "{op:?}"
            );
        }
        for op in [
            Binary::Add,
            Binary::Sub,
            Binary::Mul,
            Binary::Div,
            Binary::Min,
            Binary::Max,
            Binary::Atan2,
            Binary::Hypot,
        ] {
            for other in NUMBERS {
                let mut all = [0.0; NUMBERS.len()];
                op.apply_all(&NUMBERS, &[other; NUMBERS.len()], &mut all);
                let each = NUMBERS.map(|number| op.apply(number, other));
                assert!(
                    all.into_iter().zip(each).all(|(a, b)| alike(a, b)),
                    "{op:?}"
                );
            }
        }
    }
}
