//! Quality checks of a mesh.
use crate::tet_mesh::TetMesh;
use crate::topology::{outward_face, sorted_faces, sorted_triangle_edges};
use crate::vectors::{tet_volume, triangle_area};

/// Quality figures of a mesh, counted from its tets and triangles alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// Sum of the volumes of the tets (m³).
    pub volume: f64,
    /// Smallest volume of a tet (m³); positive in a sound mesh.
    pub smallest_tet: f64,
    /// Largest volume of a tet (m³).
    pub largest_tet: f64,
    /// Area of the boundary (m²).
    pub area: f64,
    /// Euler number V − E + F − T; 1 for a ball, 0 for a solid ring, 2 for a ball with a cavity.
    pub euler_number: i64,
    /// True if the listed triangles are exactly the faces of one tet, outward, and every other face belongs to two
    /// tets.
    pub conforming: bool,
    /// Number of boundary edges without a triangle on both sides: holes, 0 in a sound mesh.
    pub open_edges: usize,
    /// Edges where four or more boundary triangles meet: bodies that touch along them (hinges).
    pub nonmanifold_edges: Vec<[i32; 2]>,
}

/// Checks a mesh; takes a few times the time of making it.
///
/// # Panics
///
/// If a tet or triangle names a vertex that does not exist.
pub fn quality(mesh: &TetMesh) -> Quality {
    let point = |v: i32| mesh.vertices[v as usize];
    let volumes = || mesh.tets.iter().map(|tet| tet_volume(tet.map(point)));
    let (faces, conforming) = count_faces(mesh);
    let (open_edges, nonmanifold_edges) = check_boundary_edges(&mesh.triangles);
    let counts = [
        mesh.vertices.len(),
        mesh.edges.len(),
        faces,
        mesh.tets.len(),
    ]
    .map(|n| n as i64);
    Quality {
        volume: volumes().sum(),
        smallest_tet: volumes().fold(f64::INFINITY, f64::min),
        largest_tet: volumes().fold(f64::NEG_INFINITY, f64::max),
        area: mesh
            .triangles
            .iter()
            .map(|t| triangle_area(t.map(point)))
            .sum(),
        euler_number: counts[0] - counts[1] + counts[2] - counts[3],
        conforming,
        open_edges,
        nonmanifold_edges,
    }
}

/// Number of distinct faces, and the conformity of the mesh.
fn count_faces(mesh: &TetMesh) -> (usize, bool) {
    let faces = sorted_faces(&mesh.tets);
    let (mut different, mut shared_by_two, mut single) = (0, true, Vec::new());
    for same in faces.chunk_by(|(a, _), (b, _)| a == b) {
        different += 1;
        shared_by_two &= same.len() <= 2;
        if let [(_, from)] = same {
            single.push(lowest_first(outward_face(&mesh.tets, *from)));
        }
    }
    let mut listed: Vec<[i32; 3]> = mesh.triangles.iter().map(|&t| lowest_first(t)).collect();
    single.sort_unstable();
    listed.sort_unstable();
    (different, shared_by_two && single == listed)
}

/// Rotates a triangle so that its lowest vertex comes first; keeps its orientation.
fn lowest_first([a, b, c]: [i32; 3]) -> [i32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Number of open boundary edges, which have unequal numbers of triangles in each direction, and the non-manifold
/// edges.
fn check_boundary_edges(triangles: &[[i32; 3]]) -> (usize, Vec<[i32; 2]>) {
    let edges = sorted_triangle_edges(triangles);
    let (mut open, mut nonmanifold) = (0, Vec::new());
    for around in edges.chunk_by(|(a, _), (b, _)| a == b) {
        let [low, high] = around[0].0;
        let runs_with = |&&(_, t): &&([i32; 2], u32)| {
            let corners = triangles[t as usize];
            (0..3).any(|c| corners[c] == low && corners[(c + 1) % 3] == high)
        };
        if around.iter().filter(runs_with).count() * 2 != around.len() {
            open += 1;
        } else if around.len() > 2 {
            nonmanifold.push([low, high]);
        }
    }
    (open, nonmanifold)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Grid, tet_mesh};

    fn mesh(shape: [usize; 3], empty: &[[usize; 3]]) -> TetMesh {
        let mut grid = Grid::empty(shape, [0.0; 3], 0.5, u64::MAX).unwrap();
        grid.fill_box([0.0; 3], [9.0; 3], 1);
        for &cell in empty {
            grid.set(cell, 0);
        }
        tet_mesh(&grid, u64::MAX).unwrap()
    }

    #[test]
    fn quality_of_block_ring_and_hollow_block() {
        let block = quality(&mesh([2, 3, 4], &[]));
        assert!((block.volume - 3.0).abs() < 1e-12 && (block.area - 13.0).abs() < 1e-12);
        assert!((block.smallest_tet * 6.0 - 0.125).abs() < 1e-15);
        assert!((block.largest_tet * 3.0 - 0.125).abs() < 1e-15);
        assert_eq!(
            (block.euler_number, block.conforming, block.open_edges),
            (1, true, 0)
        );
        assert_eq!(quality(&mesh([3, 3, 1], &[[1, 1, 0]])).euler_number, 0);
        assert_eq!(quality(&mesh([3, 3, 3], &[[1, 1, 1]])).euler_number, 2);
    }

    #[test]
    fn cells_that_touch_along_an_edge_make_it_nonmanifold() {
        let hinge = quality(&mesh([2, 2, 1], &[[0, 0, 0], [1, 1, 0]]));
        assert_eq!((hinge.nonmanifold_edges.len(), hinge.open_edges), (1, 0));
        assert!(hinge.conforming);
    }

    #[test]
    fn damage_is_detected() {
        let mut hole = mesh([2, 2, 2], &[]);
        hole.triangles.pop();
        assert_eq!(
            (quality(&hole).open_edges, quality(&hole).conforming),
            (3, false)
        );
        let mut flipped = mesh([2, 2, 2], &[]);
        flipped.triangles[0].swap(0, 1);
        assert_eq!(
            (quality(&flipped).open_edges, quality(&flipped).conforming),
            (3, false)
        );
        let mut doubled = mesh([2, 2, 2], &[]);
        let last = doubled.tets[39];
        doubled.tets.push(last);
        assert!(!quality(&doubled).conforming);
    }
}
