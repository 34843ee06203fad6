//! Algorithm 3: substeps of prediction and constraint projection in real time.

mod grab;
mod live;
mod membrane_inertia;
mod on_strips;
mod on_vertices;
mod stiff_inertia;

use std::ops::ControlFlow;

use voxsoft_solid::balance::{Balance, is_still};
use voxsoft_solid::breakdown::{Breakdown, Reach};
use voxsoft_solid::lattice::strips::Strips;
use voxsoft_solid::loads::grabs::loads_end;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Damping, Grab, Observer, Problem, Progress, Solution, Solver, State, Status};

use self::stiff_inertia::StiffInertia;
use crate::outcome::{Answer, BLOW_UP_EXCESS, MAX_BACK_OFFS, excess_in_motion, start_at};
use crate::stiffness::{Membranes, largest_eigenvalue};

pub use live::Live;

/// Settings of [`simulate`].
#[derive(Debug, Clone, PartialEq)]
pub struct Dynamics {
    /// Length of a step in s, divided into substeps. Longer steps have fewer checks for rest and breakdown.
    pub time_step: f64,
    /// Substeps per step; `None` takes as many as the highest frequency needs.
    pub substeps: Option<u32>,
    /// Sweeps over all constraints per substep. More allow longer substeps.
    pub iterations: u32,
    /// Global damping of all motion.
    pub damping: Damping,
    /// Retardation time `τ` in s of Kelvin–Voigt damping: a constraint responds to `C + τ dC/dt`, and the deviatoric
    /// stress of a hyperelastic voxel is `s + τ ds/dt`.
    pub retardation: f64,
    /// End time of the run in s; `None` runs until rest.
    pub end_time: Option<f64>,
    /// Longest time to wait for rest without an end time, in s.
    pub max_time: f64,
    /// Tolerance of rest: bound on the relative residual force, and on the kinetic energy over the elastic energy.
    pub tolerance: f64,
    /// Takes constraints one at a time with plain arithmetic: the same bits on every processor, WebAssembly included; a
    /// few times slower than with SIMD lanes.
    pub deterministic: bool,
    /// Interval of records by the observer in s (rounded to steps).
    pub record_interval: Option<f64>,
    /// Most bytes of the tangent of implicit steps, for a body that needs them.
    pub memory: u64,
}

impl Default for Dynamics {
    fn default() -> Self {
        Self {
            time_step: 0.01,
            substeps: None,
            iterations: 1,
            damping: Damping::Critical,
            retardation: 0.0,
            end_time: None,
            max_time: 60.0,
            tolerance: 1e-4,
            deterministic: false,
            record_interval: None,
            memory: usize::MAX as u64,
        }
    }
}

/// Default substep times the highest frequency: half the explicit limit.
const SUBSTEP_FREQUENCY: f64 = 1.0;
/// Bound on the default substep times the highest frequency of the body with its membranes taut, though longer substeps
/// are stable ([`membrane_inertia`]): the inertia of mass scaling grows with the fourth power. A bar between membranes
/// of 2,000 times its stiffness is 1.5 % slow with 8 and 0.7 % with 4, most of that due to its voxels; a free body
/// between the two has its angular momentum change by 7 % and 2 %.
const MEMBRANE_FREQUENCY: f64 = 4.0;
/// Damping times after which an oscillation must have shrunk (by `e⁻²` at least).
const WINDOW_DAMPING_TIMES: f64 = 4.0;

/// Runs the problem from `start`.
///
/// When a step blows up, the run goes back to the last good state with twice the substeps. The substeps also double,
/// without going back, when the residual has stopped to fall although damping should have halved it several times over
/// (an unstable step can saturate at a small amplitude).
pub fn simulate(
    problem: &Problem,
    start: State,
    settings: &Dynamics,
    observer: &mut Observer<'_>,
) -> Answer {
    let subject = Subject::alone(problem, settings);
    let strips = strips_of(subject);
    let stiff = StiffInertia::of(problem, settings);
    let substeps = substeps_of(subject, strips.as_ref(), stiff.as_ref());
    let arrays = arrays_of(subject, strips, stiff);
    run(problem.clone(), settings, start, observer, arrays, substeps)
}

impl Solver for Dynamics {
    fn name(&self) -> &'static str {
        "dynamics"
    }

    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution {
        let start = start_at(problem, start);
        simulate(problem, start, self, observer).into_solution(problem)
    }
}

/// Problem, settings and grabs of a run. Its arrays borrow none of it, so that a run that continues between calls can
/// own both.
#[derive(Clone, Copy)]
struct Subject<'a> {
    problem: &'a Problem,
    settings: &'a Dynamics,
    grabs: &'a [Grab],
}

