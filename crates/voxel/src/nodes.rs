//! Index of the lattice nodes in use, the vertices of a voxel mesh.
//!
//! Nodes are a bit set with a running count per word. The vertex of a node is that count plus the number of nodes
//! before it in its word: 0.2 bytes per node, and a lookup of a few instructions.
use crate::bits::BitGrid;

/// Lattice nodes in use, with the vertex of each.
pub(crate) struct NodeIndex {
    pub bits: BitGrid,
    /// Number of nodes before each word.
    before: Vec<u32>,
    pub len: u64,
}

impl NodeIndex {
    pub fn new(filled: &BitGrid) -> Self {
        let shape = filled.shape().map(|n| n + 1);
        let mut bits = BitGrid::new(shape);
        for i in 0..shape[0] {
            for j in 0..shape[1] {
                let (x, y) = (i as isize, j as isize);
                for (w, word) in bits.row_mut(i, j).iter_mut().enumerate() {
                    for (x, y) in [(x - 1, y - 1), (x - 1, y), (x, y - 1), (x, y)] {
                        *word |= filled.word(x, y, w) | filled.behind(x, y, w);
                    }
                }
            }
        }
        let mut len = 0_u64;
        let before = bits
            .words()
            .iter()
            .map(|word| {
                let before = len as u32;
                len += u64::from(word.count_ones());
                before
            })
            .collect();
        Self { bits, before, len }
    }

    /// The vertex of a node in use.
    pub fn vertex(&self, i: usize, j: usize, k: usize) -> i32 {
        let shape = self.bits.shape();
        let word = (i * shape[1] + j) * self.bits.words_per_row() + k / 64;
        let lower = self.bits.words()[word] & !(u64::MAX << (k % 64));
        (self.before[word] + lower.count_ones()) as i32
    }
}
