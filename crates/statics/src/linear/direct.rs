//! Direct sparse solver: numbering of free coordinates, assembly of the tangent, Cholesky or LU factors.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::prelude::*;
use faer::sparse::linalg::cholesky::{LdltRef, SymbolicCholesky, SymbolicCholeskyRaw};
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use voxsoft_solid::element::assumed_strain::AssumedStrains;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Body, Load, Problem, elastic};

use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;
use crate::linear::ordering::nested_dissection;
use crate::linear::rank::rank;
use crate::linear::sparse_cholesky;

/// Row of a held coordinate.
const HELD: u32 = u32::MAX;

/// Tangent of a problem on its free coordinates, kept with its sparsity pattern for many assemblies.
///
/// Everything runs on one thread, so that the same input gives the same bits.
pub(crate) struct DirectSystem {
    /// Row of each coordinate `3 vertex + axis`, or [`HELD`].
    rows: Vec<u32>,
    size: usize,
    column_starts: Vec<usize>,
    row_indices: Vec<usize>,
    /// Neighbors of each vertex in rising order, and the offsets of their rows in a column.
    neighbors: Vec<Vec<u32>>,
    offsets: Vec<Vec<u32>>,
    values: Vec<f64>,
    symbolic: Option<SymbolicCholesky<usize>>,
    symbolic_lu: Option<SymbolicLu<usize>>,
    symmetric: bool,
}

/// Factorized tangent.
pub(crate) enum DirectFactor {
    /// Positive definite: the state is stable.
    Cholesky(Vec<f64>),
    /// Symmetric and indefinite.
    Indefinite(Vec<f64>),
    /// Not symmetric.
    General(Box<Lu<usize, f64>>),
}

impl DirectSystem {
    /// Sparsity pattern of a problem whose coordinates `held` do not move.
    pub fn new(
        problem: &Problem,
        held: &[[bool; 3]],
        options: LinearOptions,
    ) -> Result<Self, FactorError> {
        Self::with_symmetry(problem, held, options, problem.is_conservative())
    }

    /// Sparsity pattern for a tangent that the caller declares as symmetric or not.
    pub fn with_symmetry(
        problem: &Problem,
        held: &[[bool; 3]],
        options: LinearOptions,
        symmetric: bool,
    ) -> Result<Self, FactorError> {
        let body = problem.body();
        let count = body.rest().len();
        let neighbors = adjacency(problem, count);
        let order = nested_dissection(body.rest(), &neighbors, &of_no_element(body));
        let mut rows = vec![HELD; 3 * count];
        let mut size = 0;
        for &vertex in &order {
            for axis in 0..3 {
                if !held[vertex as usize][axis] {
                    rows[3 * vertex as usize + axis] = size;
                    size += 1;
                }
            }
        }
        let size = size as usize;
        let free = |vertex: u32| {
            let first = 3 * vertex as usize;
            rows[first..first + 3]
                .iter()
                .copied()
                .filter(|&row| row != HELD)
        };
        // Neighbors in the order of elimination, so that rows rise within a column.
        let mut place = vec![0u32; count];
        for (index, &vertex) in order.iter().enumerate() {
            place[vertex as usize] = index as u32;
        }
        let mut neighbors = neighbors;
        for list in &mut neighbors {
            list.sort_unstable_by_key(|&v| place[v as usize]);
        }
        let mut column_starts = vec![0; size + 1];
        let mut row_indices = Vec::new();
        let mut offsets = vec![Vec::new(); count];
        for &vertex in &order {
            let list = &neighbors[vertex as usize];
            let mut at = 0u32;
            for &neighbor in list {
                offsets[vertex as usize].push(at);
                at += free(neighbor).count() as u32;
            }
            for column in free(vertex) {
                row_indices.extend(list.iter().flat_map(|&n| free(n)).map(|row| row as usize));
                column_starts[column as usize + 1] = row_indices.len();
            }
        }
        // Neighbors are looked up by number from here on.
        for (list, offsets) in neighbors.iter_mut().zip(&mut offsets) {
            let mut both: Vec<(u32, u32)> =
                list.iter().copied().zip(offsets.iter().copied()).collect();
            both.sort_unstable();
            *list = both.iter().map(|&(vertex, _)| vertex).collect();
            *offsets = both.iter().map(|&(_, offset)| offset).collect();
        }
        let mut system = Self {
            rows,
            size,
            values: vec![0.0; row_indices.len()],
            column_starts,
            row_indices,
            neighbors,
            offsets,
            symbolic: None,
            symbolic_lu: None,
            symmetric,
        };
        if system.symmetric {
            let symbolic = sparse_cholesky::analyze(system.pattern())?;
            options.allow(symbolic.len_val() as u64 * size_of::<f64>() as u64)?;
            system.symbolic = Some(symbolic);
        } else {
            let symbolic =
                SymbolicLu::try_new(system.pattern()).map_err(|_| FactorError::Memory(0))?;
            system.symbolic_lu = Some(symbolic);
        }
        Ok(system)
    }

