//! Mesh before stitching, each voxel with vertices of its own.
use crate::five_tets::{face_triangles, is_even, tets};
use crate::grid::Grid;

/// Arrays of N voxels without shared vertices: 8 N vertices, 5 N tets, 18 N edges, 16 N triangles.
///
/// A voxel's triangles are the 12 on its surface and the 4 between the middle tetrahedron and the
/// others.
#[derive(Debug, Clone, PartialEq)]
pub struct Unstitched {
    /// Positions (m), eight per voxel.
    pub vertices: Vec<[f64; 3]>,
    /// Vertex indices, five per voxel, with positive volume.
    pub tets: Vec<[i32; 4]>,
    /// Vertex indices, 18 per voxel.
    pub edges: Vec<[i32; 2]>,
    /// Vertex indices, 16 per voxel.
    pub triangles: Vec<[i32; 3]>,
}

/// Makes the mesh before stitching, voxels in C order. For study and tests only; see [`crate::tet_mesh()`].
///
/// # Panics
///
/// If the grid has more than 2^28 filled cells, whose vertices 32-bit indices cannot name.
pub fn unstitched(grid: &Grid) -> Unstitched {
    assert!(
        grid.count() <= 1 << 28,
        "too many voxels for 32-bit indices"
    );
    let mut arrays = Unstitched {
        vertices: vec![],
        tets: vec![],
        edges: vec![],
        triangles: vec![],
    };
    let [_, ny, nz] = grid.shape();
    let offset = grid.lattice_offset();
    for (index, _) in grid
        .cells()
        .iter()
        .enumerate()
        .filter(|&(_, &part)| part != 0)
    {
        let cell = [index / (ny * nz), index / nz % ny, index % nz];
        arrays.push_voxel(grid, std::array::from_fn(|a| offset[a] + cell[a] as i32));
    }
    arrays
}

impl Unstitched {
    fn push_voxel(&mut self, grid: &Grid, cell: [i32; 3]) {
        let first = self.vertices.len() as i32;
        let even = is_even(cell);
        for corner in 0..8 {
            let step = [corner >> 2 & 1, corner >> 1 & 1, corner & 1];
            self.vertices
                .push(grid.node_position(std::array::from_fn(|a| cell[a] + step[a])));
        }
        let name = |corner: usize| first + corner as i32;
        self.tets.extend(tets(even).map(|tet| tet.map(name)));

        let is_axis = |a: usize, b: usize| (a ^ b).count_ones() == 1;
        let middle = &tets(even)[0];
        for a in 0..8 {
            for b in a + 1..8 {
                if is_axis(a, b) || (middle.contains(&a) && middle.contains(&b)) {
                    self.edges.push([name(a), name(b)]);
                }
            }
        }

        for face in 0..6 {
            self.triangles
                .extend(face_triangles(even, face).map(|t| t.map(name)));
        }
        let [a, b, c, d] = *middle;
        self.triangles
            .extend([[a, c, b], [a, b, d], [a, d, c], [b, c, d]].map(|t| t.map(name)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_match_the_paper() {
        for (filled, cells) in [
            (0, vec![0; 8]),
            (1, vec![0, 0, 0, 0, 0, 3, 0, 0]),
            (8, vec![1; 8]),
        ] {
            let grid = Grid::from_cells([2; 3], [0.0; 3], 0.1, cells).unwrap();
            let arrays = unstitched(&grid);
            let lengths = [
                arrays.vertices.len(),
                arrays.tets.len(),
                arrays.edges.len(),
                arrays.triangles.len(),
            ];
            assert_eq!(lengths, [8, 5, 18, 16].map(|n| n * filled));
        }
    }

    #[test]
    fn every_edge_and_triangle_belongs_to_a_tet() {
        let grid = Grid::from_cells([2, 1, 1], [0.0; 3], 1.0, vec![1; 2]).unwrap();
        let arrays = unstitched(&grid);
        let held = |corners: &[i32]| {
            arrays
                .tets
                .iter()
                .filter(|tet| corners.iter().all(|c| tet.contains(c)))
                .count()
        };
        assert!(arrays.edges.iter().all(|edge| held(edge) >= 1));
        assert!(arrays.triangles.chunks_exact(16).all(|voxel| {
            voxel[..12].iter().all(|t| held(t) == 1) && voxel[12..].iter().all(|t| held(t) == 2)
        }));
    }
}
