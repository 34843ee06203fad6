//! Colors of nodes: neighbors differ, so that all nodes of a color can be relaxed at once.

use std::ops::Range;

use super::blocks::BlockMatrix;

/// Start of each color in the numbering by colors, and the end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Coloring {
    starts: Vec<usize>,
}

impl Coloring {
    /// Nodes of each color.
    pub fn ranges(&self) -> impl DoubleEndedIterator<Item = Range<usize>> + '_ {
        self.starts.windows(2).map(|ends| ends[0]..ends[1])
    }
}

/// Colors the nodes of a pattern one after the other, and numbers them color by color; returns the new place of each
/// node too. On a full grid these are the eight parities.
pub(crate) fn color(pattern: &BlockMatrix) -> (Coloring, Vec<u32>) {
    let count = pattern.rows();
    let mut colors = vec![u32::MAX; count];
    let mut sizes: Vec<usize> = Vec::new();
    let mut taken: Vec<usize> = Vec::new();
    for node in 0..count {
        for neighbor in pattern.columns(node) {
            if let Some(mark) = taken.get_mut(colors[neighbor as usize] as usize) {
                *mark = node + 1;
            }
        }
        let color = taken.iter().position(|&mark| mark != node + 1);
        let color = color.unwrap_or_else(|| {
            taken.push(0);
            sizes.push(0);
            taken.len() - 1
        });
        colors[node] = color as u32;
        sizes[color] += 1;
    }
    let mut starts = vec![0];
    for size in sizes {
        starts.push(starts[starts.len() - 1] + size);
    }
    let mut next = starts.clone();
    let places = colors
        .iter()
        .map(|&color| {
            let place = &mut next[color as usize];
            *place += 1;
            (*place - 1) as u32
        })
        .collect();
    (Coloring { starts }, places)
}
