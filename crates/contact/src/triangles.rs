//! Intersection test of two triangles, decided without rounding.
use crate::predicates::{Point, area, side};
use crate::vectors::{cross, dot, sub};

/// Vertex numbers of a triangle.
pub(crate) type Corners = [i32; 3];

/// Intersection of two triangles, beyond the vertices that they share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meeting {
    /// No common point.
    Apart,
    /// Common points, but neither passes through the other.
    Touch,
    /// Interiors cross along a segment.
    Cross,
}

/// Bound of the rounding error, relative to the products that are added up: more than is possible in a dozen
/// operations.
const ROUNDING: f64 = 1e-14;

/// Classifies the intersection of two triangles of a surface.
pub(crate) fn meeting(points: &[Point], one: Corners, other: Corners) -> Meeting {
    let shared = one.iter().filter(|corner| other.contains(corner)).count();
    match shared {
        0 => unlinked(points, one, other),
        1 => at_a_vertex(points, one, other),
        2 => along_an_edge(points, one, other),
        _ => Meeting::Apart,
    }
}

fn unlinked(points: &[Point], one: Corners, other: Corners) -> Meeting {
    let (t, u) = (at(points, one), at(points, other));
    if a_plane_parts(t, u) || a_plane_parts(u, t) {
        return Meeting::Apart;
    }
    let behind = u.map(|p| side(t[0], t[1], t[2], p));
    if one_sided(behind) {
        return Meeting::Apart;
    }
    let before = t.map(|p| side(u[0], u[1], u[2], p));
    if one_sided(before) {
        return Meeting::Apart;
    }
    if crosses(t, u, before, behind) {
        return Meeting::Cross;
    }
    let touches = |[a, b, c]: [Point; 3], triangle| {
        [[a, b], [b, c], [c, a]]
            .into_iter()
            .any(|edge| reaches(edge, triangle))
    };
    if touches(t, u) || touches(u, t) {
        Meeting::Touch
    } else {
        Meeting::Apart
    }
}

/// Tests whether a plane along a triangle, or along one of its edges and across it, surely separates the triangles. It
/// spares nearly all coplanar neighbors the exact predicates, which take longest there.
fn a_plane_parts(t: [Point; 3], u: [Point; 3]) -> bool {
    let edges = [sub(t[1], t[0]), sub(t[2], t[1]), sub(t[0], t[2])];
    let plane = cross(edges[0], edges[1]);
    // Any direction may separate, however it was rounded.
    let parts = |normal: Point| {
        let span = |p: [Point; 3]| {
            let mut span = [f64::INFINITY, f64::NEG_INFINITY];
            for to in p.map(|p| sub(p, t[0])) {
                let products: [f64; 3] = std::array::from_fn(|i| normal[i] * to[i]);
                let height = products[0] + products[1] + products[2];
                let slack = ROUNDING * (products[0].abs() + products[1].abs() + products[2].abs());
                span = [span[0].min(height - slack), span[1].max(height + slack)];
            }
            span
        };
        let ([low, high], [bottom, top]) = (span(t), span(u));
        high < bottom || top < low
    };
    parts(plane) || edges.iter().any(|&edge| parts(cross(edge, plane)))
}

/// Triangles (a, b, c) and (a, d, e): the edges opposite to a decide whether more than a is common.
fn at_a_vertex(points: &[Point], one: Corners, other: Corners) -> Meeting {
    let first = |own: Corners, foreign: Corners| {
        let place = own.iter().position(|corner| foreign.contains(corner));
        let place = place.expect("a vertex is shared");
        at(points, std::array::from_fn(|i| own[(place + i) % 3]))
    };
    let (t, u) = (first(one, other), first(other, one));
    if parted(t, u) {
        return Meeting::Apart;
    }
    let behind = u.map(|p| side(t[0], t[1], t[2], p));
    let before = t.map(|p| side(u[0], u[1], u[2], p));
    // The first signs are zero: the shared vertex.
    if behind[1] * behind[2] > 0.0 || before[1] * before[2] > 0.0 {
        return Meeting::Apart;
    }
    if crosses(t, u, before, behind) {
        Meeting::Cross
    } else if reaches([u[1], u[2]], t) || reaches([t[1], t[2]], u) {
        Meeting::Touch
    } else {
        Meeting::Apart
    }
}

