//! Iterative solver of a large voxel body: assembly of its tangent for conjugate gradients with a back end.
//!
//! The memory and the work of one iteration grow with the number of voxels, while those of a direct factor in three
//! dimensions grow with its powers 4/3 and 2.

use voxsoft_solid::assembly::Elements;
use voxsoft_solid::element::assumed_strain::AssumedStrains;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Problem, elastic};

use crate::linear::backend::{Backend, MakeBackend};
use crate::linear::conjugate_gradients::{End, Equation, conjugate_gradients};
use crate::linear::error::FactorError;
use crate::linear::multigrid::{BlockMatrix, cells_of, color, for_each_large, vectorized};
use crate::linear::objects::{Objects, objects_of};
use crate::linear::operator::RankUpdated;
use crate::linear::options::LinearOptions;
use crate::linear::row_pattern::pattern;
use crate::linear::scatter::Scatter;

/// Memory per vertex: 27 blocks of 76 bytes, an eighth more for coarser levels, and patterns, strains and vectors. 3.9
/// kB were measured on a cube of 10⁵ voxels, the mesh included; the factor of the coarsest level adds 240 bytes at most.
const BYTES_PER_VERTEX: u64 = 4_300;
/// Factor on the smallest sufficient rank-one stiffness that is added across a direction.
const BEYOND: f64 = 10.0;
/// Number of elements from which parts of the rows are worth a task each, and number of these parts.
const MANY: usize = 64;
const PARTS: usize = 8;
/// Tolerance of solutions that search for negative curvature.
const DEFINITE_TOLERANCE: f64 = 1e-4;

/// Tangent as 3 × 3 blocks by vertices, with rows and columns of held coordinates zero.
pub(crate) struct IterativeSystem {
    /// Row of each vertex.
    places: Vec<u32>,
    held: Vec<[bool; 3]>,
    matrix: BlockMatrix,
    /// Free rigid objects, whose coordinates in the matrix and in vectors by rows change where it is factorized.
    objects: Objects,
    /// Relative shift of the diagonal.
    lifted: f64,
    backend: Box<dyn Backend>,
    /// Vectors by rows whose outer products are added to the tangent but not to its preconditioner: each costs an
    /// iteration or two.
    coupled: Vec<Vec<Vec3>>,
}

/// Preconditioner that the back end holds for the assembled tangent.
pub(crate) struct IterativeFactor {
    /// True if solutions must be descent directions.
    downhill: bool,
}

impl IterativeSystem {
    /// Sparsity pattern and hierarchy; `None` if a component of the body is not made of equal voxels only, or the
    /// tangent is not symmetric.
    pub fn new(
        problem: &Problem,
        held: &[[bool; 3]],
        options: LinearOptions,
        make: MakeBackend,
    ) -> Result<Option<Self>, FactorError> {
        if !problem.is_conservative() {
            return Ok(None);
        }
        Self::of_symmetric(problem, held, options, make)
    }

    /// Makes the system of a tangent without the loads that have no potential, so that it is symmetric.
    pub fn of_symmetric(
        problem: &Problem,
        held: &[[bool; 3]],
        options: LinearOptions,
        make: MakeBackend,
    ) -> Result<Option<Self>, FactorError> {
        let body = problem.body();
        let whole = 5 * body.voxels().len() == body.tets().len() + 5 * body.small_hex8s().len();
        let loads = problem.loads().iter();
        let local = loads.map(|load| &load.kind).all(|kind| kind.is_local());
        if !whole || !local {
            return Ok(None);
        }
        let Some(mut cells) = cells_of(body) else {
            return Ok(None);
        };
        let mut is_corner = vec![false; held.len()];
        for node in cells.iter().flat_map(|cell| cell.nodes) {
            is_corner[node as usize] = true;
        }
        let Some(mut objects) = objects_of(problem, held, &is_corner) else {
            return Ok(None);
        };
        options.allow(BYTES_PER_VERTEX * body.rest().len() as u64)?;
        let draft = pattern(problem, &objects);
        let (coloring, places) = color(&draft);
        for row in objects.iter_mut().flatten() {
            *row = places[*row as usize];
        }
        for cell in &mut cells {
            cell.nodes = cell.nodes.map(|node| places[node as usize]);
        }
        let matrix = draft.renumbered(&places);
        let objects = Objects::new(objects);
        let backend = make(cells, &objects.all_rows(), &matrix, coloring);
        Ok(Some(Self {
            places,
            held: held.to_vec(),
            matrix,
            objects,
            lifted: 0.0,
            backend,
            coupled: Vec::new(),
        }))
    }

