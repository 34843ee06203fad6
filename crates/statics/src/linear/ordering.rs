//! The order of elimination: nested dissection by position.
//!
//! A body is cut in half across its longest side; the vertices of one half that touch the other are the
//! separator and come last, after both halves, which are cut again. On voxels this is close to the
//! best known fill, `O(n^{4/3})` entries in three dimensions (George 1973, doi 10.1137/0710032).

use voxsoft_solid::vector::Vec3;

/// Number of vertices below which a part is not cut any more: its fill is small in any order.
const SMALL: usize = 24;

/// Vertices in the order of elimination; `neighbors[v]` lists those that share an element with `v`.
///
/// Vertices that `is_last` marks come last of all. Some couple large regions, such as the four that carry a rigid
/// object, which couple everything that it touches: anywhere else they would enlarge the separators.
pub(crate) fn nested_dissection(
    points: &[Vec3],
    neighbors: &[Vec<u32>],
    is_last: &[bool],
) -> Vec<u32> {
    let all = 0..points.len() as u32;
    let (last, others): (Vec<u32>, Vec<u32>) = all.partition(|v| is_last[*v as usize]);
    let mut order = Vec::with_capacity(points.len());
    let mut side = vec![0u32; points.len()];
    let mut cuts = 0;
    dissect(others, points, neighbors, &mut side, &mut cuts, &mut order);
    order.extend(last);
    order
}

fn dissect(
    mut part: Vec<u32>,
    points: &[Vec3],
    neighbors: &[Vec<u32>],
    side: &mut [u32],
    cuts: &mut u32,
    order: &mut Vec<u32>,
) {
    if part.len() <= SMALL {
        order.extend(part);
        return;
    }
    let axis = longest_axis(&part, points);
    let at = |v: u32| points[v as usize][axis];
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
    let far = part.split_off(middle);
    // Every cut marks its far half with a number of its own, so that nothing has to be reset.
    *cuts += 1;
    let mark = *cuts;
    for &v in &far {
        side[v as usize] = mark;
    }
    let touches = |v: u32| {
        neighbors[v as usize]
            .iter()
            .any(|&n| side[n as usize] == mark)
    };
    let (separator, near): (Vec<u32>, Vec<u32>) = part.into_iter().partition(|&v| touches(v));
    if near.is_empty() {
        order.extend(far);
        order.extend(separator);
        return;
    }
    dissect(near, points, neighbors, side, cuts, order);
    dissect(far, points, neighbors, side, cuts, order);
    order.extend(separator);
}

fn longest_axis(part: &[u32], points: &[Vec3]) -> usize {
    let span = |axis: usize| {
        let values = || part.iter().map(|&v| points[v as usize][axis]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let spans = [span(0), span(1), span(2)];
    (0..3)
        .max_by(|&a, &b| spans[a].total_cmp(&spans[b]))
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_every_vertex_once() {
        let n = 7i32;
        let mut points = Vec::new();
        let mut neighbors = Vec::new();
        for i in 0..n * n * n {
            let cell = [i / (n * n), i / n % n, i % n];
            points.push(cell.map(f64::from));
            let mut list = Vec::new();
            for other in 0..n * n * n {
                let cell_of = [other / (n * n), other / n % n, other % n];
                if (0..3).all(|k| (cell[k] - cell_of[k]).abs() <= 1) {
                    list.push(other as u32);
                }
            }
            neighbors.push(list);
        }
        let mut is_last = vec![false; points.len()];
        is_last[17] = true;
        let mut order = nested_dissection(&points, &neighbors, &is_last);
        assert_eq!(order.last(), Some(&17));
        order.sort_unstable();
        assert!(order.iter().enumerate().all(|(i, &v)| i as u32 == v));
        assert_eq!(order.len(), points.len());
    }

    #[test]
    fn survives_vertices_on_one_spot() {
        let neighbors = vec![(0..100u32).collect::<Vec<_>>(); 100];
        let order = nested_dissection(&[[0.0; 3]; 100], &neighbors, &[false; 100]);
        assert_eq!(order.len(), 100);
    }
}
