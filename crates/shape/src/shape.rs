//! A solid as an implicit function: s(x, y, z) < 0 inside.
use crate::bounds::Bounds;
use crate::error::FieldError;
use crate::expr::Expr;
use crate::tape::Tape;

/// A shape: its function, its bounds and its growth outside them.
///
/// `growth` states how the function behaves outside `bounds`: s(p) ≥ growth · distance(p, bounds).
/// It is 1 for a true distance and 0 where nothing is known; operators that move the surface
/// (offset, smooth union) use it to keep the bounds conservative.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The function s in m (or any unit for a free expression)
    pub expr: Expr,
    /// A box that contains every point with s < 0
    pub bounds: Bounds,
    /// Least rate at which s grows with the distance from `bounds`
    pub growth: f64,
}

impl Shape {
    /// Makes a shape whose function grows outside `bounds` at least as fast as the distance from them, such as a true
    /// distance.
    pub fn distance(expr: Expr, bounds: Bounds) -> Self {
        Self {
            expr,
            bounds,
            growth: 1.0,
        }
    }

    /// Makes a shape with unknown bounds and growth.
    pub fn unknown(expr: Expr) -> Self {
        Self {
            expr,
            bounds: Bounds::ALL,
            growth: 0.0,
        }
    }

    /// Values of s in float64 at `points` (m).
    pub fn evaluate(&self, points: &[[f64; 3]]) -> Result<Vec<f64>, FieldError> {
        let mut values = vec![0.0; points.len()];
        Tape::new(&self.expr).evaluate_into(points, &mut values)?;
        Ok(values)
    }
}
