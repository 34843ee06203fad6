//! Solids with a closed form. All are true distances (s equals the signed distance in m) unless noted otherwise;
//! arguments are in m.
mod boxes;
mod polygons;
mod rounds;

pub use boxes::{cuboid, half_space, rounded_box};
pub use polygons::{Polygon, cone, prism, revolve};
pub use rounds::{capsule, cylinder, ellipsoid, sphere, torus, tube};

use crate::expr::{Expr, length};

/// Distance to the set where both `a` < 0 and `b` < 0 for two functions that measure along
/// perpendicular directions: outside a corner it is the length of the positive parts.
pub(crate) fn corner(parts: &[Expr]) -> Expr {
    let positive: Vec<_> = parts.iter().map(|p| p.max(0.0)).collect();
    let deepest = parts
        .iter()
        .cloned()
        .reduce(|a, b| a.max(b))
        .unwrap_or_else(|| 0.0.into());
    length(&positive) + deepest.min(0.0)
}
