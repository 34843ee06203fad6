//! Lagged tangent of a step, factorized now and then and corrected in between.
//!
//! `A = K + κ M + D`: stiffness of the body and its pressures at some earlier positions, inertia, and a diagonal of
//! springs: grabs, and practically rigid ones on vertices held on the floor. A factor serves many steps. A few entries
//! of `D` that have changed since are corrected exactly (Sherman, Morrison and Woodbury):
//! `(A + E Δ Eᵀ)⁻¹ = A⁻¹ − C (Δ⁻¹ + Eᵀ C)⁻¹ Cᵀ` with `C = A⁻¹ E`.

use voxsoft_solid::element::hex8::{Tangent, Within};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Problem, elastic};

use super::turns::Turns;
use crate::linear::direct::{DirectFactor, DirectSystem};
use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;

/// Changed entries of `D` beyond which a new factor is cheaper: each costs a solution.
const MOST_PATCHES: usize = 24;
/// Factor by which the inertia is raised until the sum is positive definite, and most such raises.
const LIFT: f64 = 4.0;
const MOST_LIFTS: u32 = 12;

/// Changed entry of `D`.
struct Patch {
    row: usize,
    change: f64,
    /// Solution `A⁻¹ e`.
    column: Vec<f64>,
}

/// Tangent with its last factor.
pub(super) struct Lagged {
    system: DirectSystem,
    /// Masses on free coordinates.
    masses: Vec<f64>,
    /// True if the loads have a potential, whose Hessian is part of the tangent.
    conservative: bool,
    assembled: bool,
    factor: Option<DirectFactor>,
    /// Inertia `κ` in 1/s² and springs `D` in N/m of the factor.
    inertia: f64,
    springs: Vec<f64>,
    patches: Vec<Patch>,
    /// Rotations of all vertices since the assembly: `A` stands for `R A Rᵀ`.
    turns: Turns,
}

impl Lagged {
    pub fn new(problem: &Problem, options: LinearOptions) -> Result<Self, FactorError> {
        let system = DirectSystem::with_symmetry(problem, problem.held(), options, true)?;
        let masses: Vec<Vec3> = problem.body().masses().iter().map(|m| [*m; 3]).collect();
        Ok(Self {
            masses: system.gather(&masses),
            springs: vec![0.0; system.size()],
            system,
            conservative: problem.is_conservative(),
            assembled: false,
            factor: None,
            inertia: 0.0,
            patches: Vec::new(),
            turns: Turns::new(problem),
        })
    }

    /// Tests whether the factor serves for an inertia of `κ`.
    pub fn serves(&self, inertia: f64, range: f64) -> bool {
        let ratio = inertia / self.inertia;
        self.factor.is_some() && ratio < range && ratio * range > 1.0
    }

    /// Cost of a factor, in units of a solution: both go through all entries, the factor once for each row of an
    /// entry's column.
    pub fn factor_cost(&self) -> f64 {
        (self.system.factor_entries() as f64 / self.system.size() as f64 / 16.0).max(4.0)
    }

    /// Assembles the stiffness at `positions` and `time`, that of the loads included if they have a potential; a
    /// [`Tangent::Stressless`] one without the geometric stiffness and that of loads.
    pub fn assemble(
        &mut self,
        problem: &Problem,
        positions: &[Vec3],
        time: f64,
        within: &[Within],
        tangent: Tangent,
    ) {
        let loads = self.conservative && tangent == Tangent::Exact;
        self.system.assemble_pieces(None, &mut [], |add| {
            elastic::visit_tangent(problem.body(), positions, within, tangent, add);
            if loads {
                let factor_of = |load: &Load| load.history.at(time);
                problem.visit_load_stiffness(positions, &factor_of, add);
            }
        });
        self.start(problem, positions);
    }

    fn start(&mut self, problem: &Problem, positions: &[Vec3]) {
        self.turns.start(problem, positions);
        self.assembled = true;
        self.factor = None;
    }

    /// Tests whether a stiffness is assembled.
    pub fn is_assembled(&self) -> bool {
        self.assembled
    }

    /// Discards the stiffness.
    pub fn forget(&mut self) {
        self.assembled = false;
        self.factor = None;
    }

    /// Factorizes for an inertia of `κ` (1/s²) and springs on coordinates (N/m); returns `false` if the sum is not
    /// positive definite.
    pub fn factorize(&mut self, inertia: f64, springs: &[f64]) -> Result<bool, FactorError> {
        self.factorize_as(inertia, inertia, springs)
    }

