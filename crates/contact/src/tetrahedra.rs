//! Intersection test of two tetrahedra, decided without rounding.
use crate::bounds::Bounds;
use crate::expansion::sign_of;
use crate::predicates::{Point, is_positive, side};

/// Faces of a positive tetrahedron, outward.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
/// Edges, and the two vertices opposite to each.
const EDGES: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 1, 3],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 0, 2],
    [2, 3, 0, 1],
];

/// Tests whether the interiors of two tetrahedra intersect; one without positive volume intersects none.
///
/// They are disjoint exactly if one of the planes along a face of either, or along an edge of each, separates them
/// (separating-axis theorem: the facets of the difference of two convex bodies lie in no other directions).
pub(crate) fn overlap(one: [Point; 4], other: [Point; 4]) -> bool {
    Bounds::of(one).overlaps(&Bounds::of(other))
        && is_positive(one)
        && is_positive(other)
        && !a_face_parts(one, other)
        && !a_face_parts(other, one)
        && !edges_part(one, other)
}

fn a_face_parts(one: [Point; 4], other: [Point; 4]) -> bool {
    FACES.iter().any(|&[a, b, c]| {
        other
            .iter()
            .all(|&point| side(one[a], one[b], one[c], point) >= 0.0)
    })
}

fn edges_part(one: [Point; 4], other: [Point; 4]) -> bool {
    EDGES.iter().any(|&[a, b, p, q]| {
        EDGES.iter().any(|&[c, d, r, s]| {
            let height = |point| sign_of([one[a], one[b]], [other[c], other[d]], [one[a], point]);
            let own = [height(one[p]), height(one[q])];
            if own[0] * own[1] < 0.0 {
                return false;
            }
            let below = own[0] + own[1];
            let foreign = [other[c], other[r], other[s]].map(height);
            let all = |sign: f64| foreign.iter().all(|&h| h * sign >= 0.0);
            // Zero everywhere: the edges are parallel, and span no plane.
            let flat = below == 0.0 && foreign.iter().all(|&h| h == 0.0);
            !flat && ((below <= 0.0 && all(1.0)) || (below >= 0.0 && all(-1.0)))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNER: [Point; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn both(one: [Point; 4], other: [Point; 4]) -> bool {
        let found = overlap(one, other);
        assert_eq!(found, overlap(other, one));
        found
    }

    fn moved(tet: [Point; 4], by: Point) -> [Point; 4] {
        tet.map(|p| std::array::from_fn(|i| p[i] + by[i]))
    }

    #[test]
    fn a_tetrahedron_overlaps_itself_and_smaller_ones_in_it() {
        assert!(both(CORNER, CORNER));
        let small = CORNER.map(|p| p.map(|x| 0.125 * x));
        assert!(both(CORNER, moved(small, [0.125; 3])));
        assert!(both(CORNER, moved(small, [0.875, 0.0, 0.0])));
        assert!(!both(CORNER, moved(small, [1.0, 0.0, 0.0])));
    }

    #[test]
    fn common_faces_edges_and_vertices_are_no_overlap() {
        let beyond = [[1.0; 3], CORNER[1], CORNER[3], CORNER[2]];
        assert!(is_positive(beyond));
        assert!(!both(CORNER, beyond));
        let mirrored = [CORNER[0], CORNER[2], CORNER[1], [0.0, 0.0, -1.0]];
        assert!(!both(CORNER, mirrored));
    }

    #[test]
    fn tetrahedra_with_crossing_edges_overlap() {
        // Kepler's star: every edge of one crosses one of the other's on a face of the cube.
        let one = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
        let other = one.map(|p| p.map(|x| 1.0 - x));
        let positive = |tet: [Point; 4]| {
            if is_positive(tet) {
                tet
            } else {
                [tet[0], tet[1], tet[3], tet[2]]
            }
        };
        assert!(both(positive(one), positive(other)));
    }

    #[test]
    fn crossed_edges_separate_or_overlap() {
        let below = [
            [-1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, -1.0],
            [0.0, -1.0, -1.0],
        ];
        let above = |z| {
            [
                [0.0, -1.0, z],
                [0.0, 1.0, z],
                [1.0, 0.0, z + 1.0],
                [-1.0, 0.0, z + 1.0],
            ]
        };
        let positive = |tet: [Point; 4]| {
            if is_positive(tet) {
                tet
            } else {
                [tet[0], tet[1], tet[3], tet[2]]
            }
        };
        assert!(!both(positive(below), positive(above(0.0))));
        assert!(both(positive(below), positive(above(-1e-12))));
    }
}
