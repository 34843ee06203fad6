//! Derivatives along the load path of path-dependent problems.
//!
//! Contact with friction has memory: multipliers, bounds and anchors `M` at each equilibrium come from the one before.
//! With the equilibria `r_j(x_j, M_j, p) = 0` of a path and the corrections `M_{j+1} = C(x_j, M_j, p)`,
//!
//! ```text
//! K_j dx_j/dp = ∂r_j/∂p + ∂r_j/∂M dM_j/dp ,   dM_{j+1}/dp = ∂C/∂p + ∂C/∂x dx_j/dp + ∂C/∂M dM_j/dp ,   K_j = −∂r_j/∂x .
//! ```
//!
//! Each tangent is factorized once for all parameters. All other derivatives take no solution and are finite
//! differences: for each parameter some problems follow the path with a slightly perturbed value of it. They hold their
//! own `M`, and their vertices are at the positions given by the derivative, so that the differences of their forces,
//! over those of their values, are the right-hand side above. This is the derivative of the computed path, with
//! multipliers as accurate as its corrections.

use voxsoft_solid::vector::{Vec3, axpy, norm, sub};
use voxsoft_solid::{Moment, Problem, RecordedContact, elastic};

use crate::linear::options::LinearOptions;
use crate::linear::options::LinearSolver;
use crate::linear::system::System;
use crate::path::equilibrium::Equilibrium;
use crate::path::load_parameter::LoadParameter;
use crate::sensitivity::adjoint::AdjointError;

/// Relative tolerance of iterative solutions for derivatives, in the energy norm.
const TOLERANCE: f64 = 1e-8;

/// Corrections of derivatives at the end of a step, with its factor: until their relative change is below [`SETTLED`],
/// but at most [`ROUNDS`]; above [`LARGEST_CHANGE`] they count as diverged.
const SETTLED: f64 = 1e-7;
const ROUNDS: u32 = 30;
const LARGEST_CHANGE: f64 = 1e-5;

/// Problem with a slightly perturbed value of a parameter.
#[derive(Debug, Clone)]
pub struct Varied {
    /// The problem.
    pub problem: Problem,
    /// Perturbation of the value.
    pub offset: f64,
    /// Finite-difference weight of a number at this value in its derivative.
    pub weight: f64,
}

