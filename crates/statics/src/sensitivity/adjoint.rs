//! Adjoint derivatives at an equilibrium, without another nonlinear solution.
//!
//! At an equilibrium `r(x, p) = 0` with the tangent `K = −∂r/∂x`, a number `J(x)` changes with a
//! parameter by `dJ/dp = (∂J/∂x)·K⁻¹ ∂r/∂p = μ·∂r/∂p` with the adjoint state `Kᵀ μ = ∂J/∂x`. The state `μ`
//! serves for all parameters; `∂r/∂p` is a difference of forces at the same positions.

use std::fmt;

use voxsoft_solid::Problem;
use voxsoft_solid::vector::Vec3;

use crate::linear::error::FactorError;
use crate::linear::options::LinearOptions;
use crate::linear::options::LinearSolver;
use crate::path::equilibrium::Equilibrium;
use crate::path::load_parameter::LoadParameter;

/// Relative tolerance of iterative solutions, in the energy norm; rounding in a slender body limits it to 1e-10.
const TOLERANCE: f64 = 1e-8;

/// Reasons for a missing derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AdjointError {
    /// The tangent is singular there: the state is a limit point, or a part moves freely.
    Singular,
    /// The tangent takes more memory than there is, in bytes; 0 where that is not known.
    OutOfMemory(u64),
    /// Derivatives of contact multipliers, or vibration modes, do not converge.
    Unsettled,
    /// The caller asked to stop.
    Cancelled,
}

impl fmt::Display for AdjointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Singular => "the tangent is singular at this state, so it has no derivative",
            Self::OutOfMemory(_) => "the factorized tangent does not fit in memory",
            Self::Unsettled => "contact does not settle to the first order",
            Self::Cancelled => "the solution was cancelled",
        })
    }
}

impl std::error::Error for AdjointError {}

/// Solves for the adjoint states `Kᵀ μ = g` at an equilibrium under all loads, one for each gradient `g` (of a number
/// with respect to the positions of all vertices); zero on held coordinates. The tangent may take `memory` bytes;
/// `stop` is polled between the steps of the work.
pub fn adjoint(
    problem: &Problem,
    positions: &[Vec3],
    gradients: &[Vec<Vec3>],
    memory: u64,
    stop: &mut dyn FnMut() -> bool,
) -> Result<Vec<Vec<Vec3>>, AdjointError> {
    let mut equilibrium = with_tangent(problem, positions, memory)?;
    if stop() {
        return Err(AdjointError::Cancelled);
    }
    let factor = equilibrium.system.factor(0.0)?;
    let mut solve = |gradient: &Vec<Vec3>| {
        let mut side = equilibrium.system.gather(gradient);
        equilibrium
            .system
            .solve(&factor, &mut side, true, TOLERANCE, stop)?;
        if side.iter().all(|x| x.is_finite()) {
            Ok(equilibrium.system.spread(&side))
        } else {
            Err(AdjointError::Singular)
        }
    };
    gradients.iter().map(&mut solve).collect()
}

/// Equilibrium under all loads with its tangent assembled, which may take `memory` bytes.
pub(crate) fn with_tangent(
    problem: &Problem,
    positions: &[Vec3],
    memory: u64,
) -> Result<Equilibrium, AdjointError> {
    let options = LinearOptions {
        solver: LinearSolver::Auto,
        memory,
    };
    let mut equilibrium = Equilibrium::new(problem.clone(), options)?;
    let full = LoadParameter::all(1.0);
    equilibrium.update_floor(positions, full)?;
    equilibrium.follow_contact(positions)?;
    let mut unused = vec![0.0; equilibrium.system.size()];
    equilibrium.system.assemble(
        problem,
        positions,
        &full.factor_of(),
        None,
        None,
        &mut unused,
    );
    Ok(equilibrium)
}

impl From<FactorError> for AdjointError {
    fn from(error: FactorError) -> Self {
        match error {
            FactorError::Memory(bytes) => Self::OutOfMemory(bytes),
            FactorError::Cancelled => Self::Cancelled,
            FactorError::NotPositive | FactorError::Singular | FactorError::Stalled => {
                Self::Singular
            }
        }
    }
}
