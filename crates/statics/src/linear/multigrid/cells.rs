//! Coarsening of voxels to ever larger cubes.
//!
//! Up to eight cells of a level make a cell of the next, whose corners interpolate the nodes inside. Walls that do not
//! touch must not share such corners, however close they are, or the coarse body would be welded where the fine one is
//! open: cells of one cube that are not connected make cubes of their own, with nodes of their own, and neighbors share
//! a node only where they share a node of the finer level (after Nesme, Kry, Jeřábková and Faure 2009, doi
//! 10.1145/1531326.1531358).

use voxsoft_solid::Body;
use voxsoft_solid::vector::{Vec3, dot, sub};

/// Cube of a level: its place on the grid of that level and its nodes; corner `c` lies at
/// `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cell {
    pub at: [i32; 3],
    pub nodes: [u32; 8],
}

/// Interpolation of each node of a level from nodes of the next, with their weights.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Interpolation {
    pub starts: Vec<u32>,
    pub entries: Vec<(u32, f64)>,
}

impl Interpolation {
    pub fn row(&self, node: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[node] as usize..self.starts[node + 1] as usize]
    }
}

/// Voxels of a body as cells; `None` if connected ones are not of one size on one grid.
///
/// Components that share no vertex have grids of their own, of any size and direction: they share no node on any level
/// either.
pub(crate) fn cells_of(body: &Body) -> Option<Vec<Cell>> {
    let voxels = body.voxels();
    let mut components = Classes::new(body.rest().len());
    for nodes in voxels {
        nodes
            .iter()
            .for_each(|node| components.join(nodes[0] as usize, *node as usize));
    }
    let mut lattices: Vec<Option<Lattice>> = vec![None; body.rest().len()];
    let mut cell = |nodes: &[u32; 8]| {
        let corners = nodes.map(|node| body.rest()[node as usize]);
        let own = &mut lattices[components.find(nodes[0] as usize)];
        let at = own
            .get_or_insert_with(|| Lattice::of(&corners))
            .place(&corners)?;
        Some(Cell { at, nodes: *nodes })
    };
    voxels.iter().map(&mut cell).collect()
}

/// Grid of the voxels of a component.
#[derive(Debug, Clone)]
struct Lattice {
    /// Corner of a voxel, m.
    origin: Vec3,
    /// Edges of that voxel, m.
    edges: [Vec3; 3],
}

impl Lattice {
    /// Grid of a voxel with these corners.
    fn of(corners: &[Vec3; 8]) -> Self {
        let edge = |axis: usize| sub(corners[4 >> axis], corners[0]);
        Self {
            origin: corners[0],
            edges: [edge(0), edge(1), edge(2)],
        }
    }

    /// Place of a voxel; `None` if it does not fit.
    fn place(&self, corners: &[Vec3; 8]) -> Option<[i32; 3]> {
        let along = |axis: usize, x: Vec3| {
            dot(x, self.edges[axis]) / dot(self.edges[axis], self.edges[axis])
        };
        let from_origin = |axis| along(axis, sub(corners[0], self.origin));
        let at: [i32; 3] = std::array::from_fn(|axis| from_origin(axis).round() as i32);
        let across = sub(corners[7], corners[0]);
        let fits = (0..3).all(|axis| {
            (from_origin(axis) - f64::from(at[axis])).abs() < 1e-3
                && (along(axis, across) - 1.0).abs() < 1e-3
        });
        fits.then_some(at)
    }
}

/// Places of `nodes` nodes on the grid of their cells.
pub(crate) fn places_of(cells: &[Cell], nodes: usize) -> Vec<Vec3> {
    let mut places = vec![[0.0; 3]; nodes];
    for cell in cells {
        for (corner, &node) in cell.nodes.iter().enumerate() {
            places[node as usize] =
                std::array::from_fn(|axis| f64::from(cell.at[axis] + bit(corner, axis) as i32));
        }
    }
    places
}

