use voxsoft_solid::balance::Balance;
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Breakdown, Problem, Solution, State, Status};

/// Answer of a run: the last good state and statistics of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The last good state.
    pub state: State,
    /// Status at the end of the run.
    pub status: Status,
    /// Relative residual force, dimensionless, see [`voxsoft_solid::balance::Balance`].
    pub residual: f64,
    /// Substeps (dynamics) or steps (relaxation) taken, repeated ones counted.
    pub steps: u64,
    /// Number of halvings of the step.
    pub back_offs: u32,
    /// The last substep in s; zero for relaxation, which has no physical time.
    pub substep: f64,
    /// Place and time of the breakdown, for [`Status::Diverged`].
    pub breakdown: Option<Breakdown>,
}

impl Answer {
    pub(crate) fn into_solution(self, problem: &Problem) -> Solution {
        let mut problem = problem.clone();
        problem.begin(self.state.time);
        Solution {
            memory: problem.memory(),
            state: self.state,
            status: self.status,
            residual: self.residual,
            steps: self.steps,
            back_offs: self.back_offs,
            breakdown: self.breakdown,
        }
    }
}

/// Start state: the rest pose, or given positions in m.
pub(crate) fn start_at(problem: &Problem, positions: Option<&[Vec3]>) -> State {
    let mut state = State::at_rest(problem.body());
    if let Some(positions) = positions {
        state.positions.copy_from_slice(positions);
    }
    state
}

/// Most halvings of the step before a run counts as diverged.
pub(crate) const MAX_BACK_OFFS: u32 = 10;

/// Residual over loads and reactions above which a step has blown up, as no sound motion reaches it. Unstable steps
/// pass 1e3 within a few dozen steps; the sound transients in the tests stay under 10.
pub(crate) const BLOW_UP_EXCESS: f64 = 300.0;

/// Strain whose forces count as loads of a moving body that no clamp holds, which may turn or vibrate without any load
/// or reaction. A rubber bar that turns so fast that it is strained by some 1e-3 has unbalanced forces of 3 % of those
/// of this strain.
const FREE_STRAIN: f64 = 1e-3;

/// Excess of a body in motion, which exceeds [`BLOW_UP_EXCESS`] only in a step that blows up.
pub(crate) fn excess_in_motion(problem: &Problem, balance: &Balance) -> f64 {
    let held = problem.held().as_flattened().contains(&true);
    let strain = if held { 0.0 } else { FREE_STRAIN };
    let moving = strain * problem.body().unit_strain_force();
    balance.residual / balance.largest.max(moving)
}
