//! Constraints of voxels, laid out for SIMD processors, which evaluate several at once.
//!
//! All voxels are equal cubes, so constraints repeat along the grid. A [`Strip`] is a row of like
//! constraints (the same edge of every second voxel, the same tetrahedron of every second voxel) whose
//! vertices lie side by side in memory: corner `c` of its constraint `n` is in the slot `corners[c] + n`.
//! A processor with four or eight lanes takes as many constraints with plain loads, without an index.
//!
//! # Slots
//!
//! Nodes of the grid are sorted by `(i, j mod 2, k mod 2, j, k)`, with `k` along the body's longest axis. The split
//! into five tetrahedra repeats every second voxel, and so do the corners of a kind: all even nodes of a row come
//! first, then all odd ones. Neighboring rows with the same ends follow each other without a break, so that short rows
//! of a block still fill the lanes. Constraints of one strip share no vertex: corners of a constraint differ in
//! `(i, j mod 2, k mod 2)`, or two constraints would hold the same slot.
//!
//! A small body has all nodes of one parity along each axis in a box instead, as many as it would have
//! if it filled its bounds, so that strips run on over rows and layers of any length.
//!
//! A gap of a strip within its lanes (the end of a row, a missing voxel), or at its end where it does not fill the last
//! lanes, is filled by a constraint without stiffness, which moves nothing.
//!
//! # Slabs
//!
//! A large body is cut along `i` into slabs of at least two layers of voxels, whatever the number of
//! threads. Slabs of even number share no slot and may run side by side, then those of odd number.
//! Within a slab strips run one after the other. So the bits do not depend on the threads.

mod build;
mod columns;
mod kernels;
mod slabs;
mod sweep;

pub use columns::Columns;
pub use sweep::Sweep;

use std::ops::Range;

use crate::vector::Vec3;

/// The most lanes of any processor: strips are padded to a multiple, lists of slots by one less.
pub(crate) const MAX_LANES: usize = 8;

/// A row of like constraints.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Strip {
    /// The slots of the corners of the first constraint; an edge has two.
    corners: [u32; 4],
    /// The place of the first constraint in the lists of stiffness and multipliers.
    first: u32,
    /// The number of constraints, with those that fill gaps.
    count: u32,
    kind: Kind,
}

/// Kind of the constraints of a strip, with their common rest value.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// `|x_a − x_b| − ℓ`, with the rest length `ℓ` in m.
    Edge(f64),
    /// `V − V₀`, with the rest volume `V₀` in m³.
    Tet(f64),
}

/// All constraints of a body of voxels in strips.
#[derive(Debug, Clone)]
pub struct Strips {
    /// The slot of each vertex.
    slot_of: Vec<u32>,
    slots: usize,
    strips: Vec<Strip>,
    /// The strips of each slab.
    slabs: Vec<Range<usize>>,
    /// Stiffness of each place, N/m for edges, Pa/m³ for volumes; zero where a gap is filled.
    stiffness: Vec<f64>,
    /// The constraint of the body in each place: an index into the edges, or the number of edges plus
    /// one into the tetrahedra; `u32::MAX` where a gap is filled.
    constraint: Vec<u32>,
    arch: pulp::Arch,
}

impl Strips {
    /// The number of slots: vertices and padding.
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// These constraints evaluated one at a time with plain multiplications and additions: the same bits on every
    /// processor, WebAssembly included, a few times slower where there are lanes.
    #[must_use]
    pub fn deterministic(mut self) -> Self {
        self.arch = pulp::Arch::Scalar;
        self
    }

    /// The slot of each vertex.
    pub fn slot_of(&self) -> &[u32] {
        &self.slot_of
    }

    /// The number of places for constraints, with those that fill gaps: the length of a list of
    /// multipliers.
    pub fn places(&self) -> usize {
        self.stiffness.len()
    }

    /// The constraints of the body in the order in which a sweep takes them: an index into its edges, or
    /// the number of edges plus one into its tetrahedra.
    pub fn order(&self) -> impl Iterator<Item = usize> + '_ {
        let runs = slabs::turns(&self.slabs).flat_map(|slab| self.slabs[slab].clone());
        runs.flat_map(move |strip| {
            let strip = &self.strips[strip];
            self.constraint[strip.first as usize..][..strip.count as usize].iter()
        })
        .filter(|&&index| index != u32::MAX)
        .map(|&index| index as usize)
    }

    /// Puts the vectors of vertices into their slots, and zero into the others: values left there by a run that blew up
    /// would spoil the constraints without stiffness.
    pub fn load(&self, rows: &[Vec3], columns: &mut Columns) {
        columns.clear();
        for (&slot, row) in self.slot_of.iter().zip(rows) {
            columns.set(slot, *row);
        }
    }

    /// Takes the vectors of vertices out of their slots.
    pub fn store(&self, columns: &Columns, rows: &mut [Vec3]) {
        for (&slot, row) in self.slot_of.iter().zip(rows) {
            *row = columns.get(slot);
        }
    }

    /// Puts a number for each vertex into its slot; the others keep theirs.
    pub fn load_scalars(&self, values: &[f64], column: &mut [f64]) {
        for (&slot, value) in self.slot_of.iter().zip(values) {
            column[slot as usize] = *value;
        }
    }

    /// Takes a number for each vertex out of its slot.
    pub fn store_scalars(&self, column: &[f64], values: &mut [f64]) {
        for (&slot, value) in self.slot_of.iter().zip(values) {
            *value = column[slot as usize];
        }
    }
}
