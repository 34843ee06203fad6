//! Lagged tangent of a step, factorized now and then and corrected in between.
//!
//! `A = K + κ M + D`: stiffness of the body and its pressures at some earlier positions, inertia, and a diagonal of
//! springs: grabs, and practically rigid ones on vertices held on the floor. A factor, or the preconditioner of a large
//! body ([`super::inverse`]), serves many steps, with `D` kept up to date.

use voxsoft_solid::element::hex8::{Tangent, Within};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, elastic};

use super::inverse::{Change, Inverse, inverse};
use super::objective::factor_within;
use super::turns::Turns;
use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;

/// Factor by which the inertia is raised until the sum is positive definite, and most such raises.
const LIFT: f64 = 4.0;
const MOST_LIFTS: u32 = 12;

/// Tangent with its last factor.
pub(super) struct Lagged {
    inverse: Box<dyn Inverse>,
    /// Masses on free coordinates.
    masses: Vec<f64>,
    /// True if the loads have a potential, whose Hessian is part of the tangent.
    conservative: bool,
    assembled: bool,
    /// Inertia `κ` in 1/s² and springs `D` in N/m of the factor.
    inertia: f64,
    springs: Vec<f64>,
    /// Rotations of all vertices since the assembly: `A` stands for `R A Rᵀ`.
    turns: Turns,
}

impl Lagged {
    pub fn new(problem: &Problem, options: LinearOptions) -> Result<Self, FactorError> {
        let inverse = inverse(problem, options)?;
        let masses: Vec<Vec3> = problem.body().masses().iter().map(|m| [*m; 3]).collect();
        Ok(Self {
            masses: inverse.gather(&masses),
            springs: vec![0.0; inverse.size()],
            inverse,
            conservative: problem.is_conservative(),
            assembled: false,
            inertia: 0.0,
            turns: Turns::new(problem),
        })
    }

    /// Tests whether the factor serves for an inertia of `κ`.
    pub fn serves(&self, inertia: f64, range: f64) -> bool {
        let ratio = inertia / self.inertia;
        self.inverse.is_factorized() && self.assembled && ratio < range && ratio * range > 1.0
    }

    /// Cost of a new tangent with its factor, in units of a move.
    pub fn factor_cost(&self) -> f64 {
        self.inverse.factor_cost()
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
        let loads = (self.conservative || problem.feels_motion()) && tangent == Tangent::Exact;
        self.inverse.assemble(&mut |add| {
            elastic::visit_tangent(problem.body(), positions, within, tangent, add);
            if loads {
                let factor_of = factor_within(problem, time);
                problem.visit_load_stiffness(positions, &factor_of, add);
            }
        });
        self.turns.start(problem, positions);
        self.assembled = true;
    }

    /// Tests whether a stiffness is assembled.
    pub fn is_assembled(&self) -> bool {
        self.assembled
    }

    /// Discards the stiffness.
    pub fn forget(&mut self) {
        self.assembled = false;
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
        let pairs = self.masses.iter().zip(springs);
        let diagonal: Vec<f64> = pairs.map(|(mass, k)| lifted * mass + k).collect();
        if !self.inverse.factorize(&diagonal)? {
            return Ok(false);
        }
        self.inertia = inertia;
        self.springs = springs.to_vec();
        Ok(true)
    }

    /// Updates the springs; returns `false` if that takes a new factor.
    pub fn patch(&mut self, springs: &[f64]) -> bool {
        let pairs = springs.iter().zip(&self.springs).enumerate();
        let changed = pairs.filter(|(_, (new, old))| new != old);
        let by = |(row, (new, old))| Change { row, by: new - old };
        let changes: Vec<Change> = changed.map(by).collect();
        self.inverse.patch(&changes)
    }

    /// Updates the rotations of all vertices to `positions`; those on the floor do not rotate.
    pub fn turn(&mut self, problem: &Problem, positions: &[Vec3], carried: &[bool]) {
        self.turns.take(problem, positions, carried);
    }

    /// Applies `R A⁻¹ Rᵀ` to forces on free coordinates.
    pub fn apply(&self, side: &mut Vec<f64>) {
        let mut vectors = self.inverse.spread(side);
        self.turns.back(&mut vectors);
        *side = self.inverse.gather(&vectors);
        self.inverse.solve(side);
        vectors = self.inverse.spread(side);
        self.turns.forth(&mut vectors);
        *side = self.inverse.gather(&vectors);
    }

    /// Restricts vectors on vertices to free coordinates.
    pub fn gather(&self, vectors: &[Vec3]) -> Vec<f64> {
        self.inverse.gather(vectors)
    }

    /// Expands free coordinates into vectors on vertices, zero where held.
    pub fn spread(&self, free: &[f64]) -> Vec<Vec3> {
        self.inverse.spread(free)
    }

    /// Row of a coordinate, if it is free.
    pub fn row_of(&self, vertex: usize, axis: usize) -> Option<usize> {
        self.inverse.row_of(vertex, axis)
    }

    /// Number of free coordinates.
    pub fn size(&self) -> usize {
        self.inverse.size()
    }
}
