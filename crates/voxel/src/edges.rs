//! Edges of a voxel mesh, generated once each in sorted order.
use crate::bits::ones;
use crate::five_tets::is_even;
use crate::planes::fill_planes;
use crate::voxel_lists::VoxelLists;

/// Steps from a node to the other end of its edges, later ends only, in C order.
///
/// They are the three axes and the diagonals of the faces.
const STEPS: [[isize; 3]; 9] = [
    [0, 0, 1],
    [0, 1, -1],
    [0, 1, 0],
    [0, 1, 1],
    [1, -1, 0],
    [1, 0, -1],
    [1, 0, 0],
    [1, 0, 1],
    [1, 1, 0],
];

impl VoxelLists<'_> {
    /// Edges from each node in C order to nodes later in C order.
    pub fn edges(&self) -> Vec<[i32; 2]> {
        let [planes, rows, _] = self.nodes.bits.shape();
        let words = self.nodes.bits.words_per_row();
        let count = |i| {
            let of_row = |j| (0..words).flat_map(move |w| self.starts(i, j, w));
            (0..rows)
                .flat_map(of_row)
                .map(|starts| starts.count_ones() as usize)
                .sum()
        };
        let counts: Vec<usize> = (0..planes).map(count).collect();
        fill_planes(&counts, self.cancel, |i, edges| {
            for j in 0..rows {
                for w in 0..words {
                    let starts = self.starts(i, j, w);
                    for bit in ones(self.nodes.bits.row(i, j)[w]) {
                        let k = w * 64 + bit;
                        let start = self.nodes.vertex(i, j, k);
                        for (starts, [di, dj, dk]) in starts.iter().zip(STEPS) {
                            if starts >> bit & 1 == 1 {
                                let end = self.nodes.vertex(
                                    i.wrapping_add_signed(di),
                                    j.wrapping_add_signed(dj),
                                    k.wrapping_add_signed(dk),
                                );
                                edges.push([start, end]);
                            }
                        }
                    }
                }
            }
        })
    }

    /// Nodes of a word that have an edge, for each of [`STEPS`].
    ///
    /// An edge exists if one of the cells around it is filled; a diagonal of a face, if one of the
    /// two cells beside the face is filled and the node is even.
    fn starts(&self, i: usize, j: usize, w: usize) -> [u64; 9] {
        let (x, y) = (i as isize, j as isize);
        let cells = |i, j| self.filled.word(i, j, w);
        let below = |i, j| self.filled.behind(i, j, w);
        // Faces normal to x and y that start at the node, and those that end at it along z.
        let (face_x, face_x_below) = (cells(x - 1, y) | cells(x, y), below(x - 1, y) | below(x, y));
        let (face_y, face_y_below) = (cells(x, y - 1) | cells(x, y), below(x, y - 1) | below(x, y));
        let (face_z, face_z_left) = (cells(x, y) | below(x, y), cells(x, y - 1) | below(x, y - 1));
        let even = self.even_nodes(i, j);
        [
            face_x | cells(x - 1, y - 1) | cells(x, y - 1),
            face_x_below & even,
            face_x | face_x_below,
            face_x & even,
            face_z_left & even,
            face_y_below & even,
            face_y | face_y_below,
            face_y & even,
            face_z & even,
        ]
    }

    /// Even nodes of any word of a row; words begin at even k.
    fn even_nodes(&self, i: usize, j: usize) -> u64 {
        const EVEN_K: u64 = 0x5555_5555_5555_5555;
        if is_even(self.on_lattice([i, j, 0])) {
            EVEN_K
        } else {
            !EVEN_K
        }
    }
}
