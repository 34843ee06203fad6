//! Implicit field evaluated by a Python function: a triangle mesh, or the user's own.
use std::fmt;
use std::sync::Arc;

use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use voxsoft_shape::range::Range;
use voxsoft_shape::{Expr, Field, FieldError, distance_range};

struct PythonField {
    function: Py<PyAny>,
    /// True if the values change by at most the distance moved (Lipschitz constant 1)
    is_distance: bool,
}

/// Expression for the values of `function` at x, y, z.
pub fn expression(function: Py<PyAny>, is_distance: bool) -> Expr {
    Expr::field(
        Arc::new(PythonField {
            function,
            is_distance,
        }),
        Expr::axes(),
    )
}

impl fmt::Debug for PythonField {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("PythonField")
            .field("is_distance", &self.is_distance)
            .finish()
    }
}

impl PythonField {
    fn call(&self, py: Python<'_>, points: &[[f64; 3]], values: &mut [f64]) -> PyResult<()> {
        let points: Bound<'_, PyArray2<f64>> = numpy::ndarray::arr2(points).into_pyarray(py);
        let answer = self.function.call1(py, (points,))?;
        let answer: PyReadonlyArray1<'_, f64> = answer.extract(py)?;
        values.copy_from_slice(answer.as_slice()?);
        Ok(())
    }
}

impl Field for PythonField {
    fn sample(&self, points: &[[f64; 3]], values: &mut [f64]) -> Result<(), FieldError> {
        // Python cannot be called while the interpreter shuts down; `attach` waits for the GIL
        // otherwise.
        Python::attach(|py| {
            self.call(py, points, values)
                .map_err(|error| FieldError(error.to_string()))
        })
    }

    fn range(&self, at: &[Range; 3]) -> Result<Range, FieldError> {
        if !self.is_distance {
            return Ok(Range::ALL);
        }
        distance_range(at, |center| {
            let mut value = [0.0];
            self.sample(&[center], &mut value)?;
            Ok(value[0])
        })
    }
}
