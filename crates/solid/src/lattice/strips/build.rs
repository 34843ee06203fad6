//! Construction of strips from a body: slots for the vertices, then rows of constraints.

use std::ops::Range;

use super::{Kind, MAX_LANES, Strip, Strips};
use crate::Body;
use crate::vector::{Vec3, sub};

/// Largest distance of a vertex from its node, and difference of a rest value from its cube's, relative to the cube:
/// positions are products of integers and the voxel size, exact to rounding.
const SLACK: f64 = 1e-9;
/// Most constraints of a strip, so that all that share vertices find them in the nearest cache.
const MAX_COUNT: u32 = 64;
/// Number of constraints that make a slab worth a thread's time.
const SLAB_CONSTRAINTS: usize = 20_000;
/// Most slots for each node that a small body may take to have its nodes in a box.
const BOX_SLOTS: usize = 2;
/// Most nodes of the grid along an axis, because keys keep 20 bits for each.
const MAX_NODES: f64 = (1 << 20) as f64;

impl Strips {
    /// The strips of a body whose vertices are nodes of one cubic grid along the axes and which has no terms but edge
    /// and volume constraints; `None` for any other.
    pub fn of(body: &Body) -> Option<Self> {
        let other = !body.hex8s().is_empty() || !body.membranes().is_empty();
        if other || body.attached().next().is_some() || body.edges().is_empty() {
            return None;
        }
        let lattice = Lattice::of(body)?;
        let constraints = body.edges().len() + body.tets().len();
        let layers_each =
            (lattice.layers * SLAB_CONSTRAINTS / constraints).clamp(2, lattice.layers.max(2));

        let mut found = Vec::with_capacity(constraints);
        for index in 0..constraints {
            let [start, ..] = lattice.corners(index);
            found.push((
                u64::from(lattice.kind(index)?) << 32 | u64::from(start),
                index as u32,
            ));
        }
        found.sort_unstable();
        let mut rows = lattice.rows(&found);
        if !lattice.boxed {
            rows.sort_by_cached_key(|row| {
                let (key, index) = found[row.members.start];
                (
                    lattice.layer(index as usize),
                    lattice.pair(index as usize),
                    key,
                )
            });
        }

        let places = rows.iter().map(|row| padded(row.count)).sum();
        let mut strips = Vec::with_capacity(rows.len());
        let mut slabs: Vec<Range<usize>> = Vec::new();
        let mut stiffness = vec![0.0; places];
        let mut constraint = vec![u32::MAX; places];
        let mut first = 0;
        for row in rows {
            let start = found[row.members.start].1 as usize;
            let corners = lattice.corners(start);
            strips.push(Strip {
                corners,
                first: first as u32,
                count: row.count,
                kind: lattice.rest(start),
            });
            for &(key, index) in &found[row.members] {
                let place = first + (key as u32 - corners[0]) as usize;
                constraint[place] = index;
                let index = index as usize;
                stiffness[place] = match index.checked_sub(body.edges().len()) {
                    None => body.edges()[index].stiffness,
                    Some(tet) => body.tets()[tet].stiffness,
                };
            }
            first += padded(row.count);
            // A slab without a constraint still counts, or its neighbors would meet.
            let slab = lattice.layer(start) / layers_each;
            slabs.resize(slab + 1, strips.len() - 1..strips.len() - 1);
            slabs[slab].end = strips.len();
        }
        let strips = Self {
            slot_of: lattice.slot_of,
            slots: lattice.slots,
            strips,
            slabs,
            stiffness,
            constraint,
            arch: pulp::Arch::new(),
        };
        strips.check();
        Some(strips)
    }

    /// Checks that every slot that a kernel touches exists, which makes their unchecked loads and stores sound.
    fn check(&self) {
        for strip in &self.strips {
            let lanes = padded(strip.count);
            assert!(strip.first as usize + lanes <= self.stiffness.len());
            for corner in strip.corners {
                assert!(corner as usize + lanes <= self.slots);
            }
        }
        assert!(
            self.slot_of
                .iter()
                .all(|&slot| (slot as usize) < self.slots)
        );
    }
}

fn padded(count: u32) -> usize {
    (count as usize).next_multiple_of(MAX_LANES)
}

/// A body whose vertices are nodes of a cubic grid.
struct Lattice<'a> {
    body: &'a Body,
    /// The node `(i, j, k)` of each vertex. The longest axis of the body is `k`, which fills lanes; the
    /// next is `i`, which is cut into slabs.
    nodes: Vec<[i32; 3]>,
    /// Layers of voxels along `i`.
    layers: usize,
    /// The edge of a voxel in m.
    side: f64,
    slot_of: Vec<u32>,
    slots: usize,
    /// Set if the slots are those of a box, so that rows of several layers line up.
    boxed: bool,
}