/// Positions of the vertices of perturbed problems at the end of a path, to first order, for each parameter and each of
/// its perturbed problems. Their contact then has the corresponding state.
///
/// The `moments` are those of a path of load control that [`RecordedContact`] recorded, and `factors` the load factors
/// of its steps. The tangent may take `memory` bytes; `stop` is polled between the steps of the work.
pub fn sensitivities<C: RecordedContact>(
    problem: &Problem,
    moments: &[Moment<C::Memory>],
    factors: &[f64],
    parameters: &mut [Vec<Varied>],
    memory: u64,
    stop: &mut dyn FnMut() -> bool,
) -> Result<Vec<Vec<Vec<Vec3>>>, AdjointError> {
    let options = LinearOptions {
        solver: LinearSolver::Auto,
        memory,
    };
    for varied in parameters.iter_mut().flatten() {
        let rest = varied.problem.body().rest().to_vec();
        contact_of::<C>(&mut varied.problem)?.reset(&rest);
    }
    let mut equilibrium = Equilibrium::new(problem.clone(), options)?;
    let mut ends = Vec::new();
    let mut steps = factors.iter();
    let mut point = LoadParameter::all(0.0);
    let mut begins = true;
    for (number, moment) in moments.iter().enumerate() {
        if std::mem::replace(&mut begins, moment.settled) {
            point = LoadParameter::all(*steps.next().unwrap_or(&1.0));
        }
        if contact_of::<C>(&mut equilibrium.problem)?.recall(moment) {
            equilibrium.system = System::new(&equilibrium.problem, &equilibrium.held, options)?;
        }
        let problem = &equilibrium.problem;
        let system = &mut equilibrium.system;
        let mut unused = vec![0.0; system.size()];
        system.assemble(
            problem,
            &moment.positions,
            &point.factor_of(),
            None,
            None,
            &mut unused,
        );
        if stop() {
            return Err(AdjointError::Cancelled);
        }
        let factor = system.factor(0.0)?;
        ends.clear();
        let again = Moment {
            settled: false,
            ..moment.clone()
        };
        for parameter in parameters.iter_mut() {
            let mut before: Vec<Vec3> = Vec::new();
            let mut round = 0;
            let places = loop {
                let mut side = vec![0.0; system.size()];
                let mut places = Vec::with_capacity(parameter.len());
                let mut carried = 0.0f64;
                for varied in parameter.iter_mut() {
                    contact_of::<C>(&mut varied.problem)?.face_as(moment);
                    let mut positions = moment.positions.clone();
                    varied
                        .problem
                        .place_clamps(point.time, point.dead, &mut positions);
                    let forces = system.gather(&net_forces(&varied.problem, &positions, point));
                    for (side, force) in side.iter_mut().zip(forces) {
                        *side += varied.weight * force;
                    }
                    let moves = positions.iter().zip(&moment.positions);
                    let farthest = moves.map(|(x, own)| norm(sub(*x, *own)));
                    carried = carried.max(farthest.fold(0.0, f64::max) / varied.offset.abs());
                    places.push(positions);
                }
                system.solve(&factor, &mut side, false, TOLERANCE, stop)?;
                if !side.iter().all(|x| x.is_finite()) {
                    return Err(AdjointError::Singular);
                }
                let slopes = system.spread(&side);
                for (varied, positions) in parameter.iter().zip(&mut places) {
                    for (x, slope) in positions.iter_mut().zip(&slopes) {
                        axpy(x, varied.offset, *slope);
                    }
                }
                let change = change(&before, &slopes, carried);
                if !moment.settled || change <= SETTLED {
                    break places;
                }
                if round == ROUNDS {
                    if change > LARGEST_CHANGE {
                        return Err(AdjointError::Unsettled);
                    }
                    break places;
                }
                C::follow_on(
                    &mut contacts::<C>(parameter)?,
                    &places,
                    &again,
                    Some(&again),
                );
                before = slopes;
                round += 1;
            };
            let next = moments.get(number + 1);
            C::follow_on(&mut contacts::<C>(parameter)?, &places, moment, next);
            ends.push(places);
        }
    }
    Ok(ends)
}

/// Contact of a problem, of the recorded kind.
pub(crate) fn contact_of<C: RecordedContact>(
    problem: &mut Problem,
) -> Result<&mut C, AdjointError> {
    let contact = problem.contact_mut().ok_or(AdjointError::Unsettled)?;
    let found = contact.found_by_mut().downcast_mut();
    found.ok_or(AdjointError::Unsettled)
}

/// Contacts of perturbed problems.
fn contacts<C: RecordedContact>(group: &mut [Varied]) -> Result<Vec<&mut C>, AdjointError> {
    group
        .iter_mut()
        .map(|varied| contact_of(&mut varied.problem))
        .collect()
}

/// Largest change of derivatives, relative to the largest one or to the motion of clamps and objects (`carried`),
/// beside which the derivatives of the body may be nothing but rounding; infinite without a previous value.
fn change(before: &[Vec3], now: &[Vec3], carried: f64) -> f64 {
    let largest = |all: &[f64]| all.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    if before.is_empty() {
        return f64::INFINITY;
    }
    let (before, now) = (before.as_flattened(), now.as_flattened());
    let moved: Vec<f64> = before.iter().zip(now).map(|(a, b)| a - b).collect();
    let size = largest(now).max(carried);
    if size > 0.0 {
        largest(&moved) / size
    } else {
        0.0
    }
}

/// Net forces (N) at `positions` without inertia.
pub(crate) fn net_forces(problem: &Problem, positions: &[Vec3], point: LoadParameter) -> Vec<Vec3> {
    let mut net = vec![[0.0; 3]; positions.len()];
    problem.add_scaled_loads(positions, &point.factor_of(), &mut net);
    elastic::add_forces(problem.body(), positions, &mut net);
    net
}
