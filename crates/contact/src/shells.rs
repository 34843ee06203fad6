//! Connected shells of a surface, and the number of them that enclose a point.
use crate::bounds::Bounds;
use crate::predicates::{Point, area, side};
use crate::tree::Tree;
use crate::triangles::holds;
use crate::union::Sets;
use crate::vectors::{cross, dot, sub};

/// Triangles connected at vertices, with the enclosed volume (m³), negative around a cavity.
pub(crate) struct Shell {
    pub(crate) triangles: Vec<u32>,
    pub(crate) volume: f64,
}

/// Shells of a closed surface, in the order of their first triangles.
pub(crate) fn shells(points: &[Point], triangles: &[[i32; 3]]) -> (Vec<Shell>, Vec<u32>) {
    let mut sets = Sets::new(points.len());
    for &[a, b, c] in triangles {
        sets.join(a as usize, b as usize);
        sets.join(a as usize, c as usize);
    }
    let mut number = vec![u32::MAX; points.len()];
    let mut shells: Vec<Shell> = Vec::new();
    let mut of_triangle = Vec::with_capacity(triangles.len());
    for (t, &corners) in triangles.iter().enumerate() {
        let root = sets.find(corners[0] as usize);
        if number[root] == u32::MAX {
            number[root] = shells.len() as u32;
            shells.push(Shell {
                triangles: Vec::new(),
                volume: 0.0,
            });
        }
        let shell = &mut shells[number[root] as usize];
        // Relative to a point of the shell, so that a small one far away loses nothing to rounding.
        let origin = shell
            .triangles
            .first()
            .map_or(corners[0], |&first| triangles[first as usize][0]);
        let [a, b, c] = corners.map(|v| sub(points[v as usize], points[origin as usize]));
        shell.volume += dot(a, cross(b, c)) / 6.0;
        shell.triangles.push(t as u32);
        of_triangle.push(number[root]);
    }
    (shells, of_triangle)
}

/// Number of shells other than `own` that enclose a point: the sum of the crossings of a ray, +1 where it leaves and -1
/// where it enters. `None` for a point on one of them.
///
/// The ray runs along x from a point shifted infinitesimally along y, and by a smaller order along z, so that it meets
/// no edge.
pub(crate) fn covering(
    points: &[Point],
    triangles: &[[i32; 3]],
    tree: &Tree,
    point: Point,
    is_own: impl Fn(u32) -> bool,
) -> Option<i64> {
    let counts = |t: u32| (t as usize) < triangles.len() && !is_own(t);
    let at = |t: u32| triangles[t as usize].map(|v| points[v as usize]);
    let mut lies_on_one = false;
    tree.around(point, |t| {
        lies_on_one |= counts(t) && holds(at(t), point);
    });
    if lies_on_one {
        return None;
    }
    let mut count = 0;
    tree.ahead_of(point, |t| {
        if !counts(t) {
            return;
        }
        let [a, b, c] = at(t);
        let turns = [turn(a, b, point), turn(b, c, point), turn(c, a, point)];
        let one_turn = turns[0] == turns[1] && turns[1] == turns[2];
        // Seen along x, a triangle that turns left has its front away from the origin of the ray.
        if one_turn && side(a, b, c, point) * turns[0] < 0.0 {
            count += turns[0] as i64;
        }
    });
    Some(count)
}

/// Side of the edge from `a` to `b`, seen along x, on which the shifted point lies: 1 for left, -1 for right.
fn turn(a: Point, b: Point, point: Point) -> f64 {
    let flat = |p: Point| [p[1], p[2]];
    let exact = area(flat(a), flat(b), flat(point));
    // Terms added by the infinitesimal shift along y, and by the smaller one along z.
    [exact, -(b[2] - a[2]), b[1] - a[1]]
        .into_iter()
        .find(|&term| term != 0.0)
        .map_or(1.0, f64::signum)
}

/// Bounding boxes of triangles.
pub(crate) fn bounds_of(points: &[Point], triangles: &[[i32; 3]]) -> Vec<Bounds> {
    triangles
        .iter()
        .map(|corners| Bounds::of(corners.map(|v| points[v as usize])))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cube [0, 2]³ with corners numbered by their bits.
    fn cube() -> (Vec<Point>, Vec<[i32; 3]>) {
        let points = (0..8)
            .map(|n| [2.0 * (n & 1) as f64, (n & 2) as f64, (n >> 1 & 2) as f64])
            .collect();
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let triangles = faces
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect();
        (points, triangles)
    }

    #[test]
    fn a_cube_covers_its_inside_once() {
        let (points, triangles) = cube();
        let tree = Tree::new(&bounds_of(&points, &triangles));
        let count = |point| covering(&points, &triangles, &tree, point, |_| false);
        // Rays that meet edges, diagonals and corners exactly.
        for x in [0.5, 1.0] {
            for y in [0.0, 0.5, 1.0, 2.0] {
                for z in [0.0, 0.5, 1.0, 2.0] {
                    let inside = [0.5, 1.0].contains(&y) && [0.5, 1.0].contains(&z);
                    assert_eq!(count([x, y, z]), inside.then_some(1), "{x} {y} {z}");
                }
            }
        }
        assert_eq!(count([-1.0, 1.0, 1.0]), Some(0));
        assert_eq!(count([3.0, 1.0, 1.0]), Some(0));
        assert_eq!(count([2.0, 1.0, 1.5]), None);
        assert_eq!(
            covering(&points, &triangles, &tree, [1.0; 3], |_| true),
            Some(0)
        );
    }

    #[test]
    fn shells_have_the_volume_they_enclose() {
        let (mut points, mut triangles) = cube();
        let inner: Vec<Point> = points.iter().map(|p| p.map(|x| 0.5 + 0.25 * x)).collect();
        points.extend(inner);
        let turned: Vec<[i32; 3]> = triangles
            .iter()
            .map(|&[a, b, c]| [a + 8, c + 8, b + 8])
            .collect();
        triangles.extend(turned);
        let (found, of_triangle) = shells(&points, &triangles);
        for (shell, volume) in found.iter().zip([8.0, -0.125]) {
            assert!((shell.volume - volume).abs() < 1e-12);
        }
        assert_eq!(of_triangle, [vec![0; 12], vec![1; 12]].concat());
    }
}