/// Cells of the next level, the number of its nodes, and the interpolation of `nodes` nodes; those of rigid `objects`
/// are nodes of the next level, too.
pub(crate) fn coarsen(
    cells: &[Cell],
    objects: &[u32],
    nodes: usize,
) -> (Vec<Cell>, usize, Interpolation) {
    let (mut coarse, member_of) = group(cells);

    // First coarse cell that contains a node, and the node's place in it. Every further one shares the corners that
    // interpolate the node.
    let mut home: Vec<Option<(u32, [i32; 3])>> = vec![None; nodes];
    let mut corners = Classes::new(8 * coarse.len());
    for (cell, &owner) in cells.iter().zip(&member_of) {
        for (corner, &node) in cell.nodes.iter().enumerate() {
            let place: [i32; 3] =
                std::array::from_fn(|axis| (cell.at[axis] & 1) + bit(corner, axis) as i32);
            match home[node as usize] {
                None => home[node as usize] = Some((owner, place)),
                Some((other, there)) if other != owner => {
                    let (a, b) = (&coarse[other as usize], &coarse[owner as usize]);
                    for (theirs, _) in weights(there) {
                        let ours = (0..3).fold(0, |bits, axis| {
                            2 * bits + (a.at[axis] + bit(theirs, axis) as i32 - b.at[axis])
                        });
                        corners.join(
                            8 * other as usize + theirs,
                            8 * owner as usize + ours as usize,
                        );
                    }
                }
                Some(_) => {}
            }
        }
    }

    let mut numbers = vec![u32::MAX; 8 * coarse.len()];
    let mut count = 0;
    for (index, cell) in coarse.iter_mut().enumerate() {
        for (corner, node) in cell.nodes.iter_mut().enumerate() {
            let class = corners.find(8 * index + corner);
            if numbers[class] == u32::MAX {
                numbers[class] = count;
                count += 1;
            }
            *node = numbers[class];
        }
    }

    let mut interpolation = Interpolation {
        starts: vec![0],
        entries: Vec::with_capacity(4 * nodes),
    };
    let mut kept = vec![None; nodes];
    for &node in objects {
        kept[node as usize] = Some(count);
        count += 1;
    }
    for (place, kept) in home.into_iter().zip(kept) {
        interpolation.entries.extend(kept.map(|own| (own, 1.0)));
        if let Some((owner, place)) = place {
            let corners = &coarse[owner as usize].nodes;
            let hangs_on = weights(place).map(|(corner, weight)| (corners[corner], weight));
            interpolation.entries.extend(hangs_on);
        }
        interpolation
            .starts
            .push(interpolation.entries.len() as u32);
    }
    (coarse, count as usize, interpolation)
}

/// Merges connected cells of the same larger cube; returns the coarse cell of each cell too. Nodes are not set yet.
fn group(cells: &[Cell]) -> (Vec<Cell>, Vec<u32>) {
    let cube_of = |index: u32| cells[index as usize].at.map(|x| x >> 1);
    let mut order: Vec<u32> = (0..cells.len() as u32).collect();
    order.sort_by_key(|&index| cube_of(index));
    let mut coarse = Vec::with_capacity(cells.len() / 4);
    let mut member_of = vec![0; cells.len()];
    for members in order.chunk_by(|&a, &b| cube_of(a) == cube_of(b)) {
        let mut classes = Classes::new(members.len());
        for (a, &first) in members.iter().enumerate() {
            for (b, &second) in members.iter().enumerate().skip(a + 1) {
                let nodes = &cells[second as usize].nodes;
                if cells[first as usize]
                    .nodes
                    .iter()
                    .any(|n| nodes.contains(n))
                {
                    classes.join(a, b);
                }
            }
        }
        let base = coarse.len();
        let mut found: Vec<usize> = Vec::new();
        for (place, &member) in members.iter().enumerate() {
            let class = classes.find(place);
            let index = found.iter().position(|&c| c == class).unwrap_or_else(|| {
                found.push(class);
                coarse.push(Cell {
                    at: cube_of(member),
                    nodes: [0; 8],
                });
                found.len() - 1
            });
            member_of[member as usize] = (base + index) as u32;
        }
    }
    (coarse, member_of)
}

fn bit(corner: usize, axis: usize) -> usize {
    corner >> (2 - axis) & 1
}

