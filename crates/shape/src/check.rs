//! Checks of the numbers a shape is built from.
use crate::error::BuildError;

pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, BuildError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(BuildError::NotPositive { name, value })
    }
}

pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, BuildError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(BuildError::NotFinite { name, value })
    }
}

pub(crate) fn point(name: &'static str, values: [f64; 3]) -> Result<[f64; 3], BuildError> {
    for value in values {
        finite(name, value)?;
    }
    Ok(values)
}

/// A direction, scaled to length one.
pub(crate) fn direction(name: &'static str, values: [f64; 3]) -> Result<[f64; 3], BuildError> {
    point(name, values)?;
    let length = values.iter().map(|v| v * v).sum::<f64>().sqrt();
    if length == 0.0 || !length.is_finite() {
        return Err(BuildError::NoDirection { name });
    }
    Ok(values.map(|v| v / length))
}
