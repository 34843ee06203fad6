//! Coarsest level, solved by a sparse Cholesky factor.
//!
//! A level whose cells are larger than the walls and chambers of a body knows little of how it bends, and such a level
//! is where conjugate gradients lose most iterations. The first level that a factor can afford is fine enough: its
//! cells are as many as the body's shape needs, not its voxels, so that a finer grid does not make the factor larger.

use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use voxsoft_solid::vector::Vec3;

use super::blocks::BlockMatrix;
use super::cells::{Cell, places_of};
use super::values::Block;
use crate::linear::ordering::nested_dissection;
use crate::linear::sparse_cholesky;

/// Size of a factor: numbers, and multiplications to find them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Budget {
    pub entries: usize,
    pub products: f64,
}

impl Budget {
    /// A factor that costs little beside the sweeps on the finest level of `nodes` nodes: for an iteration a tenth of
    /// their memory, and once the work of some of them.
    pub fn beside(nodes: usize) -> Self {
        Self {
            entries: (30 * nodes).max(100_000),
            products: (6_000.0 * nodes as f64).max(2e7),
        }
    }

    /// A factor of 0.3 GB, for a level that cannot be coarsened.
    pub const LARGEST: Self = Self {
        entries: 40_000_000,
        products: 1e11,
    };
}

/// Least entries of a factor for each entry of the lower triangle of a matrix: one beyond the budget by this
/// measure is not analyzed.
const FILL: usize = 3;

/// Pattern of the factor, and the factor of the matrix that was last taken.
pub(crate) struct Coarsest {
    symbolic: SymbolicCholesky<usize>,
    column_starts: Vec<usize>,
    row_indices: Vec<usize>,
    /// Place of each node in the order of elimination, and the nodes in that order.
    places: Vec<u32>,
    order: Vec<u32>,
    entries: Option<Vec<f64>>,
}

impl Coarsest {
    /// Analyzes a level with these cells and rows of rigid objects; `None` if its factor is beyond the budget.
    pub fn new(
        cells: &[Cell],
        objects: &[u32],
        matrix: &BlockMatrix,
        budget: Budget,
    ) -> Option<Self> {
        if FILL * 9 * matrix.blocks() / 2 > budget.entries {
            return None;
        }
        let count = matrix.rows();
        let points: Vec<Vec3> = places_of(cells, count);
        let neighbors: Vec<Vec<u32>> = (0..count)
            .map(|row| matrix.columns(row).collect())
            .collect();
        let mut is_last = vec![false; count];
        objects.iter().for_each(|&row| is_last[row as usize] = true);
        let order = nested_dissection(&points, &neighbors, &is_last);
        let mut places = vec![0u32; count];
        for (place, &node) in order.iter().enumerate() {
            places[node as usize] = place as u32;
        }
        let mut column_starts = vec![0];
        let mut row_indices = Vec::with_capacity(9 * matrix.blocks());
        for &node in &order {
            let mut row: Vec<u32> = (matrix.columns(node as usize))
                .map(|column| places[column as usize])
                .collect();
            row.sort_unstable();
            for _ in 0..3 {
                row_indices
                    .extend((row.iter()).flat_map(|&p| (0..3).map(move |i| 3 * p as usize + i)));
                column_starts.push(row_indices.len());
            }
        }
        let size = 3 * count;
        let pattern =
            SymbolicSparseColMatRef::new_checked(size, size, &column_starts, None, &row_indices);
        let symbolic = sparse_cholesky::analyze(pattern).ok()?;
        let affordable =
            symbolic.len_val() <= budget.entries && products(&symbolic) <= budget.products;
        affordable.then_some(Self {
            symbolic,
            column_starts,
            row_indices,
            places,
            order,
            entries: None,
        })
    }

    /// Factorizes a matrix, with its diagonal shifted as far as necessary.
    pub fn take(&mut self, matrix: &BlockMatrix) {
        let mut values = vec![0.0; self.row_indices.len()];
        let mut diagonal = Vec::with_capacity(3 * self.order.len());
        for (place, &node) in self.order.iter().enumerate() {
            // Symmetric: the column of a node is its row. Neighbors by their places, which order the rows.
            let mut row: Vec<(u32, Block)> = (matrix.row(node as usize))
                .map(|(column, block)| (self.places[column as usize], block))
                .collect();
            row.sort_unstable_by_key(|&(neighbor, _)| neighbor);
            for (rank, &(neighbor, block)) in row.iter().enumerate() {
                for j in 0..3 {
                    let first = self.column_starts[3 * place + j] + 3 * rank;
                    for i in 0..3 {
                        values[first + i] = block[3 * j + i];
                    }
                    if neighbor as usize == place {
                        diagonal.push(first + j);
                        // Coordinates without stiffness stay in place.
                        if !(values[first + j] > 0.0) {
                            values[first + j] = 1.0;
                        }
                    }
                }
            }
        }
        let pattern = SymbolicSparseColMatRef::new_checked(
            3 * self.order.len(),
            3 * self.order.len(),
            &self.column_starts,
            None,
            &self.row_indices,
        );
        // Corners with few fine nodes can be linearly dependent; rounding decides their sign.
        let factor = |lift: f64| {
            let mut lifted = values.clone();
            diagonal.iter().for_each(|&at| lifted[at] *= 1.0 + lift);
            sparse_cholesky::factorize(&self.symbolic, SparseColMatRef::new(pattern, &lifted)).ok()
        };
        let lifts = [1e-13, 1e-10, 1e-7, 1e-4, 1e-2, 1.0];
        self.entries = lifts.into_iter().find_map(factor);
    }

