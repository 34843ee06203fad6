//! Tangent of a problem on its free coordinates: choice between direct and iterative solver.

use voxsoft_solid::element::assumed_strain::AssumedStrains;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Problem, Term, Ties};

use crate::linear::direct::{DirectFactor, DirectSystem};
use crate::linear::error::FactorError;
use crate::linear::iterative::{IterativeFactor, IterativeSystem};
use crate::linear::low_rank_update::{LowRankUpdate, UpdateSolutions};
use crate::linear::options::{LARGE, LARGE_WITH_OBJECTS, LinearOptions};

/// Tangent of a problem, kept with its sparsity pattern for many assemblies.
///
/// The direct solver runs on one thread; the iterative one on all, with the same bits for any number. The dense
/// coupling of the whole wall of a chamber is kept apart ([`crate::linear::low_rank_update`]).
pub(crate) struct System {
    tangent: Tangent,
    coupled: Option<LowRankUpdate>,
    ties: Ties,
}

enum Tangent {
    Direct(Box<DirectSystem>),
    Iterative(Box<IterativeSystem>),
}

/// Factorized tangent.
pub(crate) struct Factor {
    tangent: TangentFactor,
    /// Solutions of the tangent for its coupled gradients.
    answers: Option<UpdateSolutions>,
}

enum TangentFactor {
    Direct(DirectFactor),
    Iterative(IterativeFactor),
}

impl System {
    /// Sparsity pattern of a problem whose coordinates `held` do not move.
    pub fn new(
        problem: &Problem,
        held: &[[bool; 3]],
        options: LinearOptions,
    ) -> Result<Self, FactorError> {
        let vertices = problem.body().rest().len();
        let large = if problem.body().attached().all(Term::is_local) {
            LARGE
        } else {
            LARGE_WITH_OBJECTS
        };
        let backend = options.solver.backend(vertices, large);
        let tangent = if let Some(make) = backend
            && let Some(system) = IterativeSystem::new(problem, held, options, make)?
        {
            Tangent::Iterative(Box::new(system))
        } else {
            Tangent::Direct(Box::new(DirectSystem::new(problem, held, options)?))
        };
        Ok(Self {
            tangent,
            coupled: None,
            ties: problem.body().ties().clone(),
        })
    }

    /// Tests whether the solver is iterative.
    pub fn is_iterative(&self) -> bool {
        matches!(self.tangent, Tangent::Iterative(_))
    }

    /// Length of vectors of free coordinates.
    pub fn size(&self) -> usize {
        match &self.tangent {
            Tangent::Direct(system) => system.size(),
            Tangent::Iterative(system) => system.size(),
        }
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
        match &mut self.tangent {
            Tangent::Direct(system) => {
                system.assemble(problem, positions, factor_of, strains, jump, residual);
            }
            Tangent::Iterative(system) => {
                system.assemble(problem, positions, factor_of, strains, jump, residual);
            }
        }
        let coupling = problem.coupling(positions, factor_of);
        if let (Some(coupling), Some(jump)) = (&coupling, jump) {
            let mut forces = vec![[0.0; 3]; positions.len()];
            coupling.add_product(jump, &mut forces);
            let pairs = residual.iter_mut().zip(self.gather(&forces));
            pairs.for_each(|(side, force)| *side -= force);
        }
        let free = |coupling| LowRankUpdate::new(coupling, &|field| self.gather(field));
        let coupled = coupling.map(free);
        match &mut self.tangent {
            Tangent::Direct(_) => self.coupled = coupled,
            Tangent::Iterative(system) => {
                system.couple(&coupled.map_or(Vec::new(), |coupled| coupled.columns()));
            }
        }
    }

    /// Factorizes the assembled tangent plus `shift` times its diagonal, definite or not.
    pub fn factor(&mut self, shift: f64) -> Result<Factor, FactorError> {
        let tangent = match &mut self.tangent {
            Tangent::Direct(system) => match system.factor(shift, true) {
                Err(FactorError::NotPositive) => system.factor(shift, false),
                other => other,
            }
            .map(TangentFactor::Direct),
            Tangent::Iterative(system) => {
                system.lift(shift);
                system.factor(false).map(TangentFactor::Iterative)
            }
        }?;
        Ok(Factor {
            answers: self.answers(&tangent),
            tangent,
        })
    }

    /// Factorizes the assembled tangent, which is symmetric, plus `shift` times its diagonal, if the sum is positive
    /// definite. The iterative solver needs no shift: its solutions are descent directions anyway.
    pub fn factor_positive(&mut self, shift: f64) -> Result<Factor, FactorError> {
        if self.coupled.is_some() {
            // The coupling may stabilize an indefinite tangent.
            let factor = self.factor(shift)?;
            return if self.is_positive(&factor) {
                Ok(factor)
            } else {
                Err(FactorError::NotPositive)
            };
        }
        let tangent = match &mut self.tangent {
            Tangent::Direct(system) => system.factor(shift, true).map(TangentFactor::Direct),
            Tangent::Iterative(system) => system.factor(true).map(TangentFactor::Iterative),
        }?;
        Ok(Factor {
            tangent,
            answers: None,
        })
    }

