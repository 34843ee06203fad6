//! Union, intersection, difference, sharp or blended over a length.
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;
use crate::shape::Shape;

/// Points in any of `shapes`. The function is a true distance outside.
pub fn union(shapes: &[Shape]) -> Result<Shape, BuildError> {
    let expr = balanced(shapes, &|a, b| a.min(b))?;
    let bounds = shapes
        .iter()
        .fold(Bounds::EMPTY, |all, shape| all.hull(&shape.bounds));
    Ok(Shape {
        expr,
        bounds,
        growth: least_growth(shapes),
    })
}

/// Points in all of `shapes`. Outside, the function is a lower bound of the distance.
pub fn intersection(shapes: &[Shape]) -> Result<Shape, BuildError> {
    let expr = balanced(shapes, &|a, b| a.max(b))?;
    let bounds = shapes
        .iter()
        .fold(Bounds::ALL, |all, shape| all.intersection(&shape.bounds));
    // The distance to the common box is at most √n times the largest distance to one of n boxes,
    // and at most √3 of them (one per axis) count. A shape without known growth gives no bound
    // outside.
    let share = (shapes.len().min(3) as f64).sqrt();
    Ok(Shape {
        expr,
        bounds,
        growth: least_growth(shapes) / share,
    })
}

/// Points in the first of `shapes` and in none of the others.
pub fn difference(shapes: &[Shape]) -> Result<Shape, BuildError> {
    let (body, others) = shapes.split_first().ok_or(BuildError::NoOperands)?;
    if others.is_empty() {
        return Ok(body.clone());
    }
    let removed = balanced(others, &|a, b| a.min(b))?;
    Ok(Shape {
        expr: body.expr.max(-removed),
        ..body.clone()
    })
}

/// Union with the edges between shapes filled over a length `radius` (m).
///
/// The quadratic blend min(a, b) − h²·radius/4 with h = max(0, 1 − |a − b|/radius) leaves the
/// function unchanged where the two differ by more than `radius`, and lowers it by at most
/// radius/4.
pub fn smooth_union(shapes: &[Shape], radius: f64) -> Result<Shape, BuildError> {
    check::positive("smooth", radius)?;
    let expr = balanced(shapes, &|a, b| smooth_minimum(a, b, radius))?;
    let growth = least_growth(shapes);
    let hull = shapes
        .iter()
        .fold(Bounds::EMPTY, |all, shape| all.hull(&shape.bounds));
    let levels = (shapes.len() as f64).log2().ceil();
    Ok(Shape {
        expr,
        bounds: grown(hull, levels * radius / 4.0, growth),
        growth,
    })
}

/// Intersection with its edges rounded over a length `radius` (m).
pub fn smooth_intersection(shapes: &[Shape], radius: f64) -> Result<Shape, BuildError> {
    check::positive("smooth", radius)?;
    let expr = balanced(shapes, &|a, b| {
        -smooth_minimum(&-a.clone(), &-b.clone(), radius)
    })?;
    Ok(Shape {
        expr,
        ..intersection(shapes)?
    })
}

/// Difference with its edges rounded over a length `radius` (m).
pub fn smooth_difference(shapes: &[Shape], radius: f64) -> Result<Shape, BuildError> {
    check::positive("smooth", radius)?;
    let (body, others) = shapes.split_first().ok_or(BuildError::NoOperands)?;
    if others.is_empty() {
        return Ok(body.clone());
    }
    let removed = balanced(others, &|a, b| smooth_minimum(a, b, radius))?;
    let expr = -smooth_minimum(&-body.expr.clone(), &removed, radius);
    Ok(Shape {
        expr,
        ..body.clone()
    })
}

fn smooth_minimum(a: &Expr, b: &Expr, radius: f64) -> Expr {
    let overlap = (1.0 - (a.clone() - b.clone()).abs() / radius).max(0.0);
    a.min(b.clone()) - overlap.square() * (radius / 4.0)
}

/// Bounds that contain {s < distance} when s grows at least at the rate `growth` outside `bounds`.
pub(super) fn grown(bounds: Bounds, distance: f64, growth: f64) -> Bounds {
    if distance <= 0.0 {
        bounds
    } else if growth > 0.0 {
        bounds.grown(distance / growth)
    } else {
        Bounds::ALL
    }
}

fn least_growth(shapes: &[Shape]) -> f64 {
    shapes
        .iter()
        .map(|shape| shape.growth)
        .fold(f64::INFINITY, f64::min)
}

/// Combines in a balanced tree, so that the depth grows with the logarithm of the count.
fn balanced(shapes: &[Shape], combine: &impl Fn(&Expr, &Expr) -> Expr) -> Result<Expr, BuildError> {
    match shapes {
        [] => Err(BuildError::NoOperands),
        [one] => Ok(one.expr.clone()),
        _ => {
            let (left, right) = shapes.split_at(shapes.len() / 2);
            Ok(combine(
                &balanced(left, combine)?,
                &balanced(right, combine)?,
            ))
        }
    }
}
