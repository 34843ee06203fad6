//! Element matrices handed to visitors before assembly, and operations on them.

use crate::ProblemError;
use crate::vector::Vec3;

/// Takes element matrices one by one: the vertices of an element, and its dense row-major matrix with rows
/// and columns `3 place + axis`.
pub type Visitor<'a> = &'a mut dyn FnMut(&[u32], &[f64]);

/// Matrices of elements with the same number of vertices.
#[derive(Clone, Copy)]
pub struct Elements<'a> {
    /// Number of vertices of each element.
    pub width: usize,
    /// The vertices of one element after the other.
    pub vertices: &'a [u32],
    /// Their matrices, as a [`Visitor`] gets them.
    pub matrices: &'a [f64],
}

/// Takes element matrices many at a time, so that it can work on them on all threads.
pub type ElementsVisitor<'a> = &'a mut dyn FnMut(Elements<'_>);

impl<'a> Elements<'a> {
    /// Iterates over the elements: vertices and matrix of each.
    pub fn iter(self) -> impl Iterator<Item = (&'a [u32], &'a [f64])> {
        let matrices = self.matrices.chunks(9 * self.width * self.width);
        self.vertices.chunks(self.width).zip(matrices)
    }
}

/// Adds the product of one element matrix with `direction`.
pub(crate) fn add_product(
    vertices: &[u32],
    matrix: &[f64],
    direction: &[Vec3],
    product: &mut [Vec3],
) {
    for (row, entries) in matrix.chunks(3 * vertices.len()).enumerate() {
        let mut sum = 0.0;
        for (column, k) in entries.iter().enumerate() {
            sum += k * direction[vertices[column / 3] as usize][column % 3];
        }
        product[vertices[row / 3] as usize][row % 3] += sum;
    }
}

/// Adds, for each vertex of one element matrix, the largest of its three row sums of absolute values.
pub(crate) fn add_row_sums(vertices: &[u32], matrix: &[f64], sums: &mut [f64]) {
    let size = 3 * vertices.len();
    for (place, vertex) in vertices.iter().enumerate() {
        let rows = matrix[3 * place * size..].chunks(size).take(3);
        let largest = rows
            .map(|row| row.iter().map(|k| k.abs()).sum())
            .fold(0.0, f64::max);
        sums[*vertex as usize] += largest;
    }
}

/// Refuses indices of vertices that do not exist.
pub(crate) fn check_indices(
    what: &'static str,
    vertices: &[u32],
    count: usize,
) -> Result<(), ProblemError> {
    match vertices.iter().find(|&&vertex| vertex as usize >= count) {
        Some(&index) => Err(ProblemError::Index {
            what,
            index: index as usize,
            count,
        }),
        None => Ok(()),
    }
}
