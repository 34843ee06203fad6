//! Dynamic relaxation: the short way to the state at rest.

use std::ops::ControlFlow;

use voxsoft_solid::balance::{balance, is_still, rests_on_floor};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, State, elastic};

use crate::damping;
use crate::outcome::{
    Answer, BLOW_UP_EXCESS, Breakdown, MAX_BACK_OFFS, Observer, Progress, Status, farthest,
    find_breakdown, travel_limit,
};
use crate::stiffness::largest_eigenvalue;

/// Settings of [`relax`].
#[derive(Debug, Clone, PartialEq)]
pub struct Relaxation {
    /// Rest is where the relative residual force is below this. The state is then about as close
    /// to the limit, relative to its displacement, since the slowest mode converges last.
    pub tolerance: f64,
    /// Steps after which a run counts as not at rest.
    pub max_steps: u64,
}

impl Default for Relaxation {
    fn default() -> Self {
        Self {
            tolerance: 1e-4,
            max_steps: 400_000,
        }
    }
}

/// Steps between two looks at residual, masses, breakdown and observer.
const LOOK: u64 = 25;
/// Steps over which prescribed motions are brought up, so that no element starts inside out.
const RAMP: u64 = 200;
/// On the largest eigenvalue, which is estimated from below and grows as the body deforms.
const SAFETY: f64 = 1.15;
/// Central differences with a unit step are stable up to this eigenvalue.
const STABLE_EIGENVALUE: f64 = 4.0;
/// Damping per unit step: at 2 a step would forget its velocity.
const MAX_DAMPING: f64 = 1.9;

/// Finds the state at rest under the final values of all loads and motions, from `start`.
///
/// The pseudo-time step is one; the mass of a vertex is its row sum of the stiffness matrix, scaled
/// such that the largest eigenvalue of `M⁻¹K` is `4/1.15`, and renewed as the body deforms.
pub fn relax(
    problem: &Problem,
    start: State,
    settings: &Relaxation,
    observer: &mut Observer<'_>,
) -> Answer {
    let body = problem.body();
    let count = body.rest().len();
    let mut row_sums = vec![0.0; count];
    elastic::row_sums(body, body.rest(), &mut row_sums);
    let mut mass_factor = largest_eigenvalue(problem, &row_sums) * SAFETY / STABLE_EIGENVALUE;
    let moves = problem.clamps().iter().any(|clamp| clamp.motion.is_some());
    let limit = travel_limit(problem);

    let mut state = State {
        time: f64::INFINITY,
        ..start
    };
    state.velocities.fill([0.0; 3]);
    let mut checkpoint = state.clone();
    let mut masses = vec![0.0; count];
    let mut forces = vec![[0.0; 3]; count];
    let mut before = vec![[0.0; 3]; count];
    let (mut step, mut taken, mut checkpoint_step, mut back_offs) = (0u64, 0u64, 0u64, 0);
    let finish = |state: State, status, residual, steps, back_offs, breakdown| Answer {
        state: State { time: 0.0, ..state },
        status,
        residual,
        steps,
        back_offs,
        substep: 0.0,
        breakdown,
    };

    loop {
        let ramp = if moves {
            (step as f64 / RAMP as f64).min(1.0)
        } else {
            1.0
        };
        if step.is_multiple_of(LOOK) {
            let look = balance(problem, &state.positions, state.time);
            let broken: Option<Breakdown> =
                find_breakdown(problem, &state.positions, limit, taken as f64);
            let residual = look.relative_residual();
            let excess = look.excess();
            if broken.is_some() || excess.is_nan() || excess > BLOW_UP_EXCESS {
                let broken =
                    broken.unwrap_or_else(|| farthest(problem, &state.positions, taken as f64));
                // A body that grows past all bounds while forces stay moderate is not an unstable
                // step: the material cannot carry the load.
                let runaway = excess < BLOW_UP_EXCESS;
                if runaway || back_offs == MAX_BACK_OFFS {
                    let status = Status::Diverged;
                    return finish(checkpoint, status, residual, taken, back_offs, Some(broken));
                }
                back_offs += 1;
                mass_factor *= 4.0;
                state.clone_from(&checkpoint);
                state.velocities.fill([0.0; 3]);
                step = checkpoint_step;
                before.fill([0.0; 3]);
            } else {
                elastic::row_sums(body, &state.positions, &mut row_sums);
                for (mass, sum) in masses.iter_mut().zip(&row_sums) {
                    *mass = mass_factor * sum;
                }
                let kinetic = state.kinetic_energy(&masses);
                let settled = is_still(problem, &state.positions, kinetic, settings.tolerance);
                if ramp == 1.0 && residual <= settings.tolerance && settled {
                    return finish(state, Status::AtRest, residual, taken, back_offs, None);
                }
                if taken >= settings.max_steps {
                    return finish(state, Status::NotAtRest, residual, taken, back_offs, None);
                }
                checkpoint.clone_from(&state);
                checkpoint_step = step;
            }
            let progress = Progress {
                steps: taken,
                state: &state,
                residual,
                record: false,
            };
            if let ControlFlow::Break(()) = observer(&progress) {
                return finish(
                    checkpoint,
                    Status::Cancelled,
                    residual,
                    taken,
                    back_offs,
                    None,
                );
            }
        }

        problem.place_clamps(state.time, ramp, &mut state.positions);
        forces.fill([0.0; 3]);
        problem.add_loads(&state.positions, state.time, &mut forces);
        elastic::add_forces(body, &state.positions, &mut forces);
        release_supported(problem, &state.positions, &mut forces);
        let frequency = damping::frequency(&state.velocities, &before, &forces, &masses, 1.0);
        let rate = (2.0 * frequency).min(MAX_DAMPING);
        before.clone_from(&forces);
        advance(problem, &mut state, &forces, &masses, rate);
        step += 1;
        taken += 1;
    }
}

/// Removes the forces that clamps and floor carry.
fn release_supported(problem: &Problem, positions: &[Vec3], forces: &mut [Vec3]) {
    for (vertex, force) in forces.iter_mut().enumerate() {
        for axis in 0..3 {
            if problem.held()[vertex][axis]
                || rests_on_floor(problem, vertex, axis, positions, force[axis])
            {
                force[axis] = 0.0;
            }
        }
    }
}

/// One central-difference step of unit length with damping `rate`, velocities at half steps.
fn advance(problem: &Problem, state: &mut State, forces: &[Vec3], masses: &[f64], rate: f64) {
    let keep = (2.0 - rate) / (2.0 + rate);
    let gain = 2.0 / (2.0 + rate);
    for vertex in 0..forces.len() {
        for axis in 0..3 {
            let velocity = &mut state.velocities[vertex][axis];
            *velocity = keep * *velocity + gain * forces[vertex][axis] / masses[vertex];
            if problem.held()[vertex][axis] {
                *velocity = 0.0;
            }
            state.positions[vertex][axis] += *velocity;
        }
        if let Some(floor) = problem.floor()
            && state.positions[vertex][2] < floor.z
            && !problem.held()[vertex][2]
        {
            state.positions[vertex][2] = floor.z;
            state.velocities[vertex][2] = 0.0;
        }
    }
}