    /// Solutions with a factor for the coupled gradients.
    fn answers(&self, factor: &TangentFactor) -> Option<UpdateSolutions> {
        let (coupled, Tangent::Direct(system), TangentFactor::Direct(factor)) =
            (self.coupled.as_ref()?, &self.tangent, factor)
        else {
            return None;
        };
        let solve = |side: &mut [f64], transposed: bool| system.solve(factor, side, transposed);
        Some(coupled.answers(&solve))
    }

    fn is_positive(&self, factor: &Factor) -> bool {
        let negative = self.negative_pivots(factor);
        match (&self.coupled, &factor.answers) {
            (Some(coupled), Some(answers)) => {
                negative.is_some_and(|negative| coupled.is_positive_with(answers, negative))
            }
            _ => negative == Some(0),
        }
    }

    /// Number of negative eigenvalues of the factorized matrix, without the coupling; `None` if it is not symmetric, or
    /// solved iteratively.
    pub fn negative_pivots(&self, factor: &Factor) -> Option<usize> {
        match (&self.tangent, &factor.tangent) {
            (Tangent::Direct(system), TangentFactor::Direct(factor)) => {
                system.negative_pivots(factor)
            }
            _ => None,
        }
    }

    /// Solves for a right-hand side in place, with the transposed tangent if `transposed`.
    ///
    /// The iterative solver stops at the relative error `tolerance` in the norm of its preconditioner, and polls `stop`
    /// now and then; a direct factor is accurate to rounding.
    pub fn solve(
        &self,
        factor: &Factor,
        side: &mut [f64],
        transposed: bool,
        tolerance: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), FactorError> {
        match (&self.tangent, &factor.tangent) {
            (Tangent::Direct(system), TangentFactor::Direct(direct)) => {
                system.solve(direct, side, transposed);
                match (&self.coupled, &factor.answers) {
                    (Some(coupled), Some(answers)) => coupled.correct(answers, side, transposed),
                    _ => Ok(()),
                }
            }
            // Only symmetric tangents are solved iteratively.
            (Tangent::Iterative(system), TangentFactor::Iterative(factor)) => {
                system.solve(factor, side, tolerance, stop)
            }
            _ => unreachable!("a factor belongs to the system that made it"),
        }
    }

    /// Solves from an initial guess of the solution, which only the iterative solver uses.
    pub fn solve_from(
        &self,
        factor: &Factor,
        side: &mut [f64],
        guess: Option<&[f64]>,
        tolerance: f64,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), FactorError> {
        match (&self.tangent, &factor.tangent) {
            (Tangent::Iterative(system), TangentFactor::Iterative(factor)) => {
                system.solve_from(factor, side, guess, tolerance, stop)
            }
            _ => self.solve(factor, side, false, tolerance, stop),
        }
    }

    /// Tests whether the tangent is positive definite on all directions across `gradient`, if its inverse gives
    /// `gradient` a negative `compliance`: it has exactly one negative eigenvalue then.
    pub fn is_held_across(&mut self, factor: &Factor, gradient: &[f64], compliance: f64) -> bool {
        match &mut self.tangent {
            Tangent::Direct(_) => self.negative_pivots(factor) == Some(1),
            Tangent::Iterative(system) => system.is_held_across(gradient, compliance),
        }
    }

    /// Tests whether the assembled tangent, which is symmetric, is positive definite.
    pub fn is_positive_definite(&mut self) -> bool {
        match &mut self.tangent {
            Tangent::Direct(_) => self.factor_positive(0.0).is_ok(),
            Tangent::Iterative(system) => system.is_positive_definite(None),
        }
    }

    /// Restricts forces or gradients on vertices to free coordinates; those of tied vertices go to the vertices that
    /// carry them.
    pub fn gather(&self, vectors: &[Vec3]) -> Vec<f64> {
        if self.ties.is_empty() {
            return self.gather_free(vectors);
        }
        let mut handed = vectors.to_vec();
        self.ties.hand_over(&mut handed);
        self.gather_free(&handed)
    }

    fn gather_free(&self, vectors: &[Vec3]) -> Vec<f64> {
        match &self.tangent {
            Tangent::Direct(system) => system.gather(vectors),
            Tangent::Iterative(system) => system.gather(vectors),
        }
    }

    /// Expands free coordinates into moves of vertices: zero where held, and tied vertices follow.
    pub fn spread(&self, free: &[f64]) -> Vec<Vec3> {
        let mut vectors = match &self.tangent {
            Tangent::Direct(system) => system.spread(free),
            Tangent::Iterative(system) => system.spread(free),
        };
        self.ties.follow(&mut vectors);
        vectors
    }
}