/// Constraints of one kind, each next to the one before or behind a gap.
struct Row {
    members: Range<usize>,
    count: u32,
}

impl<'a> Lattice<'a> {
    fn of(body: &'a Body) -> Option<Self> {
        let lengths = body.edges().iter().map(|e| e.length);
        let side = lengths.fold(f64::INFINITY, f64::min);
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for p in body.rest() {
            low = std::array::from_fn(|axis| low[axis].min(p[axis]));
            high = std::array::from_fn(|axis| high[axis].max(p[axis]));
        }
        let extent = sub(high, low);
        if extent.iter().any(|&e| !(e / side < MAX_NODES)) {
            return None;
        }
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
        let [k, i, j] = axes;
        let node = |p: &Vec3| {
            let exact = [i, j, k].map(|axis| (p[axis] - low[axis]) / side);
            let node = exact.map(f64::round);
            let off = (0..3).any(|a| (exact[a] - node[a]).abs() > SLACK * exact[a].max(1.0));
            (!off).then(|| node.map(|n| n as i32))
        };
        let nodes: Option<Vec<[i32; 3]>> = body.rest().iter().map(node).collect();
        let nodes = nodes?;
        let counts = [i, j, k].map(|axis| (extent[axis] / side).round() as usize + 1);
        let [part, _] = box_sizes(counts);
        let boxed = body.edges().len() + body.tets().len() <= SLAB_CONSTRAINTS
            && 8 * part <= BOX_SLOTS * nodes.len();
        let (slot_of, slots) = if boxed {
            number_in_box(&nodes, counts)
        } else {
            number(&nodes)
        };
        Some(Self {
            body,
            nodes,
            layers: counts[0] - 1,
            side,
            slot_of,
            slots,
            boxed,
        })
    }

    /// The vertices of a constraint (edges first, then tetrahedra); an edge repeats its first.
    fn vertices(&self, index: usize) -> [u32; 4] {
        match index.checked_sub(self.body.edges().len()) {
            None => {
                let [a, b] = self.body.edges()[index].vertices;
                [a, b, a, a]
            }
            Some(tet) => self.body.tets()[tet].vertices,
        }
    }

    fn corners(&self, index: usize) -> [u32; 4] {
        self.vertices(index)
            .map(|vertex| self.slot_of[vertex as usize])
    }

    fn start(&self, index: usize) -> [i32; 3] {
        self.nodes[self.vertices(index)[0] as usize]
    }

    /// Steps from the first vertex to the others, in nodes.
    fn steps(&self, index: usize) -> [[i32; 3]; 3] {
        let [start, others @ ..] = self.vertices(index).map(|v| self.nodes[v as usize]);
        others.map(|node| std::array::from_fn(|axis| node[axis] - start[axis]))
    }

    /// Key shared by the constraints of one strip: the relative positions of their vertices, and the part of a layer.
    /// `None` for one that is not within a cube, or not unstressed there: it could reach past the neighboring layer.
    fn kind(&self, index: usize) -> Option<u32> {
        let start = self.start(index);
        let is_tet = index >= self.body.edges().len();
        let (mut low, mut high) = ([0; 3], [0; 3]);
        let mut kind = u32::from(is_tet);
        for step in self.steps(index) {
            for axis in 0..3 {
                low[axis] = step[axis].min(low[axis]);
                high[axis] = step[axis].max(high[axis]);
                kind = kind << 2 | (step[axis] + 1) as u32 & 3;
            }
        }
        let within = (0..3).all(|axis| high[axis] - low[axis] <= 1);
        let (value, rest) = match self.rest(index) {
            Kind::Edge(length) => (self.body.edges()[index].length, length),
            Kind::Tet(volume) => (
                self.body.tets()[index - self.body.edges().len()].volume,
                volume,
            ),
        };
        let unstressed = (value / rest - 1.0).abs() < SLACK;
        let parity = ((start[0] & 1) << 2 | (start[1] & 1) << 1 | start[2] & 1) as u32;
        (within && unstressed).then_some(kind << 3 | parity)
    }

    /// The length of an edge in m or the volume of a tetrahedron in m³, from its nodes.
    fn rest(&self, index: usize) -> Kind {
        let [u, v, w] = self.steps(index);
        if index < self.body.edges().len() {
            let square: i32 = u.iter().map(|d| d * d).sum();
            return Kind::Edge(self.side * f64::from(square).sqrt());
        }
        let across = [
            v[1] * w[2] - v[2] * w[1],
            v[2] * w[0] - v[0] * w[2],
            v[0] * w[1] - v[1] * w[0],
        ];
        // The order of the axes may be left-handed, so the sign carries no information.
        let six_volumes = (0..3).map(|axis| u[axis] * across[axis]).sum::<i32>().abs();
        Kind::Tet(self.side.powi(3) / 6.0 * f64::from(six_volumes))
    }