/// Tests whether a plane through the common first corner surely separates the triangles: the plane across the
/// difference of their bisectors. It separates nearly all neighbors on a smooth surface.
fn parted([a, b, c]: [Point; 3], [_, d, e]: [Point; 3]) -> bool {
    let [b, c, d, e] = [b, c, d, e].map(|corner| sub(corner, a));
    let across = |b: Point, c: Point, d: Point, e: Point| -> Point {
        std::array::from_fn(|i| (b[i] + c[i]) - (d[i] + e[i]))
    };
    let tells = |normal: Point| {
        let surely = |v: Point, sign: f64| {
            let products: [f64; 3] = std::array::from_fn(|i| normal[i] * v[i]);
            let size = products[0].abs() + products[1].abs() + products[2].abs();
            sign * (products[0] + products[1] + products[2]) > ROUNDING * size
        };
        surely(b, 1.0) & surely(c, 1.0) & surely(d, -1.0) & surely(e, -1.0)
    };
    let unit = |v: Point| {
        let length = dot(v, v).sqrt();
        v.map(|x| x / length)
    };
    tells(across(b, c, d, e)) || tells(across(unit(b), unit(c), unit(d), unit(e)))
}

/// Triangles (a, b, c) and (a, b, d): they have more than their edge in common only if one is folded onto the other.
fn along_an_edge(points: &[Point], one: Corners, other: Corners) -> Meeting {
    let apex = |own: Corners, foreign: Corners| {
        let place = own.iter().position(|corner| !foreign.contains(corner));
        place.expect("one vertex is not shared")
    };
    let place = apex(one, other);
    let [c, a, b] = at(points, std::array::from_fn(|i| one[(place + i) % 3]));
    let d = points[other[apex(other, one)] as usize];
    if opposite([a, b], c, d) || side(a, b, c, d) != 0.0 {
        return Meeting::Apart;
    }
    let folded = projections([a, b, c]).find(|flat| area(flat(a), flat(b), flat(c)) != 0.0);
    match folded {
        Some(flat) if area(flat(a), flat(b), flat(c)) * area(flat(a), flat(b), flat(d)) > 0.0 => {
            Meeting::Touch
        }
        _ => Meeting::Apart,
    }
}

/// Tests whether two points surely lie on opposite sides of an edge, seen along it.
fn opposite([a, b]: [Point; 2], c: Point, d: Point) -> bool {
    let (edge, to_c, to_d) = (sub(b, a), sub(c, a), sub(d, a));
    let (square, along_c, along_d) = (dot(edge, edge), dot(to_c, edge), dot(to_d, edge));
    let size = square * (dot(to_c, to_c) * dot(to_d, to_d)).sqrt() + (along_c * along_d).abs();
    square * dot(to_c, to_d) - along_c * along_d < -ROUNDING * size
}

/// Tests whether the open triangles cross, from the sides of each other's plane on which their vertices lie (Guigue and
/// Devillers 2003, doi 10.1080/10867651.2003.10487580, with open sets in place of closed ones).
fn crosses(t: [Point; 3], u: [Point; 3], before: [f64; 3], behind: [f64; 3]) -> bool {
    let (Some((t_alone, t_up)), Some((u_alone, u_up))) = (alone(before), alone(behind)) else {
        return false;
    };
    let turned = |p: [Point; 3], from: usize, flip: bool| {
        let [a, b, c] = std::array::from_fn(|i| p[(from + i) % 3]);
        if flip { [a, c, b] } else { [a, b, c] }
    };
    // Turning over the other triangle puts the lone vertex of each on the positive side of the other's plane.
    let [p1, q1, r1] = turned(t, t_alone, !u_up);
    let [p2, q2, r2] = turned(u, u_alone, !t_up);
    side(p1, q1, p2, q2) < 0.0 && side(p1, r1, r2, p2) < 0.0
}

/// Vertex strictly on its side of a plane while the others are on it or beyond, and true if that side is the positive
/// one; `None` if the plane does not cut the open triangle.
fn alone(sides: [f64; 3]) -> Option<(usize, bool)> {
    let count = |sign: f64| sides.iter().filter(|&&s| s * sign > 0.0).count();
    let (above, below) = (count(1.0), count(-1.0));
    if above == 0 || below == 0 {
        return None;
    }
    let up = above == 1;
    let sign = if up { 1.0 } else { -1.0 };
    let place = sides.iter().position(|&s| s * sign > 0.0)?;
    Some((place, up))
}

fn one_sided(sides: [f64; 3]) -> bool {
    sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0)
}

