//! Signs of determinants, exact for every input (Shewchuk 1997, doi 10.1007/PL00009321).
use robust::{Coord, Coord3D, orient2d, orient3d};

/// A point (m).
pub type Point = [f64; 3];

/// Orientation predicate: the side of the plane through `a`, `b`, `c` on which the point `d` lies.
///
/// Positive where the normal (b − a) × (c − a) points to, negative behind, zero on the plane; the sign is exact, the
/// size is six times the volume of the tetrahedron up to rounding.
pub(crate) fn side(a: Point, b: Point, c: Point, d: Point) -> f64 {
    let coord = |[x, y, z]: Point| Coord3D { x, y, z };
    -orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Twice the signed area of a triangle in the plane, its sign exact.
pub(crate) fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let coord = |[x, y]: [f64; 2]| Coord { x, y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Tests whether the tetrahedron has positive volume.
pub(crate) fn is_positive([a, b, c, d]: [Point; 4]) -> bool {
    side(a, b, c, d) > 0.0
}

/// Number of faces of a positive tetrahedron on which a point lies, if the tetrahedron contains it.
pub(crate) fn faces_touched([a, b, c, d]: [Point; 4], p: Point) -> Option<usize> {
    let mut touched = 0;
    for [u, v, w] in [[b, d, c], [a, c, d], [a, d, b], [a, b, c]] {
        let inward = side(u, v, w, p);
        if inward < 0.0 {
            return None;
        }
        touched += usize::from(inward == 0.0);
    }
    Some(touched)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_above_is_on_the_positive_side() {
        let [a, b, c] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(side(a, b, c, [0.3, 0.3, 1e-300]) > 0.0);
        assert!(side(a, b, c, [0.3, 0.3, -1e-300]) < 0.0);
        assert_eq!(side(a, b, c, [7.0, -3.0, 0.0]), 0.0);
    }

    #[test]
    fn points_in_and_on_a_tetrahedron() {
        let tet = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(is_positive(tet));
        assert_eq!(faces_touched(tet, [0.1; 3]), Some(0));
        assert_eq!(faces_touched(tet, [0.1, 0.1, 0.0]), Some(1));
        assert_eq!(faces_touched(tet, [0.0; 3]), Some(3));
        assert_eq!(faces_touched(tet, [0.1, 0.1, -1e-300]), None);
    }
}
