//! Slopes of numbers of an equilibrium by the fractions of stiffness and mass of each block.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Blocks, PerBlock, Problem};

use super::adjoint::{AdjointError, adjoint};

/// Slopes of numbers that depend on the positions of an equilibrium under all loads, one for each gradient by the
/// positions of all vertices, by the fractions of all blocks ([`Blocks::slopes`]): in the unit of the number. One
/// factorization serves for all. The tangent may take `memory` bytes; `stop` is polled between the steps of the work.
pub fn block_slopes(
    problem: &Problem,
    blocks: &Blocks,
    positions: &[Vec3],
    gradients: &[Vec<Vec3>],
    memory: u64,
    stop: &mut dyn FnMut() -> bool,
) -> Result<Vec<PerBlock>, AdjointError> {
    let states = adjoint(problem, positions, gradients, memory, stop)?;
    let slopes = |state: &Vec<Vec3>| blocks.slopes(problem, positions, state);
    Ok(states.iter().map(slopes).collect())
}
