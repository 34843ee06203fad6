//! Closed shells of a boundary.
use crate::topology::sorted_triangle_edges;
use crate::vectors::{cross, dot, norm, sub};

/// Splits outward boundary triangles into closed shells.
///
/// Triangles that share an edge belong together. Where more than two meet at an edge (bodies that
/// touch along it), the two that face the same wedge of empty space belong together, so that
/// cavities that touch along an edge stay apart. Shells come in the order of their first triangle.
pub(crate) fn closed_shells(vertices: &[[f64; 3]], triangles: &[[i32; 3]]) -> Vec<Vec<[i32; 3]>> {
    let mut parent: Vec<u32> = (0..triangles.len() as u32).collect();
    let edges = sorted_triangle_edges(triangles);
    for around in edges.chunk_by(|(a, _), (b, _)| a == b) {
        match around {
            [(_, a), (_, b)] => unite(&mut parent, *a, *b),
            _ => {
                for (a, b) in wedges(vertices, triangles, around) {
                    unite(&mut parent, a, b);
                }
            }
        }
    }
    let mut place = vec![usize::MAX; triangles.len()];
    let mut shells: Vec<Vec<[i32; 3]>> = Vec::new();
    for (t, &triangle) in triangles.iter().enumerate() {
        let root = find(&mut parent, t as u32) as usize;
        if place[root] == usize::MAX {
            place[root] = shells.len();
            shells.push(Vec::new());
        }
        shells[place[root]].push(triangle);
    }
    shells
}

/// Pairs of triangles around an edge that have an empty wedge between them.
///
/// The outward normal of a triangle (low, high, third) is axis × radius, the direction of growing
/// angle: a triangle that runs with the edge has the empty side after it, one that runs against it
/// before it. So going round by angle, a "with" is followed by the "against" beyond the wedge.
fn wedges(
    vertices: &[[f64; 3]],
    triangles: &[[i32; 3]],
    around: &[([i32; 2], u32)],
) -> Vec<(u32, u32)> {
    let [low, high] = around[0].0;
    let origin = vertices[low as usize];
    let along = sub(vertices[high as usize], origin);
    let axis = along.map(|x| x / norm(along));
    let third = |t: u32| {
        let corner = triangles[t as usize]
            .into_iter()
            .find(|&v| v != low && v != high);
        sub(vertices[corner.unwrap_or(low) as usize], origin)
    };
    let zero = third(around[0].1);
    let quarter = cross(axis, zero);
    let mut by_angle: Vec<(f64, bool, u32)> = around
        .iter()
        .map(|&(_, t)| {
            let toward = third(t);
            let radial: f64 = dot(toward, zero) - dot(toward, axis) * dot(zero, axis);
            let angle = f64::atan2(dot(toward, quarter), radial);
            let corners = triangles[t as usize];
            let runs_with = (0..3).any(|c| corners[c] == low && corners[(c + 1) % 3] == high);
            (angle, runs_with, t)
        })
        .collect();
    by_angle.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    let next = by_angle.iter().cycle().skip(1);
    by_angle
        .iter()
        .zip(next)
        .filter(|((_, with, _), (_, next_with, _))| *with && !next_with)
        .map(|(&(_, _, a), &(_, _, b))| (a, b))
        .collect()
}

fn find(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        parent[node as usize] = parent[parent[node as usize] as usize];
        node = parent[node as usize];
    }
    node
}

fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}
