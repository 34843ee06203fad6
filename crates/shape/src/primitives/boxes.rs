//! Solids with flat faces along the axes.
use super::corner;
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;
use crate::operators::shifted_axes;
use crate::shape::Shape;

/// A box with edges `size`, centered at `center`.
pub fn cuboid(center: [f64; 3], size: [f64; 3]) -> Result<Shape, BuildError> {
    rounded_box_function(center, size, 0.0)
}

/// A box with edges and corners rounded by `radius`, at most half the shortest edge.
pub fn rounded_box(center: [f64; 3], size: [f64; 3], radius: f64) -> Result<Shape, BuildError> {
    check::positive("radius", radius)?;
    let most = size.iter().copied().fold(f64::INFINITY, f64::min) / 2.0;
    // Typed decimals such as 0.005 and 0.01/2 may differ in the last bit.
    if radius > most * (1.0 + 1e-12) {
        let allowed = "it must be at most half the shortest edge";
        return Err(BuildError::OutOfRange {
            name: "radius",
            value: radius,
            allowed,
        });
    }
    rounded_box_function(center, size, radius)
}

fn rounded_box_function(
    center: [f64; 3],
    size: [f64; 3],
    radius: f64,
) -> Result<Shape, BuildError> {
    check::point("center", center)?;
    for edge in size {
        check::positive("size", edge)?;
    }
    let local = shifted_axes(center);
    let parts = [0, 1, 2].map(|i| local[i].abs() - (size[i] / 2.0 - radius));
    let half = size.map(|edge| edge / 2.0);
    let bounds = Bounds {
        low: [0, 1, 2].map(|i| center[i] - half[i]),
        high: [0, 1, 2].map(|i| center[i] + half[i]),
    };
    Ok(Shape::distance(corner(&parts) - radius, bounds))
}

/// Everything on the far side of a plane: `normal` points out of the solid.
pub fn half_space(point: [f64; 3], normal: [f64; 3]) -> Result<Shape, BuildError> {
    check::point("point", point)?;
    let normal = check::direction("normal", normal)?;
    let local = shifted_axes(point);
    let terms = local
        .into_iter()
        .zip(normal)
        .filter(|(_, n)| *n != 0.0)
        .map(|(p, n)| p * n);
    let expr = terms
        .reduce(|a, b| a + b)
        .unwrap_or_else(|| Expr::constant(0.0));
    let mut bounds = Bounds::ALL;
    for axis in 0..3 {
        if normal[axis] == 1.0 {
            bounds.high[axis] = point[axis];
        } else if normal[axis] == -1.0 {
            bounds.low[axis] = point[axis];
        }
    }
    Ok(Shape::distance(expr, bounds))
}
