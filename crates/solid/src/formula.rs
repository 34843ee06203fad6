//! Formulas of place, velocity and time: lists of operations, with exact derivatives.
//!
//! They are made from the text of a user by another crate, which has the grammar; here they are evaluated.

use serde::{Deserialize, Serialize};

use crate::ProblemError;

/// Variables: the place in m, the velocity in m/s, the time in s.
pub const VARIABLES: [&str; 7] = ["x", "y", "z", "vx", "vy", "vz", "t"];
/// Variables by which formulas have derivatives: all but the time.
const SLOPES: usize = 6;

/// A function of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Function {
    /// `−a`
    Neg,
    /// `|a|`
    Abs,
    /// `√a`
    Sqrt,
    /// `a²`
    Square,
    /// Largest integer not above `a`
    Floor,
    /// Sine of an angle in rad
    Sin,
    /// Cosine of an angle in rad
    Cos,
    /// Tangent of an angle in rad
    Tan,
    /// Inverse sine in rad
    Asin,
    /// Inverse cosine in rad
    Acos,
    /// Inverse tangent in rad
    Atan,
    /// `eᵃ`
    Exp,
    /// Natural logarithm
    Log,
}

/// A function of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Operator {
    /// `a + b`
    Add,
    /// `a − b`
    Sub,
    /// `a b`
    Mul,
    /// `a / b`
    Div,
    /// The smaller
    Min,
    /// The larger
    Max,
    /// Angle of the point (b, a) in rad
    Atan2,
    /// `√(a² + b²)`
    Hypot,
}

/// One operation; numbers refer to earlier ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Operation {
    /// A variable, by its index in [`VARIABLES`].
    Variable(u8),
    /// A number.
    Constant(f64),
    /// A function of an earlier value.
    Of(Function, u32),
    /// A function of two earlier values.
    Between(Operator, u32, u32),
}

/// A formula, whose value is that of its last operation.
///
/// # Example
///
/// ```
/// use voxsoft_solid::formula::{Formula, Operation, Operator};
///
/// // −2 vx
/// let operations = vec![
///     Operation::Variable(3),
///     Operation::Constant(-2.0),
///     Operation::Between(Operator::Mul, 0, 1),
/// ];
/// let formula = Formula::new(operations)?;
/// let found = formula.slopes(&[0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0]);
/// assert_eq!((found.value, found.slopes[3]), (-6.0, -2.0));
/// # Ok::<(), voxsoft_solid::ProblemError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Formula(Vec<Operation>);

/// A value with its derivatives by place and velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its derivatives by x, y, z (per m) and vx, vy, vz (per m/s).
    pub slopes: [f64; SLOPES],
}

impl Formula {
    /// Checks the order of operations and the numbers.
    ///
    /// # Errors
    ///
    /// No operation, one that refers to a later one or to an unknown variable, or a number that is not finite.
    pub fn new(operations: Vec<Operation>) -> Result<Self, ProblemError> {
        let formula = Self(operations);
        formula.check()?;
        Ok(formula)
    }

    pub(crate) fn check(&self) -> Result<(), ProblemError> {
        let index = |what, index: usize, count: usize| {
            let error = ProblemError::Index { what, index, count };
            if index < count { Ok(()) } else { Err(error) }
        };
        index("last operation of a formula", 0, self.0.len())?;
        for (place, operation) in self.0.iter().enumerate() {
            let earlier = |of: u32| index("earlier operation of a formula", of as usize, place);
            match *operation {
                Operation::Variable(number) => {
                    index("variable of a formula", number.into(), VARIABLES.len())?;
                }
                Operation::Constant(value) if !value.is_finite() => {
                    return Err(ProblemError::NotFinite { what: "a formula" });
                }
                Operation::Constant(_) => {}
                Operation::Of(_, a) => earlier(a)?,
                Operation::Between(_, a, b) => {
                    earlier(a)?;
                    earlier(b)?;
                }
            }
        }
        Ok(())
    }

    /// Tests whether it has any of some variables, by their indices in [`VARIABLES`].
    pub fn has(&self, mut variables: impl FnMut(usize) -> bool) -> bool {
        self.0.iter().any(|operation| match operation {
            Operation::Variable(number) => variables(usize::from(*number)),
            _ => false,
        })
    }