    /// Factorizes with as much more inertia as a positive definite sum takes.
    pub fn factorize_lifted(&mut self, inertia: f64, springs: &[f64]) -> Result<(), FactorError> {
        let mut lifted = inertia;
        for _ in 0..MOST_LIFTS {
            if self.factorize_as(inertia, lifted, springs)? {
                return Ok(());
            }
            lifted *= LIFT;
        }
        Err(FactorError::NotPositive)
    }

    fn factorize_as(
        &mut self,
        inertia: f64,
        lifted: f64,
        springs: &[f64],
    ) -> Result<bool, FactorError> {
        self.patches.clear();
        let pairs = self.masses.iter().zip(springs);
        let diagonal: Vec<f64> = pairs.map(|(mass, k)| lifted * mass + k).collect();
        match self.system.factor_lifted(&diagonal) {
            Ok(factor) => self.factor = Some(factor),
            Err(FactorError::NotPositive) => {
                return Ok(false);
            }
            Err(error) => return Err(error),
        }
        self.inertia = inertia;
        self.springs = springs.to_vec();
        Ok(true)
    }

    /// Updates the springs; returns `false` if that takes a new factor.
    pub fn patch(&mut self, springs: &[f64]) -> bool {
        let changes = || {
            let pairs = springs.iter().zip(&self.springs).enumerate();
            pairs.filter(|(_, (new, old))| new != old)
        };
        if changes().count() > MOST_PATCHES {
            return false;
        }
        let Some(factor) = &self.factor else {
            return false;
        };
        let mut known = std::mem::take(&mut self.patches);
        let mut patches = Vec::new();
        for (row, (new, old)) in changes() {
            let change = new - old;
            let column = match known.iter().position(|patch| patch.row == row) {
                Some(place) => known.swap_remove(place).column,
                None => {
                    let mut column = vec![0.0; springs.len()];
                    column[row] = 1.0;
                    self.system.solve(factor, &mut column, false);
                    column
                }
            };
            patches.push(Patch {
                row,
                change,
                column,
            });
        }
        self.patches = patches;
        true
    }

    /// Updates the rotations of all vertices to `positions`; those on the floor do not rotate.
    pub fn turn(&mut self, problem: &Problem, positions: &[Vec3], carried: &[bool]) {
        self.turns.take(problem, positions, carried);
    }

    /// Applies `R A⁻¹ Rᵀ` to forces on free coordinates.
    pub fn apply(&self, side: &mut Vec<f64>) {
        let mut vectors = self.system.spread(side);
        self.turns.back(&mut vectors);
        *side = self.system.gather(&vectors);
        self.solve(side);
        vectors = self.system.spread(side);
        self.turns.forth(&mut vectors);
        *side = self.system.gather(&vectors);
    }

    /// Applies `A⁻¹` to a vector, in place.
    fn solve(&self, side: &mut [f64]) {
        let Some(factor) = &self.factor else {
            return;
        };
        self.system.solve(factor, side, false);
        let count = self.patches.len();
        if count == 0 {
            return;
        }
        let mut matrix = vec![vec![0.0; count]; count];
        let mut right: Vec<f64> = self.patches.iter().map(|p| side[p.row]).collect();
        for (i, patch) in self.patches.iter().enumerate() {
            for (j, other) in self.patches.iter().enumerate() {
                matrix[i][j] = other.column[patch.row];
            }
            matrix[i][i] += 1.0 / patch.change;
        }
        eliminate(&mut matrix, &mut right);
        for (patch, part) in self.patches.iter().zip(right) {
            for (x, c) in side.iter_mut().zip(&patch.column) {
                *x -= part * c;
            }
        }
    }

    /// Restricts vectors on vertices to free coordinates.
    pub fn gather(&self, vectors: &[Vec3]) -> Vec<f64> {
        self.system.gather(vectors)
    }

    /// Expands free coordinates into vectors on vertices, zero where held.
    pub fn spread(&self, free: &[f64]) -> Vec<Vec3> {
        self.system.spread(free)
    }

    /// Row of a coordinate, if it is free.
    pub fn row_of(&self, vertex: usize, axis: usize) -> Option<usize> {
        self.system.row_of(vertex, axis)
    }

    /// Number of free coordinates.
    pub fn size(&self) -> usize {
        self.system.size()
    }
}

/// Solves a small dense system in place, with partial pivoting.
fn eliminate(matrix: &mut [Vec<f64>], right: &mut [f64]) {
    let count = right.len();
    for k in 0..count {
        let size = |i: &usize| matrix[*i][k].abs();
        let pivot = (k..count).max_by(|a, b| size(a).total_cmp(&size(b)));
        let pivot = pivot.unwrap_or(k);
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        for i in k + 1..count {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..count {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / matrix[k][k];
    }
}
