//! Twist, bend and taper: the function is evaluated at the inversely deformed point.
//!
//! They stretch space, so the function is no longer a distance: a shell or offset taken afterwards is thicker where
//! space was compressed. Take it before the deformation if that matters.
use crate::bounds::Bounds;
use crate::check;
use crate::error::BuildError;
use crate::expr::Expr;
use crate::frame::Frame;
use crate::shape::Shape;

/// Rotates each section normal to `axis` through `center` by `rate` (rad/m) times its height above `center`.
pub fn twist(
    shape: &Shape,
    rate: f64,
    axis: [f64; 3],
    center: [f64; 3],
) -> Result<Shape, BuildError> {
    check::finite("rate", rate)?;
    let frame = Frame::along(center, axis)?;
    let [u, v, w] = frame.coordinates();
    let angle = w.clone() * rate;
    let (sine, cosine) = (angle.sin(), angle.cos());
    let back = [
        u.clone() * cosine.clone() + v.clone() * sine.clone(),
        v * cosine - u * sine,
        w,
    ];
    Ok(asked_at(shape, &frame, back))
}

/// Bends the shape around an arc: straight lines along `axis` become circles of `curvature` (1/m)
/// in the plane of `axis` and `toward`, with their centers on the side of `toward`. Nothing moves
/// at `center`.
///
/// # Errors
/// `toward` must not be parallel to `axis`; the curvature must be finite and not zero.
pub fn bend(
    shape: &Shape,
    curvature: f64,
    axis: [f64; 3],
    toward: [f64; 3],
    center: [f64; 3],
) -> Result<Shape, BuildError> {
    check::finite("curvature", curvature)?;
    if curvature == 0.0 {
        let allowed = "it must not be zero; leave the bend out for a straight shape";
        return Err(BuildError::OutOfRange {
            name: "curvature",
            value: curvature,
            allowed,
        });
    }
    let frame = bending_frame(axis, toward, center)?;
    let [u, v, w] = frame.coordinates();
    let radius = 1.0 / curvature;
    // The arc of a line at distance u from the neutral line has radius R − u about the point (R, 0)
    // of the (u, w) plane; its length on the neutral line is R times the angle.
    let side = radius.signum();
    let (from_center, along) = ((radius - u) * side, w * side);
    let arc = along.atan2(from_center.clone()) * radius;
    let depth = radius - crate::expr::length(&[from_center, along]) * side;
    Ok(asked_at(shape, &frame, [depth, v, arc]))
}

/// Scales each section across `axis`: by 1 at `center`, by `factor` at `height` (m) and beyond.
///
/// The function is multiplied by the local factor, which makes it a distance to first order.
pub fn taper(
    shape: &Shape,
    factor: f64,
    height: f64,
    axis: [f64; 3],
    center: [f64; 3],
) -> Result<Shape, BuildError> {
    check::positive("factor", factor)?;
    check::positive("height", height)?;
    let frame = Frame::along(center, axis)?;
    let [u, v, w] = frame.coordinates();
    let local = 1.0 + (w.clone() / height).clamp(0.0, 1.0) * (factor - 1.0);
    let tapered = asked_at(shape, &frame, [u / local.clone(), v / local.clone(), w]);
    Ok(Shape::unknown(tapered.expr * local.min(1.0)))
}

fn bending_frame(axis: [f64; 3], toward: [f64; 3], center: [f64; 3]) -> Result<Frame, BuildError> {
    let w = check::direction("axis", axis)?;
    let toward = check::direction("toward", toward)?;
    let along = crate::frame::dot(toward, w);
    let across = [0, 1, 2].map(|i| toward[i] - along * w[i]);
    if crate::frame::dot(across, across) < 1e-18 {
        return Err(BuildError::OutOfRange {
            name: "toward",
            value: along,
            allowed: "it must not be parallel to axis (the number is the cosine between them)",
        });
    }
    let u = check::direction("toward", across)?;
    let origin = check::point("center", center)?;
    Ok(Frame {
        origin,
        axes: [u, crate::frame::cross(w, u), w],
    })
}

/// Shape of the function at the point with local coordinates `back`.
fn asked_at(shape: &Shape, frame: &Frame, back: [Expr; 3]) -> Shape {
    let space = [0, 1, 2].map(|i| {
        let terms = (0..3).filter(|&a| frame.axes[a][i] != 0.0);
        let products = terms.map(|a| back[a].clone() * frame.axes[a][i]);
        products
            .reduce(|a, b| a + b)
            .unwrap_or_else(|| Expr::constant(0.0))
            + frame.origin[i]
    });
    // An empty shape stays empty; otherwise the bounds are searched.
    let bounds = if shape.bounds.is_empty() {
        Bounds::EMPTY
    } else {
        Bounds::ALL
    };
    Shape {
        bounds,
        ..Shape::unknown(shape.expr.remap(&space))
    }
}
