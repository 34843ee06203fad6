//! Solids with round faces.
use super::corner;
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::length;
use crate::frame::{Frame, dot};
use crate::operators::shifted_axes;
use crate::shape::Shape;

/// A ball.
pub fn sphere(center: [f64; 3], radius: f64) -> Result<Shape, BuildError> {
    check::point("center", center)?;
    check::positive("radius", radius)?;
    let expr = length(&shifted_axes(center)) - radius;
    Ok(Shape::distance(
        expr,
        Bounds::new(center, center).grown(radius),
    ))
}

/// An ellipsoid with half axes `radii` along x, y, z.
///
/// s = (k − 1)·k/|∇(k²)/2| with k = √Σ(xᵢ/rᵢ)²: the distance to first order near the surface. The
/// ratio is kept finite at the center, where it would be 0/0, by a term of relative size 10⁻⁶.
pub fn ellipsoid(center: [f64; 3], radii: [f64; 3]) -> Result<Shape, BuildError> {
    check::point("center", center)?;
    for radius in radii {
        check::positive("radii", radius)?;
    }
    let local = shifted_axes(center);
    let scaled = [0, 1, 2].map(|i| local[i].clone() / radii[i]);
    let slopes = [0, 1, 2].map(|i| local[i].clone() / (radii[i] * radii[i]));
    let least = radii.iter().copied().fold(f64::INFINITY, f64::min);
    let most = radii.iter().copied().fold(0.0, f64::max);
    let squares =
        |parts: &[crate::Expr; 3]| parts[0].square() + parts[1].square() + parts[2].square();
    let blur = 1e-12;
    let ratio = (squares(&scaled) + blur) / (squares(&slopes) + blur / (least * least));
    let expr = (length(&scaled) - 1.0) * ratio.sqrt();
    let bounds = Bounds {
        low: [0, 1, 2].map(|i| center[i] - radii[i]),
        high: [0, 1, 2].map(|i| center[i] + radii[i]),
    };
    // Outside, k − 1 ≥ distance/most and the ratio is at least `least` (both up to the blur).
    Ok(Shape {
        expr,
        bounds,
        growth: 0.999 * least / most,
    })
}

/// A solid cylinder of `radius` from `base` over `height` along `axis`.
pub fn cylinder(
    base: [f64; 3],
    axis: [f64; 3],
    radius: f64,
    height: f64,
) -> Result<Shape, BuildError> {
    let frame = Frame::along(base, axis)?;
    check::positive("radius", radius)?;
    check::positive("height", height)?;
    let [u, v, w] = frame.coordinates();
    let across = length(&[u, v]) - radius;
    let along = (w - height / 2.0).abs() - height / 2.0;
    let bounds = frame.ring_bounds(&[(radius, 0.0), (radius, height)]);
    Ok(Shape::distance(corner(&[across, along]), bounds))
}

/// A pipe with outer `radius` and `wall` thickness, from `base` over `height` along `axis`.
pub fn tube(
    base: [f64; 3],
    axis: [f64; 3],
    radius: f64,
    wall: f64,
    height: f64,
) -> Result<Shape, BuildError> {
    let frame = Frame::along(base, axis)?;
    check::positive("radius", radius)?;
    check::positive("wall", wall)?;
    check::positive("height", height)?;
    if wall >= radius {
        let allowed = "it must be less than the outer radius";
        return Err(BuildError::OutOfRange {
            name: "wall",
            value: wall,
            allowed,
        });
    }
    let [u, v, w] = frame.coordinates();
    let across = (length(&[u, v]) - (radius - wall / 2.0)).abs() - wall / 2.0;
    let along = (w - height / 2.0).abs() - height / 2.0;
    let bounds = frame.ring_bounds(&[(radius, 0.0), (radius, height)]);
    Ok(Shape::distance(corner(&[across, along]), bounds))
}

/// All points within `radius` of the segment from `start` to `end`.
pub fn capsule(start: [f64; 3], end: [f64; 3], radius: f64) -> Result<Shape, BuildError> {
    check::point("start", start)?;
    check::point("end", end)?;
    check::positive("radius", radius)?;
    let direction = [0, 1, 2].map(|i| end[i] - start[i]);
    let squared = dot(direction, direction);
    let local = shifted_axes(start);
    let bounds = Bounds::around([start, end]).grown(radius);
    if squared == 0.0 {
        return sphere(start, radius);
    }
    let along = (local[0].clone() * direction[0]
        + local[1].clone() * direction[1]
        + local[2].clone() * direction[2])
        / squared;
    let along = along.clamp(0.0, 1.0);
    let offsets = [0, 1, 2].map(|i| local[i].clone() - along.clone() * direction[i]);
    Ok(Shape::distance(length(&offsets) - radius, bounds))
}

/// A ring around `axis` through `center`: a tube of radius `minor` whose middle line has radius
/// `major`.
pub fn torus(
    center: [f64; 3],
    axis: [f64; 3],
    major: f64,
    minor: f64,
) -> Result<Shape, BuildError> {
    let frame = Frame::along(center, axis)?;
    check::positive("radius", major)?;
    check::positive("tube_radius", minor)?;
    let [u, v, w] = frame.coordinates();
    let expr = length(&[length(&[u, v]) - major, w]) - minor;
    Ok(Shape::distance(
        expr,
        frame.ring_bounds(&[(major, 0.0)]).grown(minor),
    ))
}
