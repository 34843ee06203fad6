//! Shapes made from shapes.
mod boolean;
mod deform;
mod rigid;
mod surface;

pub use boolean::{
    difference, intersection, smooth_difference, smooth_intersection, smooth_union, union,
};
pub use deform::{bend, taper, twist};
pub use rigid::{array, mirror, polar_array, rotate, scale, translate};
pub use surface::{blend, clip, graded_offset, graded_shell, offset, shell};

use crate::expr::Expr;

/// Coordinates measured from `origin`.
pub(crate) fn shifted_axes(origin: [f64; 3]) -> [Expr; 3] {
    let [x, y, z] = Expr::axes();
    [x - origin[0], y - origin[1], z - origin[2]]
}