    /// The layer of voxels along `i`.
    fn layer(&self, index: usize) -> usize {
        let low = self
            .steps(index)
            .map(|step| step[0])
            .into_iter()
            .fold(0, i32::min);
        (self.start(index)[0] + low) as usize
    }

    /// The pair of rows of nodes that a constraint starts in.
    fn pair(&self, index: usize) -> i32 {
        self.start(index)[1] >> 1
    }

    fn rows(&self, found: &[(u64, u32)]) -> Vec<Row> {
        let mut rows: Vec<Row> = Vec::new();
        let (mut kind, mut start) = (0, [0; 4]);
        for (at, &(key, index)) in found.iter().enumerate() {
            let corners = self.corners(index as usize);
            if let Some(row) = rows.last_mut() {
                let offset = corners[0].wrapping_sub(start[0]);
                let aligned = (0..4).all(|c| corners[c] == start[c].wrapping_add(offset));
                // A gap within the lanes that are open anyway costs nothing; behind a gap that reaches past them a
                // strip of its own wastes none.
                let worth =
                    offset == row.count || offset < row.count.next_multiple_of(MAX_LANES as u32);
                if key >> 32 == kind && aligned && worth && offset < MAX_COUNT {
                    row.members.end = at + 1;
                    row.count = offset + 1;
                    continue;
                }
            }
            (kind, start) = (key >> 32, corners);
            rows.push(Row {
                members: at..at + 1,
                count: 1,
            });
        }
        rows
    }
}

/// The number of places for nodes that are even along all axes in a box of so many nodes, and of the slots of the box.
fn box_sizes(counts: [usize; 3]) -> [usize; 2] {
    let part = counts.map(|n| n.div_ceil(2)).iter().product::<usize>();
    [part, 8 * (part + MAX_LANES - 1)]
}

/// The slot of each node of a small body, and the number of slots.
///
/// Nodes of one parity along each axis make a part, where each has the place of its cell of two nodes along
/// each axis. Constraints of a kind then line up all over the body, and fill lanes also where the body is
/// round or hollow.
fn number_in_box(nodes: &[[i32; 3]], counts: [usize; 3]) -> (Vec<u32>, usize) {
    let [part, slots] = box_sizes(counts);
    let [_, columns, places] = counts.map(|n| n.div_ceil(2));
    let slot = |&[i, j, k]: &[i32; 3]| {
        let parity = ((i & 1) << 2 | (j & 1) << 1 | k & 1) as usize;
        let [i, j, k] = [i, j, k].map(|n| (n >> 1) as usize);
        (parity * (part + MAX_LANES - 1) + (i * columns + j) * places + k) as u32
    };
    let slot_of = nodes.iter().map(slot).collect();
    (slot_of, slots.next_multiple_of(MAX_LANES))
}

/// The slot of each node, and the number of slots.
///
/// A row of nodes keeps its places for even `k` and for odd `k` in step: node `(i, j, 2m)` and node `(i, j, 2m + 1)`
/// have the same place within their parts of the layer, used or not. A part ends with slots for lanes past its end, so
/// that these never hold vertices that another corner of their batch moves.
fn number(nodes: &[[i32; 3]]) -> (Vec<u32>, usize) {
    let key = |&[i, j, k]: &[i32; 3]| {
        let [i, j, m] = [i, j, k >> 1].map(|n| n as u64);
        (i << 41 | (j & 1) << 40 | j >> 1 << 20 | m, (k & 1) as u32)
    };
    let mut sorted: Vec<(u64, u32, u32)> = nodes
        .iter()
        .enumerate()
        .map(|(vertex, node)| (key(node).0, key(node).1, vertex as u32))
        .collect();
    sorted.sort_unstable();
    let mut slot_of = vec![0; nodes.len()];
    let mut slots = 0;
    for layer in sorted.chunk_by(|a, b| a.0 >> 41 == b.0 >> 41) {
        for rows in layer.chunk_by(|a, b| a.0 >> 40 == b.0 >> 40) {
            let pairs = || rows.chunk_by(|a, b| a.0 == b.0);
            let part = pairs().count() + MAX_LANES - 1;
            for (place, pair) in pairs().enumerate() {
                for &(_, odd, vertex) in pair {
                    slot_of[vertex as usize] = (slots + place + odd as usize * part) as u32;
                }
            }
            slots += 2 * part;
        }
    }
    (slot_of, slots.next_multiple_of(MAX_LANES))
}
