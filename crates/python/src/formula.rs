//! `_core.Formula`: a function of place, velocity and time, from its text.
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use voxsoft_shape::{Binary, Step, Tape, Unary, parse_of};
use voxsoft_solid::formula::{Formula, Function, Operation, Operator, VARIABLES};
use voxsoft_solid::vector::Vec3;

use crate::arrays::rows;
use crate::errors::exception;

const HINT: &str =
    "write a function of x, y, z in m, vx, vy, vz in m/s and t in s, such as \"-9.81 - 8*vz\"";

/// Function of x, y, z (m), vx, vy, vz (m/s) and t (s), in the grammar of expressions of shapes.
#[pyclass(frozen, name = "Formula", module = "voxsoft._core")]
pub struct PyFormula(pub(crate) Formula);

#[pymethods]
impl PyFormula {
    #[new]
    fn new(py: Python<'_>, text: &str) -> PyResult<Self> {
        let failed = |what: String| exception(py, "DesignError", "", &what, HINT);
        let expr = parse_of(text, &VARIABLES).map_err(|error| failed(error.to_string()))?;
        let steps = Tape::new(&expr);
        let operations: Option<Vec<Operation>> = steps.steps().iter().map(operation).collect();
        let operations = operations.ok_or_else(|| failed("is no formula".to_owned()))?;
        let formula = Formula::new(operations);
        formula.map(Self).map_err(|_| {
            failed("a constant part has no finite value, as 1/0 and log(0) have none".to_owned())
        })
    }

    /// Values at points (m) with velocities (m/s), both (n, 3), at a time in s.
    fn at<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'_, f64>,
        velocities: PyReadonlyArray2<'_, f64>,
        time: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let points: Vec<Vec3> = rows("points", &points)?;
        let velocities: Vec<Vec3> = rows("velocities", &velocities)?;
        let value =
            |([x, y, z], [vx, vy, vz]): (Vec3, Vec3)| self.0.value(&[x, y, z, vx, vy, vz, time]);
        let values = points.into_iter().zip(velocities).map(value);
        Ok(PyArray1::from_iter(py, values))
    }

    /// Names of the variables that it has.
    #[getter]
    fn variables(&self) -> Vec<&'static str> {
        let has = |number: &usize| self.0.has(|variable| variable == *number);
        let found = (0..VARIABLES.len()).filter(has);
        found.map(|number| VARIABLES[number]).collect()
    }
}

/// The operation of a step; none for those that no text has.
fn operation(step: &Step) -> Option<Operation> {
    let place = |of: &usize| *of as u32;
    Some(match step {
        Step::Axis(number) => Operation::Variable(*number as u8),
        Step::Constant(value) => Operation::Constant(*value),
        Step::Unary(function, a) => Operation::Of(self::function(*function)?, place(a)),
        Step::Binary(operator, a, b) => {
            Operation::Between(self::operator(*operator), place(a), place(b))
        }
        Step::Field(..) => return None,
    })
}

fn function(of: Unary) -> Option<Function> {
    Some(match of {
        Unary::Neg => Function::Neg,
        Unary::Abs => Function::Abs,
        Unary::Sqrt => Function::Sqrt,
        Unary::Square => Function::Square,
        Unary::Floor => Function::Floor,
        Unary::Sin => Function::Sin,
        Unary::Cos => Function::Cos,
        Unary::Tan => Function::Tan,
        Unary::Asin => Function::Asin,
        Unary::Acos => Function::Acos,
        Unary::Atan => Function::Atan,
        Unary::Exp => Function::Exp,
        Unary::Log => Function::Log,
        Unary::Triangle => return None,
    })
}

fn operator(of: Binary) -> Operator {
    match of {
        Binary::Add => Operator::Add,
        Binary::Sub => Operator::Sub,
        Binary::Mul => Operator::Mul,
        Binary::Div => Operator::Div,
        Binary::Min => Operator::Min,
        Binary::Max => Operator::Max,
        Binary::Atan2 => Operator::Atan2,
        Binary::Hypot => Operator::Hypot,
    }
}