    /// Number of free coordinates.
    pub fn size(&self) -> usize {
        self.size
    }

    fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(
            self.size,
            self.size,
            &self.column_starts,
            None,
            &self.row_indices,
        )
    }

    fn matrix<'a>(&'a self, values: &'a [f64]) -> SparseColMatRef<'a, usize, f64> {
        SparseColMatRef::new(self.pattern(), values)
    }

    /// Assembles the tangent at `positions` with a factor for each load, and with `strains`, if given, in place of
    /// those at `positions`; if the held coordinates are about to move by `jump`, subtracts the resulting force from
    /// `residual`.
    pub fn assemble(
        &mut self,
        problem: &Problem,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        strains: Option<&AssumedStrains>,
        jump: Option<&[Vec3]>,
        residual: &mut [f64],
    ) {
        self.assemble_pieces(jump, residual, |add| {
            match strains {
                Some(strains) => {
                    strains.visit_elements(problem.body(), positions, &mut |elements| {
                        elements
                            .iter()
                            .for_each(|(vertices, matrix)| add(vertices, matrix));
                    })
                }
                None => elastic::visit_stiffness(problem.body(), positions, add),
            }
            problem.visit_load_stiffness(positions, factor_of, add);
        });
    }

    /// Assembles element matrices that `visit` passes on, see [`elastic::visit_stiffness`].
    pub fn assemble_pieces(
        &mut self,
        jump: Option<&[Vec3]>,
        residual: &mut [f64],
        visit: impl FnOnce(&mut dyn FnMut(&[u32], &[f64])),
    ) {
        let Self {
            rows,
            column_starts,
            neighbors,
            offsets,
            values,
            ..
        } = self;
        values.fill(0.0);
        let mut add = |vertices: &[u32], matrix: &[f64]| {
            let width = 3 * vertices.len();
            for (b, &column_vertex) in vertices.iter().enumerate() {
                let first_column = 3 * column_vertex as usize;
                let list = &neighbors[column_vertex as usize];
                let columns = [0, 1, 2].map(|j| rows[first_column + j]);
                for (a, &row_vertex) in vertices.iter().enumerate() {
                    let first_row = 3 * row_vertex as usize;
                    let place = rank(list, row_vertex);
                    let offset = offsets[column_vertex as usize][place] as usize;
                    let free = rows[first_row..first_row + 3]
                        .iter()
                        .all(|&row| row != HELD);
                    if free && columns.iter().all(|&column| column != HELD) {
                        for j in 0..3 {
                            let start = column_starts[columns[j] as usize] + offset;
                            let column = &mut values[start..start + 3];
                            for i in 0..3 {
                                column[i] += matrix[(3 * a + i) * width + 3 * b + j];
                            }
                        }
                        continue;
                    }
                    for j in 0..3 {
                        let column = rows[first_column + j];
                        if column == HELD {
                            if let Some(jump) = jump {
                                let moved = jump[column_vertex as usize][j];
                                for i in 0..3 {
                                    let row = rows[first_row + i];
                                    if row != HELD {
                                        let k = matrix[(3 * a + i) * width + 3 * b + j];
                                        residual[row as usize] -= k * moved;
                                    }
                                }
                            }
                            continue;
                        }
                        let start = column_starts[column as usize] + offset;
                        let mut rank = 0;
                        for i in 0..3 {
                            if rows[first_row + i] != HELD {
                                values[start + rank] += matrix[(3 * a + i) * width + 3 * b + j];
                                rank += 1;
                            }
                        }
                    }
                }
            }
        };
        visit(&mut add);
    }

    /// Cholesky factor of the assembled tangent plus a diagonal, on free coordinates, if the sum is positive definite.
    pub fn factor_lifted(&self, diagonal: &[f64]) -> Result<DirectFactor, FactorError> {
        let mut values = self.values.clone();
        for (column, lift) in diagonal.iter().enumerate() {
            let entries = self.column_starts[column]..self.column_starts[column + 1];
            let place = self.row_indices[entries.clone()].partition_point(|&row| row < column);
            values[entries.start + place] += lift;
        }
        if !values.iter().all(|v| v.is_finite()) {
            return Err(FactorError::Singular);
        }
        let symbolic = self.symbolic.as_ref().ok_or(FactorError::Singular)?;
        self.cholesky(symbolic, &values)
    }

    fn cholesky(
        &self,
        symbolic: &SymbolicCholesky<usize>,
        values: &[f64],
    ) -> Result<DirectFactor, FactorError> {
        let entries = sparse_cholesky::factorize(symbolic, self.matrix(values))?;
        Ok(DirectFactor::Cholesky(entries))
    }

    /// Number of entries of a Cholesky factor; zero for an unsymmetric tangent.
    pub fn factor_entries(&self) -> usize {
        self.symbolic.as_ref().map_or(0, SymbolicCholesky::len_val)
    }

    /// Row of a coordinate, if it is free.
    pub fn row_of(&self, vertex: usize, axis: usize) -> Option<usize> {
        let row = self.rows[3 * vertex + axis];
        (row != HELD).then_some(row as usize)
    }

    /// Factorizes the assembled tangent plus `shift` times its diagonal.
    pub fn factor(&self, shift: f64, positive: bool) -> Result<DirectFactor, FactorError> {
        if !self.values.iter().all(|v| v.is_finite()) {
            return Err(FactorError::Singular);
        }
        let shifted;
        let values = if shift > 0.0 {
            shifted = self.shifted(shift);
            &shifted
        } else {
            &self.values
        };
        let matrix = self.matrix(values);
        let Some(symbolic) = &self.symbolic else {
            let symbolic = self.symbolic_lu.clone().ok_or(FactorError::Singular)?;
            let lu =
                Lu::try_new_with_symbolic(symbolic, matrix).map_err(|_| FactorError::Singular)?;
            return Ok(DirectFactor::General(Box::new(lu)));
        };
        if positive {
            return self.cholesky(symbolic, values);
        }
        let mut entries = vec![0.0; symbolic.len_val()];
        let par = Par::Seq;
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(par, Default::default());
        let mut buffer = MemBuffer::try_new(scratch).map_err(|_| FactorError::Memory(0))?;
        symbolic
            .factorize_numeric_ldlt::<f64>(
                &mut entries,
                matrix,
                Side::Lower,
                Default::default(),
                par,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|_| FactorError::Singular)?;
        Ok(DirectFactor::Indefinite(entries))
    }

    /// Number of negative eigenvalues of the factorized matrix, equal to that of negative pivots (Sylvester's law of
    /// inertia). `None` if it is not symmetric.
    pub fn negative_pivots(&self, factor: &DirectFactor) -> Option<usize> {
        let entries = match factor {
            DirectFactor::Cholesky(_) => return Some(0),
            DirectFactor::General(_) => return None,
            DirectFactor::Indefinite(entries) => entries,
        };
        let mut negative = 0;
        match self.symbolic.as_ref()?.raw() {
            SymbolicCholeskyRaw::Simplicial(symbolic) => {
                let starts = symbolic.col_ptr();
                let pivots = starts[..self.size].iter().map(|&first| entries[first]);
                negative += pivots.filter(|pivot| *pivot < 0.0).count();
            }
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                // Each supernode is dense, with its pivots on the diagonal.
                for block in 0..symbolic.n_supernodes() {
                    let columns =
                        symbolic.supernode_end()[block] - symbolic.supernode_begin()[block];
                    let rows = columns + symbolic.supernode(block).pattern().len();
                    let first = symbolic.col_ptr_for_val()[block];
                    let pivots = (0..columns).map(|column| entries[first + column * (rows + 1)]);
                    negative += pivots.filter(|pivot| *pivot < 0.0).count();
                }
            }
        }
        Some(negative)
    }

    fn shifted(&self, shift: f64) -> Vec<f64> {
        let mut values = self.values.clone();
        for column in 0..self.size {
            for entry in self.column_starts[column]..self.column_starts[column + 1] {
                if self.row_indices[entry] == column {
                    values[entry] += shift * values[entry].abs();
                }
            }
        }
        values
    }

    /// Solves for a right-hand side in place, with the transposed tangent if `transposed`.
    pub fn solve(&self, factor: &DirectFactor, side: &mut [f64], transposed: bool) {
        match factor {
            DirectFactor::General(lu) => {
                let rhs = MatMut::from_column_major_slice_mut(side, self.size, 1);
                if transposed {
                    lu.solve_transpose_in_place(rhs);
                } else {
                    lu.solve_in_place(rhs);
                }
            }
            DirectFactor::Cholesky(entries) => {
                if let Some(symbolic) = &self.symbolic {
                    sparse_cholesky::solve(symbolic, entries, side);
                }
            }
            DirectFactor::Indefinite(entries) => {
                let Some(symbolic) = &self.symbolic else {
                    return;
                };
                let par = Par::Seq;
                let rhs = MatMut::from_column_major_slice_mut(side, self.size, 1);
                let mut buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, par));
                LdltRef::<usize, f64>::new(symbolic, entries).solve_in_place_with_conj(
                    Conj::No,
                    rhs,
                    par,
                    MemStack::new(&mut buffer),
                );
            }
        }
    }

    /// Visits row, column and value of each entry of the assembled tangent.
    #[cfg(test)]
    pub fn visit_entries(&self, visit: &mut dyn FnMut(usize, usize, f64)) {
        for column in 0..self.size {
            for entry in self.column_starts[column]..self.column_starts[column + 1] {
                visit(self.row_indices[entry], column, self.values[entry]);
            }
        }
    }

    /// Restricts vectors on vertices to free coordinates.
    pub fn gather(&self, vectors: &[Vec3]) -> Vec<f64> {
        let mut free = vec![0.0; self.size];
        for (coordinate, &row) in self.rows.iter().enumerate() {
            if row != HELD {
                free[row as usize] = vectors[coordinate / 3][coordinate % 3];
            }
        }
        free
    }

    /// Expands free coordinates into vectors on vertices, zero where held.
    pub fn spread(&self, free: &[f64]) -> Vec<Vec3> {
        let mut vectors = vec![[0.0; 3]; self.rows.len() / 3];
        for (coordinate, &row) in self.rows.iter().enumerate() {
            if row != HELD {
                vectors[coordinate / 3][coordinate % 3] = free[row as usize];
            }
        }
        vectors
    }
}

/// Marks vertices without voxels or tetrahedra: those of objects and springs.
fn of_no_element(body: &Body) -> Vec<bool> {
    let mut marks = vec![true; body.rest().len()];
    let hex8s = body.hex8s().iter().flat_map(|hex8| hex8.vertices);
    let tets = body.tets().iter().flat_map(|tet| tet.vertices);
    for vertex in hex8s.chain(tets) {
        marks[vertex as usize] = false;
    }
    marks
}

/// Vertices that share an element with each vertex, itself included.
fn adjacency(problem: &Problem, count: usize) -> Vec<Vec<u32>> {
    let mut neighbors: Vec<Vec<u32>> = (0..count as u32).map(|v| vec![v]).collect();
    let mut join = |vertices: &[u32]| {
        for &a in vertices {
            neighbors[a as usize].extend(vertices.iter().copied().filter(|&b| b != a));
        }
    };
    problem.visit_pattern(&mut join);
    for list in &mut neighbors {
        list.sort_unstable();
        list.dedup();
    }
    neighbors
}
