//! Addition of element matrices to the rows of a matrix.

use pulp::NullaryFnOnce;
use voxsoft_solid::assembly::Elements;

use super::multigrid::{Columns, RowsPart, columns_of};
use super::rank::rank;

/// Sum of elements on the rows of a part of a matrix, each in the order of the elements. Rows and columns of held
/// coordinates stay zero.
pub(crate) struct Scatter<'a, 'm> {
    pub elements: Elements<'a>,
    /// Row of each vertex.
    pub places: &'a [u32],
    pub held: &'a [[bool; 3]],
    /// Columns of both halves of the matrix.
    pub columns: [Columns<'a>; 2],
    pub part: &'a mut RowsPart<'m>,
}

/// Three rows of an element matrix: the vertices of the element, the place of theirs, and their numbers.
#[derive(Clone, Copy)]
struct Rows<'a> {
    vertices: &'a [u32],
    place: usize,
    entries: &'a [f64],
}

/// Place of a block: the half, and the place in it.
type Slot = (bool, usize);

impl NullaryFnOnce for Scatter<'_, '_> {
    type Output = ();

    /// Finds and fetches the blocks of a vertex before it adds to those of the one before: memory is most of the time.
    #[inline(always)]
    fn call(mut self) {
        let [mut slots, mut next] = [vec![(false, 0); self.elements.width], Vec::new()];
        next.clone_from(&slots);
        let mut waiting: Option<Rows<'_>> = None;
        for (vertices, entries) in self.elements.iter() {
            for (place, &vertex) in vertices.iter().enumerate() {
                let row = self.places[vertex as usize] as usize;
                if !self.part.rows.contains(&row) {
                    continue;
                }
                self.find(row, vertices, &mut next);
                if let Some(rows) = waiting {
                    self.add(rows, &slots);
                }
                let count = 9 * vertices.len();
                waiting = Some(Rows {
                    vertices,
                    place,
                    entries: &entries[place * count..(place + 1) * count],
                });
                std::mem::swap(&mut slots, &mut next);
            }
        }
        if let Some(rows) = waiting {
            self.add(rows, &slots);
        }
    }
}

impl Scatter<'_, '_> {
    /// Finds the blocks of a row at the columns of `vertices`, and starts to fetch them.
    #[inline(always)]
    fn find(&self, row: usize, vertices: &[u32], slots: &mut [Slot]) {
        let own = self.columns.map(|half| columns_of(half, row));
        let first = self
            .columns
            .map(|(starts, _)| starts[row] - starts[self.part.rows.start]);
        for (slot, &vertex) in slots.iter_mut().zip(vertices) {
            let column = self.places[vertex as usize];
            let after = column as usize >= row;
            let half = usize::from(after);
            *slot = (after, first[half] + rank(own[half], column));
            let blocks = if after {
                &self.part.upper
            } else {
                &self.part.lower
            };
            blocks.fetch(slot.1);
        }
    }

    #[inline(always)]
    fn add(&mut self, rows: Rows<'_>, slots: &[Slot]) {
        let width = 3 * rows.vertices.len();
        let fixed = self.held[rows.vertices[rows.place] as usize];
        for (b, (&other, &(after, slot))) in rows.vertices.iter().zip(slots).enumerate() {
            let mut block = [0.0; 9];
            for i in 0..3 {
                let entries = &rows.entries[i * width + 3 * b..][..3];
                block[3 * i..3 * i + 3].copy_from_slice(entries);
            }
            let across = self.held[other as usize];
            if fixed != [false; 3] || across != [false; 3] {
                for (k, entry) in block.iter_mut().enumerate() {
                    if fixed[k / 3] || across[k % 3] {
                        *entry = 0.0;
                    }
                }
            }
            let blocks = if after {
                &mut self.part.upper
            } else {
                &mut self.part.lower
            };
            blocks.add(slot, &block);
        }
    }
}
