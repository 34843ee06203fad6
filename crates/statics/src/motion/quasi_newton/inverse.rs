//! Solver of the lagged tangent of a step: direct or iterative.

use voxsoft_solid::Problem;
use voxsoft_solid::assembly::Visitor;
use voxsoft_solid::vector::Vec3;

use super::factorized::Factorized;
use super::preconditioned::Preconditioned;
use crate::linear::direct::DirectSystem;
use crate::linear::error::FactorError;
use crate::linear::iterative::IterativeSystem;
use crate::linear::options::LinearOptions;

/// Number of vertices from which steps are solved iteratively: fewer than for an equilibrium, because a solution here has
/// a loose tolerance. On one thread a cube that a hand pulls at takes 5.6 ms a step in both ways with 729 vertices, 9.7
/// for 11.7 with 1,331 and 125 for 317 with 12,167; of a beam of 2,009 that sags by half its length, 21 for 24.
const LARGE: usize = 1_000;
/// Number of vertices from which steps with contact are solved iteratively: a block that a plate presses takes 1.2 times
/// the time of a factor with 2,744 vertices, and 0.84 with 5,832.
const LARGE_IN_CONTACT: usize = 4_000;

/// Change of an entry of the diagonal in N/m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub row: usize,
    pub by: f64,
}

/// Passes on the element matrices of a stiffness.
pub(super) type Visit<'a> = &'a mut dyn FnMut(Visitor<'_>);

/// Symmetric matrix `K + D` of an assembled stiffness and a diagonal on free coordinates, to solve with.
pub(super) trait Inverse: Send {
    /// Number of free coordinates.
    fn size(&self) -> usize;

    /// Row of a coordinate, if it is free.
    fn row_of(&self, vertex: usize, axis: usize) -> Option<usize>;

    /// Restricts vectors on vertices to free coordinates.
    fn gather(&self, vectors: &[Vec3]) -> Vec<f64>;

    /// Expands free coordinates into vectors on vertices, zero where held.
    fn spread(&self, free: &[f64]) -> Vec<Vec3>;

    /// Assembles the stiffness `K`, and discards the factor.
    fn assemble(&mut self, visit: Visit<'_>);

    /// Factorizes with a diagonal `D` (N/m); returns `false` if the sum was found not to be positive definite.
    fn factorize(&mut self, diagonal: &[f64]) -> Result<bool, FactorError>;

    /// Tests whether anything is factorized.
    fn is_factorized(&self) -> bool;

    /// Corrects the factor for all changes of the diagonal since it was made; returns `false` if that takes a new one.
    fn patch(&mut self, changes: &[Change]) -> bool;

    /// Solves for a right-hand side in place. An iterative solution has an error, but is a direction of descent.
    fn solve(&self, side: &mut [f64]);

    /// Cost of an assembly with its factor, in units of a move with its solution.
    fn factor_cost(&self) -> f64;
}

/// Solver for the tangent of a problem: iterative for large bodies that multigrid knows, otherwise direct. With free
/// objects a solution to a tenth takes far more moves than one with a factor.
pub(super) fn inverse(
    problem: &Problem,
    options: LinearOptions,
) -> Result<Box<dyn Inverse>, FactorError> {
    let held = problem.held();
    let large = match problem.contact() {
        _ if !problem.rigid().is_empty() => usize::MAX,
        Some(_) => LARGE_IN_CONTACT,
        None => LARGE,
    };
    let backend = options.solver.backend(problem.body().rest().len(), large);
    if let Some(make) = backend
        && let Some(system) = IterativeSystem::of_symmetric(problem, held, options, make)?
    {
        return Ok(Box::new(Preconditioned::new(system)));
    }
    let system = DirectSystem::with_symmetry(problem, held, options, true)?;
    Ok(Box::new(Factorized::new(system)))
}