    /// Solves in place; false if the matrix has no factor. `flat` is a buffer.
    pub fn solve(&self, x: &mut [Vec3], flat: &mut Vec<f64>) -> bool {
        let Some(entries) = &self.entries else {
            return false;
        };
        flat.clear();
        flat.extend(self.order.iter().flat_map(|&node| x[node as usize]));
        sparse_cholesky::solve(&self.symbolic, entries, flat);
        let (vectors, _) = flat.as_chunks::<3>();
        for (&node, vector) in self.order.iter().zip(vectors) {
            x[node as usize] = *vector;
        }
        true
    }
}

/// Multiplications of a factorization: the squares of the entries of its columns.
fn products(symbolic: &SymbolicCholesky<usize>) -> f64 {
    let square = |entries: usize| (entries as f64).powi(2);
    match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(symbolic) => {
            let columns = symbolic.col_ptr().windows(2);
            columns.map(|ends| square(ends[1] - ends[0])).sum()
        }
        SymbolicCholeskyRaw::Supernodal(symbolic) => (0..symbolic.n_supernodes())
            .map(|block| {
                let columns = symbolic.supernode_end()[block] - symbolic.supernode_begin()[block];
                let below = symbolic.supernode(block).pattern().len();
                (1..=columns).map(|k| square(k + below)).sum::<f64>()
            })
            .sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chain of nodes with springs of blocks between neighbors, held at its first; the z of its last has no stiffness.
    fn chain(count: usize) -> (Vec<Cell>, BlockMatrix) {
        let cell = |k: usize| Cell {
            at: [k as i32, 0, 0],
            nodes: std::array::from_fn(|corner| (k + (corner >> 2)) as u32),
        };
        let cells = (0..count - 1).map(cell).collect();
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for row in 0..count {
            columns.extend((row.saturating_sub(1)..(row + 2).min(count)).map(|c| c as u32));
            starts.push(columns.len());
        }
        let mut matrix = BlockMatrix::with_pattern(&starts, &columns);
        let spring = [2.0, 0.5, 0.1, 0.5, 1.0, 0.2, 0.1, 0.2, 3.0];
        let (mut parts, halves) = matrix.parts(std::iter::once(0..count));
        let part = &mut parts[0];
        for ((starts, columns), half) in halves.into_iter().zip([&mut part.lower, &mut part.upper])
        {
            for row in 0..count {
                for place in starts[row]..starts[row + 1] {
                    let column = columns[place] as usize;
                    let ends = if row == count - 1 { 1.0 } else { 2.0 };
                    let factor = if column == row { ends } else { -1.0 };
                    let mut block = spring.map(|k| factor * k);
                    let loose = |node: usize, axis: usize| node == count - 1 && axis == 2;
                    for k in 0..9 {
                        if loose(row, k / 3) || loose(column, k % 3) {
                            block[k] = 0.0;
                        }
                    }
                    half.set(place, &block);
                }
            }
        }
        (cells, matrix)
    }

    #[test]
    fn solves_and_keeps_loose_coordinates_apart() {
        let (cells, matrix) = chain(40);
        let mut coarsest = Coarsest::new(&cells, &[], &matrix, Budget::beside(0)).expect("small");
        coarsest.take(&matrix);
        let x: Vec<Vec3> = (0..40)
            .map(|k| [1.0, -0.5, if k == 39 { 0.0 } else { 0.1 * k as f64 }])
            .collect();
        let mut y = vec![[0.0; 3]; 40];
        matrix.multiply(&x, &mut y);
        assert!(coarsest.solve(&mut y, &mut Vec::new()));
        for (x, y) in x.iter().zip(&y) {
            for axis in 0..3 {
                // The condition number of the chain, some thousand, times the first shift of the diagonal.
                assert!((x[axis] - y[axis]).abs() < 1e-8, "{x:?} {y:?}");
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_is_shifted_to_a_positive_one() {
        let (cells, mut matrix) = chain(40);
        let place = matrix.diagonal_place(20);
        // Below half of the stiffness of the two springs.
        matrix.upper.values.scale(place, 0, 0, 0.4);
        let mut coarsest = Coarsest::new(&cells, &[], &matrix, Budget::beside(0)).expect("small");
        coarsest.take(&matrix);
        let side: Vec<Vec3> = (0..40).map(|k| [f64::from(k == 20), 0.0, 0.0]).collect();
        let mut answer = side.clone();
        assert!(coarsest.solve(&mut answer, &mut Vec::new()));
        assert!(answer[20][0] > 0.0);
    }

    #[test]
    fn a_budget_is_kept() {
        let (cells, matrix) = chain(40);
        let symbolic = Coarsest::new(&cells, &[], &matrix, Budget::LARGEST)
            .expect("small")
            .symbolic;
        let exact = Budget {
            entries: symbolic.len_val().max(FILL * 9 * matrix.blocks() / 2),
            products: products(&symbolic),
        };
        assert!(Coarsest::new(&cells, &[], &matrix, exact).is_some());
        for less in [
            Budget {
                entries: symbolic.len_val() - 1,
                ..exact
            },
            Budget {
                products: 0.99 * exact.products,
                ..exact
            },
        ] {
            assert!(
                Coarsest::new(&cells, &[], &matrix, less).is_none(),
                "{less:?}"
            );
        }
    }
}
