//! Sampled fields without an expression: polygons, triangle meshes, Python functions.
use std::fmt;

use crate::error::FieldError;
use crate::range::Range;

/// A scalar field sampled in batches.
pub trait Field: Send + Sync + fmt::Debug {
    /// Writes the values at `points` (m) into `values`, which has the same length.
    fn sample(&self, points: &[[f64; 3]], values: &mut [f64]) -> Result<(), FieldError>;

    /// Bounds of the values over the box of the three coordinate ranges (m).
    ///
    /// The default is unbounded, so that every cell of such a field is sampled.
    fn range(&self, _at: &[Range; 3]) -> Result<Range, FieldError> {
        Ok(Range::ALL)
    }
}

/// Range over a box of a field whose value changes by at most the distance moved (Lipschitz constant 1, as of a true
/// distance): the value at the center of the box plus or minus its half diagonal.
pub fn distance_range<E>(
    at: &[Range; 3],
    sample: impl FnOnce([f64; 3]) -> Result<f64, E>,
) -> Result<Range, E> {
    let center = [0, 1, 2].map(|axis| 0.5 * (at[axis].low + at[axis].high));
    let half = [0, 1, 2].map(|axis| 0.5 * (at[axis].high - at[axis].low));
    let reach = half.iter().map(|h| h * h).sum::<f64>().sqrt();
    if !reach.is_finite() {
        return Ok(Range::ALL);
    }
    let value = sample(center)?;
    Ok(Range::new(value - reach, value + reach))
}
