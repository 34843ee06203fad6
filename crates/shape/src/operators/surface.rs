//! Operators on the value of the function, which move or thicken the surface.
use super::boolean::grown;
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;
use crate::primitives;
use crate::shape::Shape;

/// The surface moved outward by `distance` (m), inward when negative: s − distance.
pub fn offset(shape: &Shape, distance: f64) -> Result<Shape, BuildError> {
    check::finite("distance", distance)?;
    let bounds = grown(shape.bounds, distance, shape.growth);
    Ok(Shape {
        expr: shape.expr.clone() - distance,
        bounds,
        growth: shape.growth,
    })
}

/// The shell of Algorithm 1 of the paper: |s| < thickness/2, in m where s is a distance.
pub fn shell(shape: &Shape, thickness: f64) -> Result<Shape, BuildError> {
    check::positive("thickness", thickness)?;
    let half = thickness / 2.0;
    let bounds = grown(shape.bounds, half, shape.growth);
    Ok(Shape {
        expr: shape.expr.abs() - half,
        bounds,
        growth: shape.growth,
    })
}

/// An offset whose distance (m) is an expression of x, y, z; nothing is known about its bounds.
pub fn graded_offset(shape: &Shape, distance: &Expr) -> Shape {
    Shape::unknown(shape.expr.clone() - distance.clone())
}

/// A shell whose thickness (m) is an expression of x, y, z; empty where it is not positive.
pub fn graded_shell(shape: &Shape, thickness: &Expr) -> Shape {
    Shape::unknown(shape.expr.abs() - thickness.clone() / 2.0)
}

/// The mean (1 − weight)·a + weight·b of two functions; `weight` is limited to [0, 1].
pub fn blend(a: &Shape, b: &Shape, weight: &Expr) -> Shape {
    let weight = weight.clamp(0.0, 1.0);
    Shape {
        expr: (1.0 - weight.clone()) * a.expr.clone() + weight * b.expr.clone(),
        bounds: a.bounds.hull(&b.bounds),
        growth: a.growth.min(b.growth),
    }
}

/// The part of the shape inside a box, for a function with unknown bounds.
///
/// # Errors
/// The box must be finite and not empty.
pub fn clip(shape: &Shape, bounds: &Bounds) -> Result<Shape, BuildError> {
    let center = [0, 1, 2].map(|i| 0.5 * (bounds.low[i] + bounds.high[i]));
    let size = [0, 1, 2].map(|i| bounds.high[i] - bounds.low[i]);
    let cuboid = primitives::cuboid(center, size)?;
    Ok(Shape {
        expr: shape.expr.max(cuboid.expr),
        bounds: *bounds,
        growth: 1.0,
    })
}
