//! Gap between a point and a triangle, and its derivatives when both move.
//!
//! With the closest point `y = Σ b_i x_i` of the triangle and the relative position `r = x − y`, the gap is `g = n·r`,
//! and `∂g = n·(∂x − Σ b_i ∂x_i)`: motion of the closest point along the triangle does not change it. Over the inside
//! of a triangle, with `∇β_i` the gradients of its barycentric coordinates, the second variation is
//! `−2 Σ (n·∂x_i)(∇β_i·∂r) − g Σ (∇β_i·∇β_j)(n·∂x_i)(n·∂x_j)` with `∂r = ∂x − Σ b_i ∂x_i`: the normal turns by
//! `∂n = −Σ (n·∂x_i) ∇β_i`. Beside a triangle the normal is held constant.

use voxsoft_solid::vector::{Vec3, axpy, cross, dot, norm, scale, sub};

/// Closest point of a triangle to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Closest {
    /// Barycentric coordinates.
    pub weights: [f64; 3],
    /// Vector from it to the point, m.
    pub away: Vec3,
    /// Distance, m.
    pub distance: f64,
}

impl Closest {
    /// Tests whether it is inside the triangle, not on an edge or a corner.
    pub fn is_inside(&self) -> bool {
        self.weights.iter().all(|w| *w > 0.0)
    }
}

/// Area of a triangle.
pub(crate) fn area(corners: [Vec3; 3]) -> f64 {
    norm(doubled(corners)) / 2.0
}

/// Twice the area along the outward normal.
pub(crate) fn doubled([a, b, c]: [Vec3; 3]) -> Vec3 {
    cross(sub(b, a), sub(c, a))
}

/// Outward unit normal; zero for a degenerate triangle.
pub(crate) fn normal(corners: [Vec3; 3]) -> Vec3 {
    unit(doubled(corners))
}

pub(crate) fn unit(a: Vec3) -> Vec3 {
    let length = norm(a);
    if length > 0.0 {
        scale(1.0 / length, a)
    } else {
        [0.0; 3]
    }
}

