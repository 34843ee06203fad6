//! From cells to one conforming mesh: voxels share the vertices, edges and faces they meet at.
//!
//! Vertices are found by lattice node, never by position, in a time linear in the cells.
use thiserror::Error;

use crate::bits::{BitGrid, ones};
use crate::cavities::LabeledCavities;
use crate::five_tets::{face_triangles, is_even, tets};
use crate::grid::Grid;
use crate::nodes::NodeIndex;
use crate::planes::by_plane;
use crate::tet_mesh::{CavitySurface, TetMesh};

/// Why a grid cannot be meshed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StitchError {
    /// No cell is filled.
    #[error("the grid has no filled cell, so there is nothing to mesh")]
    Empty,
    /// The mesh does not fit the memory limit; said before it is allocated.
    #[error("a mesh of {voxels} voxels needs about {bytes} bytes, the limit is {limit}")]
    TooLarge {
        /// Number of filled cells.
        voxels: u64,
        /// Estimate of the peak while meshing.
        bytes: u64,
        /// The limit that was given.
        limit: u64,
    },
    /// More vertices or tetrahedra than 32-bit indices can name.
    #[error("a mesh of {voxels} voxels has more than 2^31 tetrahedra")]
    TooMany {
        /// Number of filled cells.
        voxels: u64,
    },
}

/// Bytes of a boundary triangle: in the mesh, in a cavity, and twice with the cavity it faces.
const FACED_BYTES: u64 = 12 + 12 + 2 * 20;

/// Bytes that meshing takes at its peak, for a number of filled cells that share no vertex.
///
/// Per voxel at most 8 vertices (36 bytes each), 5 tets (17 bytes each), 18 edges and 12 boundary
/// triangles (kept, and twice with the cavity they face while planes are joined), and its cell. Real shapes need a third of it.
pub fn mesh_bytes(voxels: u64) -> u64 {
    voxels.saturating_mul(8 * 36 + 5 * 17 + 18 * 8 + 12 * FACED_BYTES + 12)
}

/// Bytes that meshing takes at its peak, from the true numbers of nodes and faces.
fn needed_bytes(voxels: u64, nodes: u64, exposed: u64) -> u64 {
    let faces = (6 * voxels + exposed) / 2;
    let edges = 3 * nodes + faces;
    let kept = voxels * (5 * 17 + 12) + nodes * 36 + edges * 8 + exposed * 2 * FACED_BYTES;
    // The largest list exists twice while its planes are joined.
    kept + voxels * 5 * 16
}

/// The five-tet mesh of the filled cells.
///
/// Voxels that touch are stitched, also where they share only an edge or a corner; see
/// [`crate::hinges`] for these. Cavity surfaces are triangles of the boundary.
///
/// # Errors
///
/// [`StitchError`] if nothing is filled, or the mesh needs more than `memory_limit` bytes
/// (`u64::MAX` for no limit).
pub fn tet_mesh(grid: &Grid, memory_limit: u64) -> Result<TetMesh, StitchError> {
    let filled = BitGrid::filled(grid);
    let nodes = NodeIndex::new(&filled);
    check_size(&filled, &nodes, memory_limit)?;

    let voxels = Voxels {
        grid,
        filled: &filled,
        nodes: &nodes,
    };
    let planes = grid.shape()[0];
    let keys = by_plane(planes + 1, |i| voxels.keys(i));
    let cavities = LabeledCavities::new(grid, &filled);
    let faced = by_plane(planes, |i| voxels.boundary(i, &cavities));
    Ok(TetMesh {
        vertices: keys.iter().map(|&key| grid.node_position(key)).collect(),
        keys,
        tets: by_plane(planes, |i| voxels.tets(i)),
        edges: by_plane(planes + 1, |i| voxels.edges(i)),
        triangles: faced.iter().map(|&(triangle, _)| triangle).collect(),
        tet_part: by_plane(planes, |i| voxels.parts(i)),
        voxel_cells: by_plane(planes, |i| voxels.cells(i)),
        voxel_size: Some(grid.voxel_size()),
        cavities: cavity_surfaces(&cavities, &faced),
    })
}

