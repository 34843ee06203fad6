//! Solids made from a polygon: prisms and bodies of revolution.
use std::sync::Arc;

use super::corner;
use crate::bounds::Bounds;
use crate::check;
use crate::error::{BuildError, FieldError};
use crate::expr::{Expr, length};
use crate::field::{Field, distance_range};
use crate::frame::Frame;
use crate::range::Range;
use crate::shape::Shape;

/// A closed polygon in a plane; its field is the signed distance (the third coordinate is ignored).
///
/// The inside is decided by the crossing number, so either orientation works, and a polygon that crosses itself is
/// inside where a ray leaves through an odd number of edges. An expression of n edges would cost n inverse tangents per
/// cell; this field costs n multiplications and keeps the distance exact.
#[derive(Clone, Debug)]
pub struct Polygon {
    points: Vec<[f64; 2]>,
    /// Edges from point i to i + 1 that bound the solid; those on the axis of a revolution do not
    is_wall: Vec<bool>,
}

impl Polygon {
    /// A polygon through `points` (m), closed by itself.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, BuildError> {
        for value in points.iter().flatten() {
            check::finite("points", *value)?;
        }
        if points.len() < 3 {
            return Err(BuildError::Polygon("a polygon needs at least three points"));
        }
        let doubled_area: f64 = edges(points)
            .map(|([ax, ay], [bx, by])| ax * by - bx * ay)
            .sum();
        let reach = points
            .iter()
            .flatten()
            .fold(0.0, |m: f64, v| m.max(v.abs()));
        if doubled_area.abs() <= 1e-12 * reach * reach {
            return Err(BuildError::Polygon(
                "the polygon encloses no area; its points lie on a line",
            ));
        }
        Ok(Self {
            points: points.to_vec(),
            is_wall: vec![true; points.len()],
        })
    }

    /// Signed distance from a point of the plane, negative inside.
    pub fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        let mut squared = f64::INFINITY;
        let mut is_inside = false;
        for (([ax, ay], [bx, by]), &is_wall) in edges(&self.points).zip(&self.is_wall) {
            let (ex, ey, px, py) = (bx - ax, by - ay, x - ax, y - ay);
            if is_wall {
                let length = ex * ex + ey * ey;
                let t = if length > 0.0 {
                    ((px * ex + py * ey) / length).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                squared = squared.min((px - t * ex).powi(2) + (py - t * ey).powi(2));
            }
            // Half-open in y, so that a ray through a vertex crosses one of its two edges.
            if (ay <= y) != (by <= y) && (px * ey < ex * py) == (ey < 0.0) && px * ey != ex * py {
                is_inside = !is_inside;
            }
        }
        if is_inside {
            -squared.sqrt()
        } else {
            squared.sqrt()
        }
    }
}

/// The edges of a closed polygon.
fn edges(points: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    points
        .iter()
        .copied()
        .zip(points.iter().copied().cycle().skip(1))
}

impl Field for Polygon {
    fn sample(&self, points: &[[f64; 3]], values: &mut [f64]) -> Result<(), FieldError> {
        for (value, point) in values.iter_mut().zip(points) {
            *value = self.distance([point[0], point[1]]);
        }
        Ok(())
    }

    fn range(&self, at: &[Range; 3]) -> Result<Range, FieldError> {
        let flat = [at[0], at[1], Range::new(0.0, 0.0)];
        distance_range(&flat, |center| Ok(self.distance([center[0], center[1]])))
    }
}

/// A polygon in the plane across `axis`, drawn from `base` over `height`. For the axis z the
/// polygon's coordinates are x, y.
pub fn prism(
    base: [f64; 3],
    axis: [f64; 3],
    points: &[[f64; 2]],
    height: f64,
) -> Result<Shape, BuildError> {
    let frame = Frame::along(base, axis)?;
    check::positive("height", height)?;
    let polygon = Polygon::new(points)?;
    let ends = [0.0, height];
    let bounds = Bounds::around(
        points
            .iter()
            .flat_map(|p| ends.map(|w| frame.place([p[0], p[1], w]))),
    );
    let [u, v, w] = frame.coordinates();
    let across = Expr::field(Arc::new(polygon), [u, v, 0.0.into()]);
    let along = (w - height / 2.0).abs() - height / 2.0;
    Ok(Shape::distance(corner(&[across, along]), bounds))
}

/// A `profile` of points (radius, height) turned once around `axis` through `base`.
pub fn revolve(base: [f64; 3], axis: [f64; 3], profile: &[[f64; 2]]) -> Result<Shape, BuildError> {
    let frame = Frame::along(base, axis)?;
    let mut polygon = Polygon::new(profile)?;
    if let Some(point) = profile.iter().find(|point| point[0] < 0.0) {
        let allowed = "a radius of the profile must not be negative";
        return Err(BuildError::OutOfRange {
            name: "profile",
            value: point[0],
            allowed,
        });
    }
    // An edge on the axis closes the profile but lies inside the solid: no distance is measured to
    // it.
    polygon.is_wall = edges(profile)
        .map(|(a, b)| a[0] > 0.0 || b[0] > 0.0)
        .collect();
    let rings: Vec<_> = profile.iter().map(|p| (p[0], p[1])).collect();
    let bounds = frame.ring_bounds(&rings);
    let [u, v, w] = frame.coordinates();
    let expr = Expr::field(
        Arc::new(MirroredPolygon(polygon)),
        [length(&[u, v]), w, 0.0.into()],
    );
    Ok(Shape::distance(expr, bounds))
}

/// A polygon at radius ≥ 0 whose mirror image closes it across the axis.
///
/// On the axis itself the crossing number is undecided (the edge there is the ray's end), so the radius is moved off it
/// by a part of the profile's width below the rounding of float64 distances.
#[derive(Debug)]
struct MirroredPolygon(Polygon);

impl MirroredPolygon {
    fn distance(&self, [radius, height]: [f64; 2]) -> f64 {
        let width = self.0.points.iter().fold(0.0, |m: f64, p| m.max(p[0]));
        self.0.distance([radius.max(1e-15 * width), height])
    }
}

impl Field for MirroredPolygon {
    fn sample(&self, points: &[[f64; 3]], values: &mut [f64]) -> Result<(), FieldError> {
        for (value, point) in values.iter_mut().zip(points) {
            *value = self.distance([point[0], point[1]]);
        }
        Ok(())
    }

    fn range(&self, at: &[Range; 3]) -> Result<Range, FieldError> {
        let flat = [at[0], at[1], Range::new(0.0, 0.0)];
        distance_range(&flat, |center| {
            Ok(self.distance([center[0].max(0.0), center[1]]))
        })
    }
}

/// A cone or its frustum: `radius` at `base`, `top_radius` (may be 0) at `height` along `axis`.
pub fn cone(
    base: [f64; 3],
    axis: [f64; 3],
    radius: f64,
    top_radius: f64,
    height: f64,
) -> Result<Shape, BuildError> {
    for (name, value) in [("radius", radius), ("top_radius", top_radius)] {
        if !(value >= 0.0 && value.is_finite()) {
            let allowed = "it must be zero or positive";
            return Err(BuildError::OutOfRange {
                name,
                value,
                allowed,
            });
        }
    }
    if radius == 0.0 && top_radius == 0.0 {
        return Err(BuildError::NotPositive {
            name: "radius",
            value: radius,
        });
    }
    check::positive("height", height)?;
    revolve(
        base,
        axis,
        &[
            [0.0, 0.0],
            [radius, 0.0],
            [top_radius, height],
            [0.0, height],
        ],
    )
}
