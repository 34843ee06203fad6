//! Vector operations.

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Signed volume of a tetrahedron.
pub(crate) fn tet_volume([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(sub(b, a), cross(sub(c, a), sub(d, a))) / 6.0
}

/// Area of a triangle.
pub(crate) fn triangle_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    norm(cross(sub(b, a), sub(c, a))) / 2.0
}

/// Volume enclosed by outward triangles (divergence theorem), negative if they point inward.
///
/// Positions are taken from the first corner: far from the origin this keeps the digits that the
/// sum of large terms of either sign would lose.
pub(crate) fn enclosed_volume(vertices: &[[f64; 3]], triangles: &[[i32; 3]]) -> f64 {
    let Some(first) = triangles.first() else {
        return 0.0;
    };
    let origin = vertices[first[0] as usize];
    let at = |v: i32| sub(vertices[v as usize], origin);
    triangles
        .iter()
        .map(|&[a, b, c]| dot(at(a), cross(at(b), at(c))) / 6.0)
        .sum()
}
