//! The order in which constraints are solved.

use crate::Mesh;

/// Number of blocks of one color that are solved side by side. They share no vertex, so that a processor can overlap
/// their long chains of divisions and roots; eight keep it busy.
const CHUNK: usize = 8;

/// Blocks of tetrahedra, in chunks of up to [`CHUNK`] blocks of one color.
pub(crate) struct ColorOrder {
    /// For each chunk its blocks, for each block its tetrahedra.
    pub chunks: Vec<Vec<Vec<usize>>>,
    /// End of each color in the list of chunks.
    pub colors: Vec<u32>,
}

/// Greedy coloring: a block takes the lowest color that none of its vertices has seen. Voxels in
/// C order get the eight colors of their parities where the grid is dense.
pub(crate) fn color_order(mesh: &Mesh) -> ColorOrder {
    let count = mesh.tet_block.iter().max().map_or(0, |&b| b as usize + 1);
    let mut members = vec![Vec::new(); count];
    for (tet, &block) in mesh.tet_block.iter().enumerate() {
        members[block as usize].push(tet);
    }
    let mut seen = vec![0u128; mesh.vertices.len()];
    let mut by_color: Vec<Vec<Vec<usize>>> = Vec::new();
    for block in members.into_iter().filter(|block| !block.is_empty()) {
        let vertices = || block.iter().flat_map(|&t| mesh.tets[t]).map(|v| v as usize);
        let taken = vertices().fold(0, |taken, v| taken | seen[v]);
        // A vertex with more than 128 blocks around it cannot be colored apart; such blocks share
        // the last color, which only costs parallelism because chunks are solved in order.
        let color = (taken.trailing_ones() as usize).min(127);
        vertices().for_each(|v| seen[v] |= 1 << color);
        if by_color.len() <= color {
            by_color.resize(color + 1, Vec::new());
        }
        by_color[color].push(block);
    }
    let (mut chunks, mut colors) = (Vec::new(), Vec::new());
    for blocks in by_color {
        chunks.extend(blocks.chunks(CHUNK).map(<[_]>::to_vec));
        colors.push(chunks.len() as u32);
    }
    ColorOrder { chunks, colors }
}

/// Interleaves lists: the first of every list, then the second of every list, and so on.
pub(crate) fn interleave<T: Copy>(lists: &[Vec<T>]) -> impl Iterator<Item = T> + '_ {
    let longest = lists.iter().map(Vec::len).max().unwrap_or(0);
    (0..longest).flat_map(move |slot| lists.iter().filter_map(move |list| list.get(slot).copied()))
}