fn check_size(filled: &BitGrid, nodes: &NodeIndex, limit: u64) -> Result<(), StitchError> {
    let voxels = count(filled.words());
    if voxels == 0 {
        return Err(StitchError::Empty);
    }
    if voxels * 5 > i32::MAX as u64 || nodes.len > i32::MAX as u64 {
        return Err(StitchError::TooMany { voxels });
    }
    let bytes = needed_bytes(voxels, nodes.len, exposed_faces(filled));
    if bytes > limit {
        return Err(StitchError::TooLarge {
            voxels,
            bytes,
            limit,
        });
    }
    Ok(())
}

fn count(words: &[u64]) -> u64 {
    words.iter().map(|word| u64::from(word.count_ones())).sum()
}

/// Number of faces of filled cells whose other side is empty.
fn exposed_faces(filled: &BitGrid) -> u64 {
    let [nx, ny, _] = filled.shape().map(|n| n as isize);
    let mut faces = 0;
    for i in 0..nx {
        for j in 0..ny {
            for w in 0..filled.words_per_row() {
                let word = filled.word(i, j, w);
                faces += exposed(filled, i, j, w)
                    .map(|side| (word & side).count_ones())
                    .iter()
                    .sum::<u32>() as u64;
            }
        }
    }
    faces
}

/// For the faces −x, +x, −y, +y, −z, +z: the cells of a word whose neighbor there is empty.
fn exposed(filled: &BitGrid, i: isize, j: isize, w: usize) -> [u64; 6] {
    [
        !filled.word(i - 1, j, w),
        !filled.word(i + 1, j, w),
        !filled.word(i, j - 1, w),
        !filled.word(i, j + 1, w),
        !filled.behind(i, j, w),
        !filled.ahead(i, j, w),
    ]
}

/// What the lists of a mesh are made of, one plane of cells or nodes at a time.
struct Voxels<'a> {
    grid: &'a Grid,
    filled: &'a BitGrid,
    nodes: &'a NodeIndex,
}

