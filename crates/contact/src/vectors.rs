//! Operations on small vectors.
use crate::predicates::Point;

pub(crate) fn sub(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Adds `factor` times `b` to `a`.
pub(crate) fn axpy(a: &mut Point, factor: f64, b: Point) {
    for i in 0..3 {
        a[i] += factor * b[i];
    }
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    let d = sub(a, b);
    dot(d, d).sqrt()
}

/// Distance of a point from a closed triangle (Ericson 2005, Real-Time Collision Detection, 5.1.5).
pub(crate) fn distance_to_triangle(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let along = |q: Point| (dot(ab, sub(p, q)), dot(ac, sub(p, q)));
    let ((d1, d2), (d3, d4), (d5, d6)) = (along(a), along(b), along(c));
    let point = |s: f64, t: f64| {
        let mut q = a;
        axpy(&mut q, s, ab);
        axpy(&mut q, t, ac);
        distance(p, q)
    };
    if d1 <= 0.0 && d2 <= 0.0 {
        return distance(p, a);
    }
    if d3 >= 0.0 && d4 <= d3 {
        return distance(p, b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return point(d1 / (d1 - d3), 0.0);
    }
    if d6 >= 0.0 && d5 <= d6 {
        return distance(p, c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return point(0.0, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return point(1.0 - t, t);
    }
    let sum = va + vb + vc;
    point(vb / sum, vc / sum)
}
