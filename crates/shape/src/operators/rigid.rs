//! Translation, rotation, mirroring, scaling and arrays of copies.
use std::f64::consts::TAU;

use super::{shifted_axes, union};
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;
use crate::frame::{cross, dot};
use crate::shape::Shape;

/// Largest number of copies, as each is compiled.
const MOST_COPIES: usize = 4096;

/// The shape moved by `by` (m).
pub fn translate(shape: &Shape, by: [f64; 3]) -> Result<Shape, BuildError> {
    check::point("by", by)?;
    let bounds = Bounds {
        low: [0, 1, 2].map(|i| shape.bounds.low[i] + by[i]),
        high: [0, 1, 2].map(|i| shape.bounds.high[i] + by[i]),
    };
    let expr = shape.expr.remap(&shifted_axes(by));
    Ok(Shape {
        expr,
        bounds,
        growth: shape.growth,
    })
}

/// The shape rotated by `angle` (rad, right-handed) around `axis` through `center`.
pub fn rotate(
    shape: &Shape,
    axis: [f64; 3],
    angle: f64,
    center: [f64; 3],
) -> Result<Shape, BuildError> {
    let axis = check::direction("axis", axis)?;
    check::finite("angle", angle)?;
    check::point("center", center)?;
    Ok(apply_rotation(shape, rotation(axis, angle), center))
}

/// The mirror image across the plane through `point` across `normal`.
pub fn mirror(shape: &Shape, point: [f64; 3], normal: [f64; 3]) -> Result<Shape, BuildError> {
    check::point("point", point)?;
    let n = check::direction("normal", normal)?;
    let reflection = matrix(|i, j| if i == j { 1.0 } else { 0.0 } - 2.0 * n[i] * n[j]);
    Ok(apply_rotation(shape, reflection, point))
}

/// The shape enlarged by `factors` along x, y, z, away from `center`.
///
/// With one factor for all axes distances stay true; with different ones the function is multiplied
/// by the smallest, which keeps it a lower bound of the distance.
pub fn scale(shape: &Shape, factors: [f64; 3], center: [f64; 3]) -> Result<Shape, BuildError> {
    check::point("center", center)?;
    for factor in factors {
        check::positive("factor", factor)?;
    }
    let local = shifted_axes(center);
    let shrunk = [0, 1, 2].map(|i| local[i].clone() / factors[i] + center[i]);
    let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
    let most = factors.iter().copied().fold(0.0, f64::max);
    let stretch = |v: f64, i: usize| center[i] + (v - center[i]) * factors[i];
    let bounds = Bounds {
        low: [0, 1, 2].map(|i| stretch(shape.bounds.low[i], i)),
        high: [0, 1, 2].map(|i| stretch(shape.bounds.high[i], i)),
    };
    let expr = shape.expr.remap(&shrunk) * least;
    Ok(Shape {
        expr,
        bounds,
        growth: shape.growth * least / most,
    })
}

/// `count` copies along x, y, z, `spacing` (m) apart; the first is the shape itself.
pub fn array(shape: &Shape, count: [usize; 3], spacing: [f64; 3]) -> Result<Shape, BuildError> {
    check::point("spacing", spacing)?;
    check_count(
        count
            .iter()
            .try_fold(1_usize, |all, &n| all.checked_mul(n))
            .unwrap_or(0),
    )?;
    let mut copies = Vec::new();
    for i in 0..count[0] {
        for j in 0..count[1] {
            for k in 0..count[2] {
                let steps = [i, j, k];
                copies.push(translate(
                    shape,
                    [0, 1, 2].map(|a| steps[a] as f64 * spacing[a]),
                )?);
            }
        }
    }
    union(&copies)
}

/// `count` copies around `axis` through `center`, spread over `angle` (rad). A full turn spaces
/// them evenly; a part of a turn puts copies at both of its ends.
pub fn polar_array(
    shape: &Shape,
    count: usize,
    axis: [f64; 3],
    angle: f64,
    center: [f64; 3],
) -> Result<Shape, BuildError> {
    check_count(count)?;
    check::finite("angle", angle)?;
    let is_full_turn = (angle.abs() - TAU).abs() < 1e-9;
    let gaps = if is_full_turn {
        count
    } else {
        count.saturating_sub(1).max(1)
    };
    let turned = |i: usize| rotate(shape, axis, angle * i as f64 / gaps as f64, center);
    union(&(0..count).map(turned).collect::<Result<Vec<_>, _>>()?)
}

fn check_count(count: usize) -> Result<(), BuildError> {
    if (1..=MOST_COPIES).contains(&count) {
        return Ok(());
    }
    let allowed = "there must be between 1 and 4096 copies in all";
    Err(BuildError::OutOfRange {
        name: "count",
        value: count as f64,
        allowed,
    })
}

fn matrix(entry: impl Fn(usize, usize) -> f64) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// Rotation matrix by Rodrigues' formula. Sines and cosines of quarter turns are made exact, so that a rotated box
/// keeps its faces on the lattice.
fn rotation(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let exact = |v: f64| {
        if (v - v.round()).abs() < 1e-15 {
            v.round()
        } else {
            v
        }
    };
    let (sine, cosine) = (exact(angle.sin()), exact(angle.cos()));
    let unit = |i: usize| [0, 1, 2].map(|j| if i == j { 1.0 } else { 0.0 });
    // Column j is the image of the unit vector j.
    let columns = [0, 1, 2].map(|j| {
        let (e, turned) = (unit(j), cross(axis, unit(j)));
        let along = dot(axis, e) * (1.0 - cosine);
        [0, 1, 2].map(|i| cosine * e[i] + sine * turned[i] + along * axis[i])
    });
    matrix(|i, j| columns[j][i])
}

/// Transforms the shape by an orthogonal matrix about `center`; the function is evaluated at the inversely transformed
/// point.
fn apply_rotation(shape: &Shape, forward: [[f64; 3]; 3], center: [f64; 3]) -> Shape {
    let local = shifted_axes(center);
    let back = [0, 1, 2].map(|i| {
        let terms = (0..3).filter(|&j| forward[j][i] != 0.0);
        let products = terms.map(|j| local[j].clone() * forward[j][i]);
        products
            .reduce(|a, b| a + b)
            .unwrap_or_else(|| Expr::constant(0.0))
            + center[i]
    });
    Shape {
        expr: shape.expr.remap(&back),
        bounds: turned_bounds(&shape.bounds, forward, center),
        growth: shape.growth,
    }
}

/// Box around a rotated box; a side is infinite only if an infinite side of the old box contributes to it.
fn turned_bounds(bounds: &Bounds, forward: [[f64; 3]; 3], center: [f64; 3]) -> Bounds {
    if bounds.is_empty() {
        return Bounds::EMPTY;
    }
    let mut turned = Bounds::new(center, center);
    for (i, row) in forward.iter().enumerate() {
        for (j, &factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
            let ends = [bounds.low[j], bounds.high[j]].map(|v| factor * (v - center[j]));
            turned.low[i] += ends[0].min(ends[1]);
            turned.high[i] += ends[0].max(ends[1]);
        }
    }
    turned
}
