//! Dynamic relaxation to the equilibrium.

mod on_strips;
mod on_vertices;

use std::ops::ControlFlow;

use voxsoft_solid::balance::{Balance, is_still};
use voxsoft_solid::breakdown::{Breakdown, travel_limit};
use voxsoft_solid::lattice::strips::Strips;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Observer, Problem, Progress, Solution, Solver, State, Status, elastic};

use crate::outcome::{Answer, BLOW_UP_EXCESS, MAX_BACK_OFFS, start_at};
use crate::stiffness::{Membranes, largest_eigenvalue};

/// Settings of [`relax`].
#[derive(Debug, Clone, PartialEq)]
pub struct Relaxation {
    /// Tolerance of rest on the relative residual force. The state is then about as close to the equilibrium, relative
    /// to its displacement, since the slowest mode converges last.
    pub tolerance: f64,
    /// Most steps, after which a run counts as not at rest.
    pub max_steps: u64,
    /// Trial that leaves a slowly converging body to another solver.
    pub trial: Option<Trial>,
}

/// Trial period of a run, after which slow convergence ends it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Steps of the trial; the first check after them decides.
    pub steps: u64,
    /// Relative residual above which the run then ends with [`Status::Slow`]. Any other run continues as without a
    /// trial.
    pub residual: f64,
}

impl Default for Relaxation {
    fn default() -> Self {
        Self {
            tolerance: 1e-4,
            max_steps: 400_000,
            trial: None,
        }
    }
}

/// Steps between two checks of residual and breakdown, updates of masses, and calls of the observer.
const LOOK: u64 = 25;
/// Steps over which prescribed motions are ramped up, so that no element starts inverted.
const RAMP: u64 = 200;
/// Safety factor on the largest eigenvalue, which is estimated from below and grows as the body deforms.
const SAFETY: f64 = 1.15;
/// Largest eigenvalue for which central differences with a unit step are stable.
const STABLE_EIGENVALUE: f64 = 4.0;
/// Largest damping per unit step: at 2 a step would lose all of its velocity.
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
    match Strips::of(problem.body()) {
        Some(strips) => {
            let arrays = on_strips::OnStrips::new(problem, &strips);
            run(problem, start, settings, observer, arrays, Some(&strips))
        }
        None => {
            let arrays = on_vertices::OnVertices::new(problem);
            run(problem, start, settings, observer, arrays, None)
        }
    }
}

impl Solver for Relaxation {
    fn name(&self) -> &'static str {
        "relaxation"
    }

    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution {
        let start = start_at(problem, start);
        relax(problem, start, self, observer).into_solution(problem)
    }
}

/// Work arrays of steps.
trait Arrays {
    /// Restarts from a state.
    fn load(&mut self, state: &State);
    /// Stores the present positions and velocities.
    fn store(&self, state: &mut State);
    /// Force balance at the present positions, which are those of `state`.
    fn balance(&mut self, state: &State) -> Balance;
    /// Sets the masses to `factor` times the row sums at the present positions (kg per unit of time squared).
    fn renew_masses(&mut self, factor: f64);
    /// Kinetic energy in J.
    fn kinetic_energy(&self) -> f64;
    /// Takes one step, with prescribed motions scaled by `ramp`.
    fn step(&mut self, ramp: f64);
}