/// Closest-point projection onto a triangle (Ericson, Real-Time Collision Detection, section 5.1.5).
pub(crate) fn closest(point: Vec3, [a, b, c]: [Vec3; 3]) -> Closest {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let weights = || {
        let ap = sub(point, a);
        let (d1, d2) = (dot(ab, ap), dot(ac, ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return [1.0, 0.0, 0.0];
        }
        let bp = sub(point, b);
        let (d3, d4) = (dot(ab, bp), dot(ac, bp));
        if d3 >= 0.0 && d4 <= d3 {
            return [0.0, 1.0, 0.0];
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            let v = d1 / (d1 - d3);
            return [1.0 - v, v, 0.0];
        }
        let cp = sub(point, c);
        let (d5, d6) = (dot(ab, cp), dot(ac, cp));
        if d6 >= 0.0 && d5 <= d6 {
            return [0.0, 0.0, 1.0];
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            let w = d2 / (d2 - d6);
            return [1.0 - w, 0.0, w];
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
            let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            return [0.0, 1.0 - w, w];
        }
        let sum = va + vb + vc;
        [va / sum, vb / sum, vc / sum]
    };
    let weights = weights();
    let mut away = point;
    for (weight, corner) in weights.iter().zip([a, b, c]) {
        axpy(&mut away, -weight, corner);
    }
    Closest {
        weights,
        away,
        distance: norm(away),
    }
}

/// Gradients of the barycentric coordinates in the plane of a triangle, 1/m.
pub(crate) fn barycentric_gradients([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    let doubled = doubled([a, b, c]);
    let square = dot(doubled, doubled);
    // Each is the opposite edge, turned inward by a right angle, over twice the area.
    [sub(c, b), sub(a, c), sub(b, a)].map(|edge| scale(1.0 / square, cross(doubled, edge)))
}

/// Crossing of two lines, such as edges of two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Closest points of the lines, as parts of the ways between the given points.
    pub along: [f64; 2],
    /// Unit vector of the cross product of their directions.
    pub normal: Vec3,
    /// Signed distance from the second to the first along it, m.
    pub gap: f64,
    /// Dual vectors of their directions in the plane of both, 1/m: the derivatives of `along`.
    pub duals: [Vec3; 2],
}

/// Smallest sine of the angle between lines that cross; others are too near to parallel.
const LEAST_SINE: f64 = 0.05;

/// Crossing of two lines through given points; `None` for nearly parallel ones.
///
/// With the directions `a` and `b`, `c = a × b` and the dual vectors `A = b × c/c²`, `B = c × a/c²`, the vector `r`
/// between the first points determines the rest: the lines are closest where `r + s a − t b` is along `c`, at
/// `s = −A·r`, `t = B·r`. When both move, the normal turns by `∂n = −(n·∂a) A − (n·∂b) B`, as that of a triangle does
/// with the gradients of its coordinates: the formulas above hold with `−A, A` for the points of the first line and
/// `−B, B` for those of the second.
pub(crate) fn crossing(first: [Vec3; 2], second: [Vec3; 2]) -> Option<Crossing> {
    let (a, b) = (sub(first[1], first[0]), sub(second[1], second[0]));
    let c = cross(a, b);
    let square = dot(c, c);
    if !(square > LEAST_SINE * LEAST_SINE * dot(a, a) * dot(b, b)) {
        return None;
    }
    let duals = [
        scale(1.0 / square, cross(b, c)),
        scale(1.0 / square, cross(c, a)),
    ];
    let between = sub(first[0], second[0]);
    let normal = scale(1.0 / square.sqrt(), c);
    Some(Crossing {
        along: [-dot(duals[0], between), dot(duals[1], between)],
        normal,
        gap: dot(between, normal),
        duals,
    })
}

/// Affine coordinates of a point's foot in the plane of a triangle.
pub(crate) fn affine(point: Vec3, corners: [Vec3; 3]) -> [f64; 3] {
    let gradients = barycentric_gradients(corners);
    let second = dot(gradients[1], sub(point, corners[0]));
    let third = dot(gradients[2], sub(point, corners[0]));
    [1.0 - second - third, second, third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0..1.0)
    }

    proptest! {
        #[test]
        fn no_point_of_the_triangle_is_closer(
            p in point(), corners in prop::array::uniform3(point()), u in 0.0..1.0f64, v in 0.0..1.0f64,
        ) {
            let found = closest(p, corners);
            prop_assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            prop_assert!(found.weights.iter().all(|w| *w >= 0.0));
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let mut other = sub(p, scale(1.0 - u - v, corners[0]));
            axpy(&mut other, -u, corners[1]);
            axpy(&mut other, -v, corners[2]);
            prop_assert!(found.distance <= norm(other) + 1e-12);
        }

        #[test]
        fn crossing_has_the_smallest_distance_of_two_lines(
            first in prop::array::uniform2(point()), second in prop::array::uniform2(point()),
            u in -2.0..2.0f64, v in -2.0..2.0f64,
        ) {
            let Some(found) = crossing(first, second) else { return Ok(()) };
            let place = |[a, b]: [Vec3; 2], along: f64| {
                let mut place = scale(1.0 - along, a);
                axpy(&mut place, along, b);
                place
            };
            let between = sub(place(first, found.along[0]), place(second, found.along[1]));
            // Coordinates are up to the inverse of the smallest sine.
            prop_assert!(norm(sub(between, scale(found.gap, found.normal))) < 1e-11);
            let other = sub(place(first, u), place(second, v));
            prop_assert!(found.gap.abs() <= norm(other) + 1e-12);
        }

        #[test]
        fn affine_coordinates_rebuild_the_foot(p in point(), corners in prop::array::uniform3(point())) {
            prop_assume!(area(corners) > 1e-3);
            let weights = affine(p, corners);
            let mut away = p;
            for (weight, corner) in weights.iter().zip(corners) {
                axpy(&mut away, -weight, corner);
            }
            let n = normal(corners);
            let along = dot(away, n);
            axpy(&mut away, -along, n);
            prop_assert!(norm(away) < 1e-9);
        }
    }
}