/// Tests whether a closed segment and a closed triangle share a point. A degenerate triangle shares none: anything that
/// touches it touches its neighbors.
pub(crate) fn reaches([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let (above, below) = (side(a, b, c, p), side(a, b, c, q));
    if above * below > 0.0 {
        return false;
    }
    if above == 0.0 && below == 0.0 {
        return reaches_in_plane([p, q], [a, b, c]);
    }
    let turns = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

/// Tests whether a point lies on a closed triangle; none lies on a degenerate one.
pub(crate) fn holds(triangle: [Point; 3], point: Point) -> bool {
    let [a, b, c] = triangle;
    side(a, b, c, point) == 0.0 && reaches_in_plane([point, point], triangle)
}

fn reaches_in_plane([p, q]: [Point; 2], triangle: [Point; 3]) -> bool {
    let [a, b, c] = triangle;
    let Some(flat) = projections(triangle).find(|flat| area(flat(a), flat(b), flat(c)) != 0.0)
    else {
        return false;
    };
    let (p, q, [a, b, c]) = (flat(p), flat(q), triangle.map(flat));
    let sense = area(a, b, c);
    let holds = |point| {
        [[a, b], [b, c], [c, a]]
            .into_iter()
            .all(|[from, to]| area(from, to, point) * sense >= 0.0)
    };
    let cut = |[from, to]: [[f64; 2]; 2]| {
        area(from, to, p) * area(from, to, q) < 0.0 && area(p, q, from) * area(p, q, to) <= 0.0
    };
    holds(p) || holds(q) || [[a, b], [b, c], [c, a]].into_iter().any(cut)
}

/// Projections of a triangle along an axis, the one with the largest area first.
fn projections([a, b, c]: [Point; 3]) -> impl Iterator<Item = impl Fn(Point) -> [f64; 2]> {
    let normal = cross(sub(b, a), sub(c, a)).map(f64::abs);
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| normal[j].total_cmp(&normal[i]));
    axes.into_iter()
        .map(|axis| move |p: Point| [p[(axis + 1) % 3], p[(axis + 2) % 3]])
}

fn at(points: &[Point], corners: Corners) -> [Point; 3] {
    corners.map(|corner| points[corner as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn meet(points: &[Point], one: Corners, other: Corners) -> Meeting {
        let found = meeting(points, one, other);
        assert_eq!(found, meeting(points, other, one), "order of the triangles");
        let turned = |[a, b, c]: Corners| [b, c, a];
        assert_eq!(found, meeting(points, turned(one), other), "first corner");
        let flipped = |[a, b, c]: Corners| [a, c, b];
        assert_eq!(found, meeting(points, one, flipped(other)), "orientation");
        found
    }

    const FLAT: [Point; 3] = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn with(more: &[Point]) -> Vec<Point> {
        FLAT.iter().chain(more).copied().collect()
    }

    #[test]
    fn a_triangle_through_another_crosses_it() {
        let points = with(&[[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]]);
        assert_eq!(meet(&points, [0, 1, 2], [3, 4, 5]), Meeting::Cross);
    }

    #[test]
    fn a_vertex_on_a_triangle_touches_it() {
        let above = |z| with(&[[1.0, 1.0, z], [1.0, 1.0, 2.0], [2.0, 1.0, 2.0]]);
        assert_eq!(meet(&above(0.0), [0, 1, 2], [3, 4, 5]), Meeting::Touch);
        assert_eq!(meet(&above(1e-300), [0, 1, 2], [3, 4, 5]), Meeting::Apart);
        assert_eq!(meet(&above(-1e-300), [0, 1, 2], [3, 4, 5]), Meeting::Cross);
    }

    #[test]
    fn triangles_in_one_plane_touch() {
        let beside = |x| with(&[[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]]);
        assert_eq!(meet(&beside(1.0), [0, 1, 2], [3, 4, 5]), Meeting::Touch);
        assert_eq!(meet(&beside(4.0), [0, 1, 2], [3, 4, 5]), Meeting::Touch);
        assert_eq!(meet(&beside(4.5), [0, 1, 2], [3, 4, 5]), Meeting::Apart);
    }

    #[test]
    fn neighbors_at_a_vertex() {
        let from_corner = |d, e| meet(&with(&[d, e]), [0, 1, 2], [0, 3, 4]);
        assert_eq!(
            from_corner([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
            Meeting::Apart
        );
        assert_eq!(
            from_corner([1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]),
            Meeting::Apart
        );
        assert_eq!(
            from_corner([1.0, 1.0, 1.0], [1.0, 1.0, -1.0]),
            Meeting::Cross
        );
        assert_eq!(
            from_corner([1.0, 1.0, 0.0], [1.0, 1.0, -1.0]),
            Meeting::Touch
        );
        assert_eq!(
            from_corner([1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
            Meeting::Touch
        );
    }

    #[test]
    fn neighbors_along_an_edge_meet_if_folded_flat() {
        let folded = |d: Point| meet(&with(&[d]), [0, 1, 2], [1, 0, 3]);
        assert_eq!(folded([1.0, -1.0, 0.0]), Meeting::Apart);
        assert_eq!(folded([1.0, 1.0, 0.1]), Meeting::Apart);
        assert_eq!(folded([1.0, 1.0, 1e-300]), Meeting::Apart);
        assert_eq!(folded([1.0, 1.0, 0.0]), Meeting::Touch);
    }

    #[test]
    fn a_triangle_without_area_crosses_nothing() {
        let points = with(&[[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0]]);
        assert_ne!(meet(&points, [0, 1, 2], [3, 4, 5]), Meeting::Cross);
    }

    /// Reference in integer arithmetic: tests whether the open triangles cross. Fourier's elimination of the four
    /// weights would do; here the segment in which the planes meet is cut with both, in fractions of a common
    /// denominator.
    fn counted(t: [[i64; 3]; 3], u: [[i64; 3]; 3]) -> bool {
        let minus = |a: [i64; 3], b: [i64; 3]| -> [i64; 3] { std::array::from_fn(|i| a[i] - b[i]) };
        let times = |a: [i64; 3], b: [i64; 3]| -> [i64; 3] {
            std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                a[j] * b[k] - a[k] * b[j]
            })
        };
        let inner = |a: [i64; 3], b: [i64; 3]| -> i64 { (0..3).map(|i| a[i] * b[i]).sum() };
        let normal = |t: [[i64; 3]; 3]| times(minus(t[1], t[0]), minus(t[2], t[0]));
        let (m, n) = (normal(t), normal(u));
        let line = times(m, n);
        if line == [0; 3] {
            return false;
        }
        // Parameters along the line where a triangle's edges meet the other's plane, as fractions (above, below).
        let cut =
            |t: [[i64; 3]; 3], normal: [i64; 3], from: [i64; 3]| -> Option<[(i128, i128); 2]> {
                let heights = t.map(|p| inner(normal, minus(p, from)));
                if heights.iter().all(|&h| h >= 0) || heights.iter().all(|&h| h <= 0) {
                    return None;
                }
                let mut found: Vec<(i128, i128)> = Vec::new();
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let (a, b) = (heights[i] as i128, heights[j] as i128);
                    if a * b < 0 {
                        let (x, y) = (inner(line, t[i]) as i128, inner(line, t[j]) as i128);
                        let sign = (a - b).signum();
                        found.push((sign * (x * (a - b) + (y - x) * a), sign * (a - b)));
                    }
                }
                for i in 0..3 {
                    if heights[i] == 0 {
                        found.push((inner(line, t[i]) as i128, 1));
                    }
                }
                let less = |p: (i128, i128), q: (i128, i128)| p.0 * q.1 < q.0 * p.1;
                assert_eq!(found.len(), 2);
                Some(if less(found[0], found[1]) {
                    [found[0], found[1]]
                } else {
                    [found[1], found[0]]
                })
            };
        let (Some([a, b]), Some([c, d])) = (cut(t, n, u[0]), cut(u, m, t[0])) else {
            return false;
        };
        let less = |p: (i128, i128), q: (i128, i128)| p.0 * q.1 < q.0 * p.1;
        less(a, d) && less(c, b)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn agrees_with_whole_numbers(grid in prop::array::uniform6(prop::array::uniform3(-3..4_i64)), link in 0..3_usize) {
            let points: Vec<Point> = grid.iter().map(|p| p.map(|x| x as f64)).collect();
            let other: Corners = match link { 0 => [3, 4, 5], 1 => [0, 4, 5], _ => [1, 0, 5] };
            let corners = |t: Corners| t.map(|c| grid[c as usize]);
            let expected = counted(corners([0, 1, 2]), corners(other));
            prop_assert_eq!(meet(&points, [0, 1, 2], other) == Meeting::Cross, expected);
        }
    }
}