fn run(
    problem: &Problem,
    start: State,
    settings: &Relaxation,
    observer: &mut Observer<'_>,
    mut arrays: impl Arrays,
    strips: Option<&Strips>,
) -> Answer {
    let body = problem.body();
    let mut row_sums = vec![0.0; body.rest().len()];
    elastic::row_sums(body, body.rest(), &mut row_sums);
    let eigenvalue = largest_eigenvalue(problem, &row_sums, strips, Membranes::Taut, &[]);
    let mut mass_factor = eigenvalue * SAFETY / STABLE_EIGENVALUE;
    let moves = problem.clamps().iter().any(|clamp| clamp.motion.is_some());
    let limit = travel_limit(problem);

    let mut state = State {
        time: f64::INFINITY,
        ..start
    };
    state.velocities.fill([0.0; 3]);
    let mut checkpoint = state.clone();
    arrays.load(&state);
    let mut trial = settings.trial;
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
            arrays.store(&mut state);
            let look = arrays.balance(&state);
            let broken: Option<Breakdown> =
                Breakdown::find(problem, &state.positions, limit, taken as f64);
            let residual = look.relative_residual();
            let excess = look.excess();
            if broken.is_some() || excess.is_nan() || excess > BLOW_UP_EXCESS {
                let broken = broken.unwrap_or_else(|| {
                    Breakdown::farthest(problem, &state.positions, taken as f64)
                });
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
                arrays.load(&state);
            } else {
                arrays.renew_masses(mass_factor);
                let settled = || {
                    let kinetic = arrays.kinetic_energy();
                    is_still(problem, &state.positions, kinetic, settings.tolerance)
                };
                if ramp == 1.0 && residual <= settings.tolerance && settled() {
                    return finish(state, Status::AtRest, residual, taken, back_offs, None);
                }
                if let Some(due) = trial.take_if(|due| taken >= due.steps)
                    && residual > due.residual
                {
                    return finish(state, Status::Slow, residual, taken, back_offs, None);
                }
                if taken >= settings.max_steps {
                    return finish(state, Status::NotAtRest, residual, taken, back_offs, None);
                }
                checkpoint.clone_from(&state);
                checkpoint_step = step;
            }
            let progress = Progress {
                problem,
                steps: taken,
                time: state.time,
                positions: &state.positions,
                velocities: &state.velocities,
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

        arrays.step(ramp);
        step += 1;
        taken += 1;
    }
}

/// Factors of a unit step on velocity and acceleration, with damping critical for the given frequency.
fn damped(frequency: f64) -> (f64, f64) {
    let rate = (2.0 * frequency).min(MAX_DAMPING);
    ((2.0 - rate) / (2.0 + rate), 2.0 / (2.0 + rate))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample_problems::problems;
    use voxsoft_solid::vector::{norm, sub};

    #[test]
    fn trial_ends_slow_runs_only() {
        for problem in &problems() {
            let run = |trial| {
                let settings = Relaxation {
                    trial,
                    ..Relaxation::default()
                };
                relax(
                    problem,
                    State::at_rest(problem.body()),
                    &settings,
                    &mut |_| ControlFlow::Continue(()),
                )
            };
            let whole = run(None);
            let trial = |residual| {
                Some(Trial {
                    steps: 2 * LOOK,
                    residual,
                })
            };
            assert!(whole.steps > 2 * LOOK);
            assert_eq!(run(trial(f64::INFINITY)), whole);
            let slow = run(trial(0.0));
            assert_eq!((slow.status, slow.steps), (Status::Slow, 2 * LOOK));
        }
    }

    #[test]
    fn strips_and_vertices_reach_the_same_equilibrium() {
        let settings = Relaxation {
            tolerance: 1e-8,
            max_steps: 20_000,
            trial: None,
        };
        for (case, problem) in problems().iter().enumerate() {
            let start = State::at_rest(problem.body());
            let strips = Strips::of(problem.body()).expect("voxels");
            let go_on = &mut |_: &Progress<'_>| ControlFlow::Continue(());
            let fast = on_strips::OnStrips::new(problem, &strips);
            let fast = run(
                problem,
                start.clone(),
                &settings,
                go_on,
                fast,
                Some(&strips),
            );
            let slow = on_vertices::OnVertices::new(problem);
            let slow = run(problem, start, &settings, go_on, slow, None);
            assert_eq!((fast.status, slow.status), (Status::AtRest, Status::AtRest));
            assert_eq!(fast.steps, slow.steps);
            let rest = problem.body().rest();
            let moved = |answer: &Answer, v: usize| sub(answer.state.positions[v], rest[v]);
            let largest = (0..rest.len())
                .map(|v| norm(moved(&slow, v)))
                .fold(0.0, f64::max);
            for v in 0..rest.len() {
                // Both take the same steps, up to rounding of 1e-16 in some thousand of them.
                let error = norm(sub(moved(&fast, v), moved(&slow, v))) / largest;
                assert!(error < 1e-10, "case {case}: {error:.1e} at vertex {v}");
            }
        }
    }
}