impl<'a> Subject<'a> {
    /// Makes a subject without grabs.
    fn alone(problem: &'a Problem, settings: &'a Dynamics) -> Self {
        Self {
            problem,
            settings,
            grabs: &[],
        }
    }
}

/// Makes strips for bodies that have them.
fn strips_of(
    Subject {
        problem, settings, ..
    }: Subject<'_>,
) -> Option<Strips> {
    let strips = Strips::of(problem.body())?;
    Some(if settings.deterministic {
        strips.deterministic()
    } else {
        strips
    })
}

fn arrays_of(
    subject: Subject<'_>,
    strips: Option<Strips>,
    stiff: Option<StiffInertia>,
) -> Box<dyn Arrays + Send> {
    match strips {
        Some(strips) => Box::new(on_strips::OnStrips::new(subject, strips)),
        None => Box::new(on_vertices::OnVertices::new(subject, stiff)),
    }
}

/// Work arrays of substeps.
trait Arrays {
    /// Restarts from a state.
    fn load(&mut self, state: &State);
    /// Present time in s.
    fn time(&self) -> f64;
    /// Stores the present state.
    fn store(&self, state: &mut State);
    /// Force balance at the present positions, which are those of `state`.
    fn balance(&mut self, subject: Subject<'_>, state: &State) -> Balance;
    /// Takes one substep of `h` seconds.
    fn substep(&mut self, subject: Subject<'_>, h: f64);
    /// Updates loads after their histories have changed.
    fn renew_loads(&mut self, problem: &Problem);
    /// Present rate of damping, in 1/s.
    fn damping_rate(&self) -> f64;
}

fn run(
    mut problem: Problem,
    settings: &Dynamics,
    mut state: State,
    observer: &mut Observer<'_>,
    mut arrays: Box<dyn Arrays + Send>,
    mut substeps: u32,
) -> Answer {
    let reach = Reach::near_rest(&problem);
    // A body whose loads still change is not at rest, even if no force acts yet.
    let steady = loads_end(&problem);
    arrays.load(&state);
    let mut checkpoint = state.clone();
    let (mut steps, mut back_offs) = (0u64, 0u32);
    let mut recorded = -1i64;
    let mut window = Window::default();
    let (status, residual, breakdown) = loop {
        arrays.store(&mut state);
        problem.begin(state.time);
        let now = arrays.balance(Subject::alone(&problem, settings), &state);
        let residual = now.relative_residual();
        let broken = reach.find(&problem, &state.positions, state.time);
        let excess = excess_in_motion(&problem, &now);
        let blown_up = broken.is_some() || excess.is_nan() || excess > BLOW_UP_EXCESS;
        let stuck = !blown_up
            && settings.end_time.is_none()
            && state.time >= steady
            && window.stuck(
                state.time,
                arrays.damping_rate(),
                residual,
                settings.tolerance,
            );
        if (blown_up || stuck) && back_offs < MAX_BACK_OFFS {
            back_offs += 1;
            substeps *= 2;
            if blown_up {
                state.clone_from(&checkpoint);
                arrays.load(&state);
            }
            window = Window::default();
        } else if blown_up {
            let place = broken
                .unwrap_or_else(|| Breakdown::farthest(&problem, &state.positions, state.time));
            state.clone_from(&checkpoint);
            break (Status::Diverged, residual, Some(place));
        } else {
            checkpoint.clone_from(&state);
            let slot = settings
                .record_interval
                .map_or(-1, |interval| (state.time / interval + 1e-9).floor() as i64);
            let record = slot > recorded;
            recorded = recorded.max(slot);
            let progress = Progress {
                problem: &problem,
                steps,
                time: state.time,
                positions: &state.positions,
                velocities: &state.velocities,
                residual,
                record,
            };
            if let ControlFlow::Break(()) = observer(&progress) {
                break (Status::Cancelled, residual, None);
            }
            match settings.end_time {
                Some(end) if state.time >= end * (1.0 - 1e-12) => {
                    break (Status::EndTime, residual, None);
                }
                None if state.time >= steady
                    && at_rest(&problem, &state, residual, settings.tolerance) =>
                {
                    break (Status::AtRest, residual, None);
                }
                None if state.time >= settings.max_time => {
                    break (Status::NotAtRest, residual, None);
                }
                _ => {}
            }
        }
        let left = settings
            .end_time
            .map_or(f64::INFINITY, |end| end - state.time);
        let substep = settings.time_step.min(left) / f64::from(substeps);
        for _ in 0..substeps {
            problem.begin(arrays.time() + substep);
            arrays.substep(Subject::alone(&problem, settings), substep);
        }
        steps += u64::from(substeps);
    };
    Answer {
        state,
        status,
        residual,
        steps,
        back_offs,
        substep: settings.time_step / f64::from(substeps),
        breakdown,
    }
}

fn at_rest(problem: &Problem, state: &State, residual: f64, tolerance: f64) -> bool {
    let kinetic = || state.kinetic_energy(problem.body().masses());
    residual <= tolerance && is_still(problem, &state.positions, kinetic(), tolerance)
}

/// Substeps per step: those of the settings, or as many as the highest frequency needs; membranes count only as far as
/// [`MEMBRANE_FREQUENCY`] limits their mass scaling, and stiff voxels with scaled masses do not.
fn substeps_of(subject: Subject<'_>, strips: Option<&Strips>, stiff: Option<&StiffInertia>) -> u32 {
    let Subject {
        problem, settings, ..
    } = subject;
    if let Some(substeps) = settings.substeps {
        return substeps;
    }
    let masses = problem.body().masses();
    let of = |membranes| largest_eigenvalue(problem, masses, strips, membranes, &[]).sqrt();
    let mut highest = stiff.map_or_else(|| of(Membranes::Apart), StiffInertia::of_the_rest);
    if !problem.body().membranes().is_empty() {
        highest = highest.max(of(Membranes::Taut) / MEMBRANE_FREQUENCY);
    }
    (settings.time_step * highest / SUBSTEP_FREQUENCY)
        .ceil()
        .max(1.0) as u32
}

/// Detector of a residual that no longer falls.
#[derive(Default)]
struct Window {
    start: f64,
    lowest_before: Option<f64>,
    lowest: Option<f64>,
}

impl Window {
    fn stuck(&mut self, time: f64, damping_rate: f64, residual: f64, tolerance: f64) -> bool {
        self.lowest = Some(self.lowest.map_or(residual, |lowest| lowest.min(residual)));
        if damping_rate <= 0.0 || (time - self.start) * damping_rate < 2.0 * WINDOW_DAMPING_TIMES {
            return false;
        }
        let stuck = residual > tolerance
            && matches!((self.lowest_before, self.lowest),
                (Some(before), Some(now)) if now > 0.8 * before);
        *self = Self {
            start: time,
            lowest_before: self.lowest,
            lowest: None,
        };
        stuck
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample_problems::problems;
    use voxsoft_solid::vector::{norm, sub};

    fn run_both(problem: &Problem, settings: &Dynamics) -> [Answer; 2] {
        let start = State::at_rest(problem.body());
        let strips = Strips::of(problem.body());
        assert!(strips.is_some(), "voxels");
        let go_on = &mut |_: &Progress<'_>| ControlFlow::Continue(());
        let subject = Subject::alone(problem, settings);
        [strips, None].map(|strips| {
            let substeps = substeps_of(subject, strips.as_ref(), None);
            let arrays = arrays_of(subject, strips, None);
            run(
                problem.clone(),
                settings,
                start.clone(),
                go_on,
                arrays,
                substeps,
            )
        })
    }

    /// Largest distance between two answers over the largest displacement.
    fn distance(problem: &Problem, [fast, slow]: &[Answer; 2]) -> f64 {
        let rest = problem.body().rest();
        let (mut apart, mut moved) = (0.0, 0.0);
        for (v, rest) in rest.iter().enumerate() {
            let (a, b) = (fast.state.positions[v], slow.state.positions[v]);
            apart = f64::max(apart, norm(sub(a, b)));
            moved = f64::max(moved, norm(sub(b, *rest)));
        }
        apart / moved
    }

    /// Without a sweep both do the same arithmetic, up to rounding. Sweeps take constraints in different orders
    /// (`crates/solid/tests/strips.rs` tests the same order), a difference that vanishes with the step.
    #[test]
    fn strips_and_vertices_agree_in_motion() {
        for (case, problem) in problems().iter().enumerate() {
            for damping in [Damping::Rate(5.0), Damping::Critical] {
                let mut settings = Dynamics {
                    iterations: 0,
                    damping,
                    time_step: 2e-3,
                    end_time: Some(0.02),
                    ..Dynamics::default()
                };
                let same = distance(problem, &run_both(problem, &settings));
                // Rounding of 1e-16 grows over some hundred substeps, to 9e-12 as measured.
                assert!(same < 1e-10, "case {case}, {damping:?}: {same:.1e}");
                settings.iterations = 2;
                settings.retardation = 1e-4;
                let order: Vec<f64> = [100, 200]
                    .map(|substeps| {
                        settings.substeps = Some(substeps);
                        distance(problem, &run_both(problem, &settings))
                    })
                    .into();
                assert!(order[1] < 0.7 * order[0], "case {case}: {order:?}");
            }
        }
    }
}
