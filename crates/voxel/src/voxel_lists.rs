//! Lists of the mesh of a grid, each in C order of its cells or nodes.
use std::sync::atomic::AtomicBool;

use crate::bits::{BitGrid, ones};
use crate::cavities::LabeledCavities;
use crate::five_tets::{face_triangles, is_even, tets};
use crate::grid::Grid;
use crate::nodes::NodeIndex;
use crate::planes::{Slots, fill_planes};

/// Filled cells of a grid and the lattice nodes they use.
pub(crate) struct VoxelLists<'a> {
    pub grid: &'a Grid,
    pub filled: &'a BitGrid,
    pub nodes: &'a NodeIndex,
    /// Flag of cancellation, after which the lists are incomplete.
    pub cancel: &'a AtomicBool,
}

impl VoxelLists<'_> {
    pub fn keys(&self) -> Vec<[i32; 3]> {
        self.list(&self.nodes.bits, 1, |keys, node| {
            keys.push(self.on_lattice(node))
        })
    }

    pub fn vertices(&self) -> Vec<[f64; 3]> {
        self.list(&self.nodes.bits, 1, |vertices, node| {
            vertices.push(self.grid.node_position(self.on_lattice(node)));
        })
    }

    pub fn cells(&self) -> Vec<[i32; 3]> {
        self.list(self.filled, 1, |cells, cell| {
            cells.push(self.on_lattice(cell))
        })
    }

    pub fn parts(&self) -> Vec<u8> {
        self.list(self.filled, 5, |parts, cell| {
            let part = self.grid.get(cell);
            (0..5).for_each(|_| parts.push(part));
        })
    }

    pub fn tets(&self) -> Vec<[i32; 4]> {
        self.list(self.filled, 5, |list, cell| {
            let corners = self.corners(cell);
            for tet in tets(is_even(self.on_lattice(cell))) {
                list.push(tet.map(|c| corners[c]));
            }
        })
    }

    /// Triangles of the boundary.
    pub fn triangles(&self) -> Vec<[i32; 3]> {
        let planes = 0..self.grid.shape()[0];
        let counts: Vec<usize> = planes.map(|i| 2 * exposed_faces(self.filled, i)).collect();
        fill_planes(&counts, self.cancel, |i, triangles| {
            self.for_each_exposed(i, |cell, faces| {
                let corners = self.corners(cell);
                let even = is_even(self.on_lattice(cell));
                for face in ones(faces) {
                    for triangle in face_triangles(even, face) {
                        triangles.push(triangle.map(|c| corners[c]));
                    }
                }
            });
        })
    }

    /// Boundary triangles of a plane of cells that face a cavity, with its index in the list.
    pub fn facing(&self, i: usize, cavities: &LabeledCavities) -> Vec<(u32, [i32; 3])> {
        let mut facing = Vec::new();
        self.for_each_exposed(i, |cell, faces| {
            for face in ones(faces) {
                if let Some(cavity) = self.cavity_behind(cell, face, cavities) {
                    let corners = self.corners(cell);
                    let even = is_even(self.on_lattice(cell));
                    let triangles = face_triangles(even, face);
                    facing.extend(triangles.map(|t| (cavity, t.map(|c| corners[c]))));
                }
            }
        });
        facing
    }

    /// Makes a list of `each` items per member of a set of cells or nodes.
    fn list<T: Clone + Default + Send>(
        &self,
        bits: &BitGrid,
        each: usize,
        push: impl Fn(&mut Slots<T>, [usize; 3]) + Sync + Send,
    ) -> Vec<T> {
        let counts: Vec<usize> = (0..bits.shape()[0])
            .map(|i| each * bits.count_in_plane(i))
            .collect();
        fill_planes(&counts, self.cancel, |i, slots| {
            for j in 0..bits.shape()[1] {
                for (w, &word) in bits.row(i, j).iter().enumerate() {
                    for bit in ones(word) {
                        push(slots, [i, j, w * 64 + bit]);
                    }
                }
            }
        })
    }

    pub fn on_lattice(&self, index: [usize; 3]) -> [i32; 3] {
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

    /// Visits the cells of a plane that have an empty neighbor; bit f is set for each such face.
    fn for_each_exposed(&self, i: usize, mut visit: impl FnMut([usize; 3], u64)) {
        for j in 0..self.filled.shape()[1] {
            for w in 0..self.filled.words_per_row() {
                let sides = exposed(self.filled, i, j, w);
                for bit in ones(sides.iter().fold(0, |any, side| any | side)) {
                    let faces = (0..6).fold(0, |faces, f| faces | (sides[f] >> bit & 1) << f);
                    visit([i, j, w * 64 + bit], faces);
                }
            }
        }
    }

    /// Cavity on the other side of a face of a cell.
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
}

/// Number of faces of the filled cells of a plane whose other side is empty.
pub(crate) fn exposed_faces(filled: &BitGrid, i: usize) -> usize {
    let words = |j| (0..filled.words_per_row()).flat_map(move |w| exposed(filled, i, j, w));
    (0..filled.shape()[1])
        .flat_map(words)
        .map(|side| side.count_ones() as usize)
        .sum()
}

/// Filled cells of a word whose neighbor is empty, for the faces −x, +x, −y, +y, −z, +z.
fn exposed(filled: &BitGrid, i: usize, j: usize, w: usize) -> [u64; 6] {
    let (i, j) = (i as isize, j as isize);
    let cells = filled.word(i, j, w);
    [
        cells & !filled.word(i - 1, j, w),
        cells & !filled.word(i + 1, j, w),
        cells & !filled.word(i, j - 1, w),
        cells & !filled.word(i, j + 1, w),
        cells & !filled.behind(i, j, w),
        cells & !filled.ahead(i, j, w),
    ]
}
