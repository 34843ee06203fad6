//! Connected components of a tetrahedral mesh, joined by whole faces.

/// Component of each tetrahedron, numbered in the order of their first tetrahedra.
///
/// Tetrahedra that share only an edge or a vertex hinge on it and count as separate components.
///
/// ```
/// use voxsoft_voxel::pieces;
///
/// // Two that share a face, and a third that shares only an edge with them.
/// assert_eq!(pieces(&[[0, 1, 2, 3], [1, 2, 3, 4], [0, 1, 5, 6]]), [0, 0, 1]);
/// ```
pub fn pieces(tets: &[[i32; 4]]) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..tets.len() as u32).collect();
    // Each lowest vertex has a list of its faces: a few dozen, which are compared one by one.
    let lowest = |tet: &[i32; 4]| tet.iter().map(|&v| v as usize + 1).max().unwrap_or(0);
    let vertices = tets.iter().map(lowest).max().unwrap_or(0);
    const NONE: u32 = u32::MAX;
    let mut heads = vec![NONE; vertices];
    // Entries of the lists: the other two vertices of a face, its tetrahedron, and the next face of the same list.
    let mut faces: Vec<([i32; 2], u32, u32)> = Vec::with_capacity(4 * tets.len());
    for (tet, corners) in tets.iter().enumerate() {
        let mut sorted = *corners;
        sorted.sort_unstable();
        let [a, b, c, d] = sorted;
        for (low, others) in [(a, [b, c]), (a, [b, d]), (a, [c, d]), (b, [c, d])] {
            let head = &mut heads[low as usize];
            let mut at = *head;
            while at != NONE && faces[at as usize].0 != others {
                at = faces[at as usize].2;
            }
            if at == NONE {
                faces.push((others, tet as u32, *head));
                *head = faces.len() as u32 - 1;
            } else {
                join(&mut parents, faces[at as usize].1, tet as u32);
            }
        }
    }
    let mut numbers = vec![NONE; tets.len()];
    let mut count = 0;
    (0..tets.len() as u32)
        .map(|tet| {
            let number = &mut numbers[root(&mut parents, tet) as usize];
            if *number == NONE {
                *number = count;
                count += 1;
            }
            *number
        })
        .collect()
}

fn root(parents: &mut [u32], mut tet: u32) -> u32 {
    while parents[tet as usize] != tet {
        let above = parents[parents[tet as usize] as usize];
        parents[tet as usize] = above;
        tet = above;
    }
    tet
}

fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Contact, Grid, components, tet_mesh};

    #[test]
    fn cells_that_share_faces_are_one_component() {
        // Two bars, a bar that touches one of them along an edge, and one that touches it at a corner.
        let mut grid = Grid::empty([8, 8, 8], [0.0; 3], 1.0, u64::MAX).unwrap();
        for (low, high) in [
            ([0.0, 0.0, 0.0], [2.0, 1.0, 5.0]),
            ([4.0, 0.0, 0.0], [5.0, 3.0, 1.0]),
            ([2.0, 1.0, 0.0], [3.0, 3.0, 2.0]),
            ([3.0, 3.0, 2.0], [4.0, 4.0, 6.0]),
        ] {
            grid.fill_box(low, high, 1);
        }
        let mesh = tet_mesh(&grid, u64::MAX).unwrap();
        let found = pieces(&mesh.tets);
        let mut sizes = vec![0; 4];
        found.iter().for_each(|&piece| sizes[piece as usize] += 1);
        sizes.sort_unstable();
        let mut expected: Vec<u64> = components(&grid, Contact::Face)
            .iter()
            .map(|region| 5 * region.cell_count())
            .collect();
        expected.sort_unstable();
        assert_eq!(sizes, expected);
    }

    #[test]
    fn empty_mesh_has_no_component() {
        assert!(pieces(&[]).is_empty());
    }
}
