//! Operations on vectors of three.

/// A vector or a point in space.
pub type Vec3 = [f64; 3];

/// `a + b`.
#[inline(always)]
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
#[inline(always)]
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s a`.
#[inline(always)]
pub fn scale(s: f64, a: Vec3) -> Vec3 {
    [s * a[0], s * a[1], s * a[2]]
}

/// Adds `s b` to `a` in place.
#[inline(always)]
pub fn axpy(a: &mut Vec3, s: f64, b: Vec3) {
    a[0] += s * b[0];
    a[1] += s * b[1];
    a[2] += s * b[2];
}

/// The scalar product.
#[inline(always)]
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[inline(always)]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The Euclidean length.
#[inline(always)]
pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// Rotates `a` about the unit vector `axis` by `angle` radians (Rodrigues' formula).
pub fn rotate(a: Vec3, axis: Vec3, angle: f64) -> Vec3 {
    let (sin, cos) = libm::sincos(angle);
    let along = scale(dot(axis, a) * (1.0 - cos), axis);
    add(add(scale(cos, a), scale(sin, cross(axis, a))), along)
}
