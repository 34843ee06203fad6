//! Split of a cube into five tetrahedra.
//!
//! A lattice node is even if the sum of its three indices is even. Every face of the lattice has two even corners, and
//! they lie on a diagonal. The tetrahedron of a cube's four even corners uses that diagonal on all six faces; the rest
//! of the cube is four tetrahedra, each an odd corner with its three neighbors. Two cubes that share a face thus always
//! cut it along the same diagonal, and the mesh conforms. The middle tetrahedron has a third of the cube's volume, the
//! others a sixth.
//!
//! Corner `c` of a cube lies at `(c >> 2 & 1, c >> 1 & 1, c & 1)`, so corners are in C order.

/// Five tetrahedra of a cube whose corner 0 is an even node, with positive volume.
const EVEN: [[usize; 4]; 5] = [
    [0, 5, 6, 3],
    [4, 0, 5, 6],
    [2, 0, 6, 3],
    [1, 0, 3, 5],
    [7, 6, 5, 3],
];

/// Five tetrahedra for an odd corner 0: [`EVEN`] mirrored in x, two corners swapped to keep the sign.
const ODD: [[usize; 4]; 5] = [
    [4, 1, 7, 2],
    [0, 4, 2, 1],
    [6, 4, 7, 2],
    [5, 4, 1, 7],
    [3, 2, 7, 1],
];

/// Corners of the faces −x, +x, −y, +y, −z, +z, counter-clockwise seen from outside.
const FACES: [[usize; 4]; 6] = [
    [0, 1, 3, 2],
    [4, 6, 7, 5],
    [0, 4, 5, 1],
    [2, 3, 7, 6],
    [0, 2, 6, 4],
    [1, 5, 7, 3],
];

/// Corners of the five tetrahedra of a cube; `even` is the parity of its corner 0.
pub(crate) fn tets(even: bool) -> &'static [[usize; 4]; 5] {
    if even { &EVEN } else { &ODD }
}

/// Corners of the two triangles of a face, outward; faces are −x, +x, −y, +y, −z, +z.
pub(crate) fn face_triangles(even: bool, face: usize) -> [[usize; 3]; 2] {
    let [a, b, c, d] = FACES[face];
    let a_is_even = (a.count_ones() % 2 == 0) == even;
    if a_is_even {
        [[a, b, c], [a, c, d]]
    } else {
        [[b, c, d], [b, d, a]]
    }
}

/// True if a node, or the cube whose corner 0 it is, is even.
pub(crate) fn is_even(node: [i32; 3]) -> bool {
    // The lowest bit of a sum is the exclusive or of the lowest bits, also for negative numbers.
    (node[0] ^ node[1] ^ node[2]) & 1 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(c: usize) -> [f64; 3] {
        [2, 1, 0].map(|bit| (c >> bit & 1) as f64)
    }

    fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| a[i] - b[i])
    }

    fn det([a, b, c]: [[f64; 3]; 3]) -> f64 {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    #[test]
    fn volumes_are_a_third_and_four_sixths() {
        for even in [true, false] {
            let volumes = tets(even).map(|tet| {
                let [a, b, c, d] = tet.map(corner);
                det([sub(b, a), sub(c, a), sub(d, a)]) / 6.0
            });
            assert_eq!(
                volumes,
                [1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0]
            );
        }
    }

    #[test]
    fn faces_point_outward_and_are_faces_of_tets() {
        for even in [true, false] {
            for face in 0..6 {
                for triangle in face_triangles(even, face) {
                    let [a, b, c] = triangle.map(corner);
                    let mut normal = [0.0; 3];
                    normal[face / 2] = if face % 2 == 0 { -1.0 } else { 1.0 };
                    assert_eq!(det([normal, sub(b, a), sub(c, a)]), 1.0);
                    let holders = tets(even)
                        .iter()
                        .filter(|tet| triangle.iter().all(|c| tet.contains(c)));
                    assert_eq!(holders.count(), 1, "{triangle:?}");
                }
            }
        }
    }
}