    /// The value at the values of all variables.
    pub fn value(&self, at: &[f64; VARIABLES.len()]) -> f64 {
        let mut found = Vec::with_capacity(self.0.len());
        for operation in &self.0 {
            let value = match *operation {
                Operation::Variable(number) => at[usize::from(number)],
                Operation::Constant(value) => value,
                Operation::Of(function, a) => function.with_slope(found[a as usize]).0,
                Operation::Between(operator, a, b) => {
                    operator.with_slopes(found[a as usize], found[b as usize]).0
                }
            };
            found.push(value);
        }
        found[found.len() - 1]
    }

    /// The value with its derivatives. Where there is none (a kink, the root of zero) it is that of one side, or zero.
    pub fn slopes(&self, at: &[f64; VARIABLES.len()]) -> Dual {
        let mut found: Vec<Dual> = Vec::with_capacity(self.0.len());
        for operation in &self.0 {
            let mut slopes = [0.0; SLOPES];
            let value = match *operation {
                Operation::Variable(number) => {
                    let number = usize::from(number);
                    if number < SLOPES {
                        slopes[number] = 1.0;
                    }
                    at[number]
                }
                Operation::Constant(value) => value,
                Operation::Of(function, a) => {
                    let a = found[a as usize];
                    let (value, slope) = function.with_slope(a.value);
                    add_scaled(&mut slopes, slope, &a.slopes);
                    value
                }
                Operation::Between(operator, a, b) => {
                    let (a, b) = (found[a as usize], found[b as usize]);
                    let (value, by_a, by_b) = operator.with_slopes(a.value, b.value);
                    add_scaled(&mut slopes, by_a, &a.slopes);
                    add_scaled(&mut slopes, by_b, &b.slopes);
                    value
                }
            };
            found.push(Dual { value, slopes });
        }
        found[found.len() - 1]
    }
}

/// Adds `factor` times the slopes of an argument. Where a function has no slope, at its kinks, none is added.
fn add_scaled(slopes: &mut [f64; SLOPES], factor: f64, of: &[f64; SLOPES]) {
    for (slope, own) in slopes.iter_mut().zip(of) {
        if *own != 0.0 && factor.is_finite() {
            *slope += factor * own;
        }
    }
}

impl Function {
    /// The value, and its derivative.
    fn with_slope(self, a: f64) -> (f64, f64) {
        match self {
            Self::Neg => (-a, -1.0),
            Self::Abs => (a.abs(), if a < 0.0 { -1.0 } else { 1.0 }),
            Self::Sqrt => (a.sqrt(), 0.5 / a.sqrt()),
            Self::Square => (a * a, 2.0 * a),
            Self::Floor => (a.floor(), 0.0),
            Self::Sin => (a.sin(), a.cos()),
            Self::Cos => (a.cos(), -a.sin()),
            Self::Tan => (a.tan(), 1.0 + a.tan() * a.tan()),
            Self::Asin => (a.asin(), 1.0 / (1.0 - a * a).sqrt()),
            Self::Acos => (a.acos(), -1.0 / (1.0 - a * a).sqrt()),
            Self::Atan => (a.atan(), 1.0 / (1.0 + a * a)),
            Self::Exp => (a.exp(), a.exp()),
            Self::Log => (a.ln(), 1.0 / a),
        }
    }
}

impl Operator {
    /// The value, and its derivatives by both.
    fn with_slopes(self, a: f64, b: f64) -> (f64, f64, f64) {
        match self {
            Self::Add => (a + b, 1.0, 1.0),
            Self::Sub => (a - b, 1.0, -1.0),
            Self::Mul => (a * b, b, a),
            Self::Div => (a / b, 1.0 / b, -a / (b * b)),
            Self::Min | Self::Max if a.is_nan() || b.is_nan() => (f64::NAN, f64::NAN, f64::NAN),
            Self::Min if a <= b => (a, 1.0, 0.0),
            Self::Max if a >= b => (a, 1.0, 0.0),
            Self::Min | Self::Max => (b, 0.0, 1.0),
            Self::Atan2 => {
                let square = a * a + b * b;
                let (by_a, by_b) = if square > 0.0 {
                    (b / square, -a / square)
                } else {
                    (0.0, 0.0)
                };
                (a.atan2(b), by_a, by_b)
            }
            Self::Hypot => {
                let size = (a * a + b * b).sqrt();
                let by = |part: f64| if size > 0.0 { part / size } else { 0.0 };
                (size, by(a), by(b))
            }
        }
    }
}