/// Corners of a cube, and their trilinear weights at a node at `place`, in half sides; corners of weight zero are left
/// out.
fn weights(place: [i32; 3]) -> impl Iterator<Item = (usize, f64)> {
    (0..8).filter_map(move |corner| {
        let weight: f64 = (0..3)
            .map(|axis| {
                let along = f64::from(place[axis]) / 2.0;
                if bit(corner, axis) == 1 {
                    along
                } else {
                    1.0 - along
                }
            })
            .product();
        (weight > 0.0).then_some((corner, weight))
    })
}

/// Equivalence classes that are joined one pair after the other.
struct Classes(Vec<u32>);

impl Classes {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn find(&mut self, mut item: usize) -> usize {
        while self.0[item] as usize != item {
            self.0[item] = self.0[self.0[item] as usize];
            item = self.0[item] as usize;
        }
        item
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells at the given places that share nodes wherever they touch.
    fn stitched(places: &[[i32; 3]]) -> (Vec<Cell>, usize) {
        let mut numbers = std::collections::BTreeMap::new();
        let mut cells = Vec::new();
        for &at in places {
            let nodes = std::array::from_fn(|corner| {
                let node: [i32; 3] =
                    std::array::from_fn(|axis| at[axis] + bit(corner, axis) as i32);
                let next = numbers.len() as u32;
                *numbers.entry(node).or_insert(next)
            });
            cells.push(Cell { at, nodes });
        }
        (cells, numbers.len())
    }

    fn block(shape: [i32; 3]) -> Vec<[i32; 3]> {
        let mut places = Vec::new();
        for x in 0..shape[0] {
            for y in 0..shape[1] {
                places.extend((0..shape[2]).map(|z| [x, y, z]));
            }
        }
        places
    }

    #[test]
    fn a_block_becomes_a_block_of_half_the_cells() {
        let (cells, nodes) = stitched(&block([5, 4, 2]));
        let (coarse, count, interpolation) = coarsen(&cells, &[], nodes);
        assert_eq!(coarse.len(), 3 * 2);
        assert_eq!(count, 4 * 3 * 2);
        for node in 0..nodes {
            let sum: f64 = interpolation.row(node).iter().map(|(_, w)| w).sum();
            assert!((sum - 1.0).abs() < 1e-15);
        }
    }

    /// Interpolation reproduces linear functions: rigid motions and uniform strains are coarse.
    #[test]
    fn linear_functions_are_reproduced() {
        let places: Vec<[i32; 3]> = block([4, 4, 4])
            .into_iter()
            .filter(|at| (at[0] * 7 + at[1] * 3 + at[2] * 5) % 4 != 0)
            .collect();
        let (cells, nodes) = stitched(&places);
        let (coarse, count, interpolation) = coarsen(&cells, &[], nodes);
        let mut fine = vec![[0.0; 3]; nodes];
        let mut large = vec![[0.0; 3]; count];
        for (list, values, side) in [(&cells, &mut fine, 1.0), (&coarse, &mut large, 2.0)] {
            for cell in list {
                for (corner, &node) in cell.nodes.iter().enumerate() {
                    values[node as usize] = std::array::from_fn(|axis| {
                        side * (f64::from(cell.at[axis]) + bit(corner, axis) as f64)
                    });
                }
            }
        }
        for (node, value) in fine.iter().enumerate() {
            for axis in 0..3 {
                let row = interpolation.row(node);
                let sum: f64 = row.iter().map(|&(c, w)| w * large[c as usize][axis]).sum();
                assert!((sum - value[axis]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn walls_beside_a_slit_share_no_node() {
        // Two plates, the slit one cell wide: welded by plain coarsening at once.
        let mut places = block([1, 8, 8]);
        places.extend(block([1, 8, 8]).into_iter().map(|[x, y, z]| [x + 2, y, z]));
        let (mut cells, mut nodes) = stitched(&places);
        for _ in 0..3 {
            let (coarse, count, _) = coarsen(&cells, &[], nodes);
            (cells, nodes) = (coarse, count);
            let mut classes = Classes::new(nodes);
            for cell in &cells {
                for &node in &cell.nodes {
                    classes.join(cell.nodes[0] as usize, node as usize);
                }
            }
            let roots = (0..nodes).filter(|&n| classes.find(n) == n).count();
            assert_eq!(roots, 2);
        }
        assert_eq!(cells.len(), 2);
    }
}