impl Voxels<'_> {
    /// Lists what `push` adds for each set cell of plane i, in C order; `each` per cell at most.
    fn collect<T>(
        bits: &BitGrid,
        i: usize,
        each: usize,
        mut push: impl FnMut(&mut Vec<T>, [usize; 3]),
    ) -> Vec<T> {
        let rows = || (0..bits.shape()[1]).map(|j| bits.row(i, j));
        let cells: u32 = rows().flatten().map(|word| word.count_ones()).sum();
        let mut list = Vec::with_capacity(each * cells as usize);
        for (j, row) in rows().enumerate() {
            for (w, &word) in row.iter().enumerate() {
                for bit in ones(word) {
                    push(&mut list, [i, j, w * 64 + bit]);
                }
            }
        }
        list
    }

    fn on_lattice(&self, index: [usize; 3]) -> [i32; 3] {
        let offset = self.grid.lattice_offset();
        std::array::from_fn(|a| offset[a] + index[a] as i32)
    }

    /// Vertices of the eight corners of a filled cell. Both nodes of its edges along z are in use,
    /// so their vertices are neighbors in number.
    fn corners(&self, [i, j, k]: [usize; 3]) -> [i32; 8] {
        let low = [(i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1)]
            .map(|(i, j)| self.nodes.vertex(i, j, k));
        std::array::from_fn(|c| low[c / 2] + (c % 2) as i32)
    }

    fn keys(&self, i: usize) -> Vec<[i32; 3]> {
        Self::collect(&self.nodes.bits, i, 1, |keys, node| {
            keys.push(self.on_lattice(node))
        })
    }

    fn cells(&self, i: usize) -> Vec<[i32; 3]> {
        Self::collect(self.filled, i, 1, |cells, cell| {
            cells.push(self.on_lattice(cell))
        })
    }

    fn parts(&self, i: usize) -> Vec<u8> {
        Self::collect(self.filled, i, 5, |parts, cell| {
            parts.extend([self.grid.get(cell); 5])
        })
    }

    fn tets(&self, i: usize) -> Vec<[i32; 4]> {
        Self::collect(self.filled, i, 5, |list, cell| {
            let corners = self.corners(cell);
            let of_cell = tets(is_even(self.on_lattice(cell)));
            list.extend(of_cell.map(|tet| tet.map(|c| corners[c])));
        })
    }

    /// The boundary triangles of a plane of cells, each with the cavity it faces.
    fn boundary(&self, i: usize, cavities: &LabeledCavities) -> Vec<([i32; 3], Option<u32>)> {
        let mut triangles = Vec::new();
        for j in 0..self.filled.shape()[1] {
            for w in 0..self.filled.words_per_row() {
                let sides = exposed(self.filled, i as isize, j as isize, w);
                let word = self.filled.row(i, j)[w];
                let outer = word & sides.iter().fold(0, |any, side| any | side);
                for bit in ones(outer) {
                    let cell = [i, j, w * 64 + bit];
                    let corners = self.corners(cell);
                    let even = is_even(self.on_lattice(cell));
                    for face in (0..6).filter(|&face| sides[face] >> bit & 1 == 1) {
                        let cavity = self.cavity_behind(cell, face, cavities);
                        for triangle in face_triangles(even, face) {
                            triangles.push((triangle.map(|c| corners[c]), cavity));
                        }
                    }
                }
            }
        }
        triangles
    }

    /// The cavity on the other side of a face of a cell.
    fn cavity_behind(
        &self,
        cell: [usize; 3],
        face: usize,
        cavities: &LabeledCavities,
    ) -> Option<u32> {
        let mut neighbor = cell;
        let axis = face / 2;
        neighbor[axis] = if face.is_multiple_of(2) {
            cell[axis].checked_sub(1)?
        } else {
            cell[axis] + 1
        };
        if neighbor[axis] >= self.filled.shape()[axis] {
            return None;
        }
        cavities.place(neighbor[0], neighbor[1], neighbor[2])
    }

    /// The edges that start at the nodes of plane i, towards nodes later in C order.
    ///
    /// There are nine directions: three axes, and the diagonals of the faces, which only join even
    /// nodes. An edge exists if one of the cells around it is filled.
    fn edges(&self, i: usize) -> Vec<[i32; 2]> {
        let mut edges = Vec::new();
        let offset = self.grid.lattice_offset();
        for j in 0..self.nodes.bits.shape()[1] {
            for w in 0..self.nodes.bits.words_per_row() {
                let directions = self.edge_directions(i as isize, j as isize, w);
                for bit in ones(self.nodes.bits.row(i, j)[w]) {
                    let k = w * 64 + bit;
                    let start = self.nodes.vertex(i, j, k);
                    let even = is_even([
                        i as i32 + offset[0],
                        j as i32 + offset[1],
                        k as i32 + offset[2],
                    ]);
                    for (exists, [di, dj, dk]) in directions {
                        let diagonal = (di + dj + dk) % 2 == 0;
                        if exists >> bit & 1 == 1 && (even || !diagonal) {
                            let along = |n: usize, d: isize| n.wrapping_add_signed(d);
                            edges.push([
                                start,
                                self.nodes.vertex(along(i, di), along(j, dj), along(k, dk)),
                            ]);
                        }
                    }
                }
            }
        }
        edges
    }

    /// For the nine directions in C order: the nodes of a word that have cells around the edge.
    fn edge_directions(&self, i: isize, j: isize, w: usize) -> [(u64, [isize; 3]); 9] {
        let cells = |i, j| self.filled.word(i, j, w);
        let below = |i, j| self.filled.behind(i, j, w);
        // Faces normal to x and y that start at the node, and those that end at it along z.
        let (face_x, face_x_below) = (cells(i - 1, j) | cells(i, j), below(i - 1, j) | below(i, j));
        let (face_y, face_y_below) = (cells(i, j - 1) | cells(i, j), below(i, j - 1) | below(i, j));
        let (face_z, face_z_left) = (cells(i, j) | below(i, j), cells(i, j - 1) | below(i, j - 1));
        [
            (face_x | cells(i - 1, j - 1) | cells(i, j - 1), [0, 0, 1]),
            (face_x_below, [0, 1, -1]),
            (face_x | face_x_below, [0, 1, 0]),
            (face_x, [0, 1, 1]),
            (face_z_left, [1, -1, 0]),
            (face_y_below, [1, 0, -1]),
            (face_y | face_y_below, [1, 0, 0]),
            (face_y, [1, 0, 1]),
            (face_z, [1, 1, 0]),
        ]
    }
}

fn cavity_surfaces(
    cavities: &LabeledCavities,
    faced: &[([i32; 3], Option<u32>)],
) -> Vec<CavitySurface> {
    let mut surfaces: Vec<CavitySurface> = cavities
        .cavities
        .iter()
        .map(|c| CavitySurface {
            triangles: Vec::new(),
            volume: c.volume,
            area: c.area,
        })
        .collect();
    for &(triangle, cavity) in faced {
        if let Some(place) = cavity {
            surfaces[place as usize].triangles.push(triangle);
        }
    }
    surfaces
}