    /// Length of vectors of free coordinates: all coordinates, of which the held ones are zero.
    pub fn size(&self) -> usize {
        3 * self.places.len()
    }

    /// The assembled matrix and the back end.
    pub fn parts(&self) -> (&BlockMatrix, &dyn Backend) {
        (&self.matrix, &*self.backend)
    }

    /// Free rigid objects.
    #[cfg(test)]
    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    /// Row of each vertex.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Discards the assembled tangent.
    fn clear(&mut self) {
        self.lifted = 0.0;
        self.matrix.clear();
        self.objects.forget();
    }

    /// Changes the matrix and the coupled vectors back to the coordinates of vertices; returns true if that takes a new
    /// factor.
    pub fn turn_back(&mut self) -> bool {
        for vector in &mut self.coupled {
            self.objects.vertices(vector);
        }
        self.objects.turn_back(&mut self.matrix)
    }

    /// See [`crate::linear::system::System::assemble`].
    pub fn assemble(
        &mut self,
        problem: &Problem,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
        strains: Option<&AssumedStrains>,
        jump: Option<&[Vec3]>,
        residual: &mut [f64],
    ) {
        self.clear();
        let mut target = Target {
            places: &self.places,
            held: &self.held,
            matrix: &mut self.matrix,
        };
        let mut add = |elements: Elements<'_>| match jump {
            Some(jump) => {
                target.push(elements, jump, residual);
                target.add(elements);
            }
            None => target.add(elements),
        };
        match strains {
            Some(strains) => strains.visit_elements(problem.body(), positions, &mut add),
            None => elastic::visit_elements(problem.body(), positions, &mut add),
        }
        problem.visit_load_stiffness(positions, factor_of, &mut |vertices, matrices| {
            add(Elements {
                width: vertices.len(),
                vertices,
                matrices,
            });
        });
    }

    /// Assembles element matrices that `visit` passes on, many at a time.
    pub fn assemble_batches(&mut self, visit: impl FnOnce(&mut dyn FnMut(Elements<'_>))) {
        self.clear();
        let mut target = Target {
            places: &self.places,
            held: &self.held,
            matrix: &mut self.matrix,
        };
        visit(&mut |elements| target.add(elements));
    }

    /// Diagonal of the assembled tangent on free coordinates.
    pub fn diagonal(&mut self) -> Vec<f64> {
        self.turn_back();
        let block = |&place: &u32| self.matrix.diagonal_block(place as usize);
        let blocks = self.places.iter().map(block);
        blocks
            .flat_map(|block| [block[0], block[4], block[8]])
            .collect()
    }

    /// Sets that diagonal; held coordinates stay as they are.
    pub fn set_diagonal(&mut self, diagonal: &[f64]) {
        self.turn_back();
        let (vectors, _) = diagonal.as_chunks::<3>();
        for ((&row, held), vector) in self.places.iter().zip(&self.held).zip(vectors) {
            let place = self.matrix.diagonal_place(row as usize);
            for axis in 0..3 {
                if !held[axis] {
                    self.matrix
                        .upper
                        .values
                        .set(place, axis, axis, vector[axis]);
                }
            }
        }
    }

    /// Row of a coordinate, if it is free.
    pub fn row_of(&self, vertex: usize, axis: usize) -> Option<usize> {
        (!self.held[vertex][axis]).then_some(3 * vertex + axis)
    }

    /// Adds the outer products of vectors of free coordinates to the assembled tangent.
    pub fn couple(&mut self, vectors: &[Vec<f64>]) {
        self.coupled = vectors.iter().map(|vector| self.by_rows(vector)).collect();
    }

    /// Scales the diagonal of the assembled tangent to `1 + shift` times its original value, where it is positive.
    pub fn lift(&mut self, shift: f64) {
        let by = (1.0 + shift) / (1.0 + self.lifted);
        self.lifted = shift;
        if by == 1.0 {
            return;
        }
        self.turn_back();
        for row in 0..self.matrix.rows() {
            let (place, block) = (
                self.matrix.diagonal_place(row),
                self.matrix.diagonal_block(row),
            );
            for axis in 0..3 {
                if block[4 * axis] > 0.0 {
                    let values = &mut self.matrix.upper.values;
                    values.scale(place, axis, axis, by);
                }
            }
        }
    }

    /// Preconditioner for the assembled tangent.
    pub fn factor(&mut self, downhill: bool) -> Result<IterativeFactor, FactorError> {
        if !self.matrix.are_finite() {
            return Err(FactorError::Singular);
        }
        if !self.objects.are_turned() {
            self.objects.turn(&mut self.matrix);
            for vector in &mut self.coupled {
                self.objects.amplitudes(vector);
            }
        }
        self.backend.take(&self.matrix);
        Ok(IterativeFactor { downhill })
    }

    /// Solves in place, see [`conjugate_gradients`].
    pub fn solve(
        &self,
        factor: &IterativeFactor,
        side: &mut [f64],
        tolerance: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), FactorError> {
        self.solve_from(factor, side, None, tolerance, stop)
    }

    /// Solves from an initial guess of the solution.
    pub fn solve_from(
        &self,
        factor: &IterativeFactor,
        side: &mut [f64],
        guess: Option<&[f64]>,
        tolerance: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), FactorError> {
        let guess = guess.map(|guess| self.by_rows(guess));
        let sides = (self.by_rows(side), guess.as_deref());
        let (answer, end) = self.iterate(factor, sides, None, tolerance, stop);
        let answer = self.by_vertices(answer);
        side.copy_from_slice(answer.as_flattened());
        match end {
            End::Converged | End::NegativeCurvature => Ok(()),
            End::Stalled => Err(FactorError::Stalled),
            End::Cancelled => Err(FactorError::Cancelled),
        }
    }

    /// See [`crate::linear::system::System::is_held_across`]: the tangent plus `ρ g ⊗ g` is then positive definite for
    /// all ρ beyond one over that compliance.
    pub fn is_held_across(&mut self, gradient: &[f64], compliance: f64) -> bool {
        self.is_positive_definite(Some((gradient, BEYOND / compliance.abs())))
    }

    /// Tests definiteness by conjugate gradients from zero, which explore every direction in which the preconditioned
    /// right-hand side has a component; a pseudo-random one has components in all. `border` is a vector with the factor
    /// of its outer product, which is added to the tangent.
    pub fn is_positive_definite(&mut self, border: Option<(&[f64], f64)>) -> bool {
        let Ok(factor) = self.factor(true) else {
            return false;
        };
        let mut side = vec![0.0; self.size()];
        let mut seed = 0x9e37_79b9_7f4a_7c15u64;
        for (coordinate, value) in side.iter_mut().enumerate() {
            if !self.held[coordinate / 3][coordinate % 3] {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                *value = (seed >> 33) as f64 / f64::from(1u32 << 31) - 0.5;
            }
        }
        let border = border.map(|(vector, factor)| (self.by_rows(vector), factor));
        let border = (border.as_ref()).map(|(vector, factor)| (vector.as_slice(), *factor));
        let sides = (self.by_rows(&side), None);
        let (_, end) = self.iterate(&factor, sides, border, DEFINITE_TOLERANCE, &mut || false);
        end != End::NegativeCurvature
    }

    /// Converts a vector of free coordinates into rows of the matrix.
    pub fn by_rows(&self, side: &[f64]) -> Vec<Vec3> {
        let mut rows = vec![[0.0; 3]; self.places.len()];
        for (vertex, &place) in self.places.iter().enumerate() {
            rows[place as usize].copy_from_slice(&side[3 * vertex..3 * vertex + 3]);
        }
        self.objects.amplitudes(&mut rows);
        rows
    }

    /// Converts rows of the matrix into vectors on vertices.
    pub fn by_vertices(&self, mut rows: Vec<Vec3>) -> Vec<Vec3> {
        self.objects.vertices(&mut rows);
        let places = self.places.iter();
        places.map(|&place| rows[place as usize]).collect()
    }

    /// Conjugate gradients on the tangent with its coupled terms and a `border`; returns the solution by rows for a
    /// right-hand side and an initial guess by rows.
    fn iterate(
        &self,
        factor: &IterativeFactor,
        (side, guess): (Vec<Vec3>, Option<&[Vec3]>),
        border: Option<(&[Vec3], f64)>,
        tolerance: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> (Vec<Vec3>, End) {
        let tangent = self.backend.operator(&self.matrix);
        let coupled = self.coupled.iter().map(|vector| (vector.as_slice(), 1.0));
        let operator = RankUpdated {
            base: &*tangent,
            terms: coupled.chain(border).collect(),
        };
        let mut preconditioner = self.backend.preconditioner(&self.matrix);
        let equation = Equation {
            operator: &operator,
            side: &side,
            guess,
        };
        conjugate_gradients(
            &equation,
            &mut *preconditioner,
            tolerance,
            factor.downhill,
            stop,
        )
    }

    /// Flattens vectors on vertices into all coordinates, zero where held.
    pub fn gather(&self, vectors: &[Vec3]) -> Vec<f64> {
        let mut free = vectors.as_flattened().to_vec();
        for (coordinate, value) in free.iter_mut().enumerate() {
            if self.held[coordinate / 3][coordinate % 3] {
                *value = 0.0;
            }
        }
        free
    }

    /// Expands coordinates into vectors on vertices, zero where held.
    pub fn spread(&self, free: &[f64]) -> Vec<Vec3> {
        free.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect()
    }
}

/// Matrix into which elements are assembled.
struct Target<'a> {
    places: &'a [u32],
    held: &'a [[bool; 3]],
    matrix: &'a mut BlockMatrix,
}

impl Target<'_> {
    /// Subtracts the forces of held coordinates that are about to move.
    fn push(&self, elements: Elements<'_>, jump: &[Vec3], residual: &mut [f64]) {
        for (vertices, entries) in elements.iter() {
            let width = 3 * vertices.len();
            for (row, entries) in entries.chunks(width).enumerate() {
                let (vertex, axis) = (vertices[row / 3] as usize, row % 3);
                if self.held[vertex][axis] {
                    continue;
                }
                for (column, k) in entries.iter().enumerate() {
                    let (other, along) = (vertices[column / 3] as usize, column % 3);
                    if self.held[other][along] {
                        residual[3 * vertex + axis] -= k * jump[other][along];
                    }
                }
            }
        }
    }

    /// Adds to the matrix: many elements by parts of its rows, so that each row sums them in their order.
    fn add(&mut self, elements: Elements<'_>) {
        let Self {
            places,
            held,
            matrix,
        } = self;
        let rows = matrix.rows();
        let count = if elements.vertices.len() < MANY * elements.width {
            1
        } else {
            PARTS
        };
        // Rows are numbered by colors, each of which occurs once in a voxel: equal parts are equal work.
        let ranges = (0..count).map(|part| rows * part / count..rows * (part + 1) / count);
        let (mut parts, columns) = matrix.parts(ranges);
        for_each_large(&mut parts, |_, part| {
            vectorized(Scatter {
                elements,
                places,
                held,
                columns,
                part,
            });
        });
    }
}
