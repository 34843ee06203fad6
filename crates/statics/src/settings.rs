use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Memory, Observer, Problem, Solution, Solver, State, Status};

use crate::path::{Start, solve};
use crate::point::Point;

/// How a load path is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// All loads and motions grow together to their full values.
    Load,
    /// Loads and motions are those that their histories have at an instant, as if nothing had mass.
    Time {
        /// The instant in s of the equilibrium that it starts from; without one, loads and motions grow together to
        /// those of the end.
        from: Option<f64>,
        /// The instant in s at the end.
        to: f64,
        /// The longest step, as a part of the way, where the answer depends on the way.
        longest: f64,
    },
    /// Loads and motions grow as with [`Control::Load`], but steps are measured along the path in displacements and loads, so that it is
    /// followed through snaps, where the load falls. Ends at the full load, or after `steps`.
    ArcLength {
        /// The most steps to take.
        steps: u32,
    },
    /// Dead loads first, then the volume that pressures work on grows to `ratio` times what it is
    /// without pressure, and the pressure is an unknown: balloons are followed past their limit.
    Volume {
        /// The volume at the end over that at the start.
        ratio: f64,
        /// The number of steps.
        steps: u32,
    },
}

/// How the linear systems of Newton's method are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinearSolver {
    /// By the number of vertices: directly where that is quicker.
    Auto,
    /// With a sparse factor.
    Direct,
    /// By conjugate gradients with a multigrid preconditioner, where the body is made of equal voxels
    /// and its loads have a potential; else directly.
    Iterative,
}

/// Settings of [`crate::solve`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Equilibrium is where the residual force over the loads (or, without loads, over the reactions)
    /// is below this.
    pub tolerance: f64,
    /// Newton iterations for one step of the path; more than this and the step is cut.
    pub max_iterations: u32,
    /// The first step, as a part of the full load, of which one tries all at once; with
    /// [`Control::ArcLength`] the first arc, in twentieths of the body's size.
    pub first_step: f64,
    /// Steps below this part of the full load are not tried.
    pub least_step: f64,
    /// How the path is followed.
    pub control: Control,
    /// How linear systems are solved. Arc length, and volume control with contact, take the direct way: past a limit the
    /// tangent is indefinite, and where contact goes astray is told from the signs of its pivots.
    pub linear: LinearSolver,
    /// The bytes that the tangent may take.
    pub memory: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 30,
            first_step: 1.0,
            least_step: 1e-3,
            control: Control::Load,
            linear: LinearSolver::Auto,
            memory: u64::MAX,
        }
    }
}

impl Solver for Settings {
    fn name(&self) -> &'static str {
        "statics"
    }

    fn solve(
        &self,
        problem: &Problem,
        start: Option<&[Vec3]>,
        observer: &mut Observer<'_>,
    ) -> Solution {
        let start = start.map(|positions| Start {
            positions: positions.to_vec(),
            pressures: None,
        });
        let answer = solve(problem, start.as_ref(), self, observer);
        Solution {
            state: State {
                positions: answer.positions,
                ..State::at_rest(problem.body())
            },
            memory: answer.memory,
            status: answer.status,
            residual: answer.residual,
            steps: u64::from(answer.iterations),
            back_offs: answer.back_offs,
            breakdown: None,
        }
    }
}

/// A converged point of the load path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// The factor on loads and motions (on pressures only, for [`Control::Volume`]).
    pub factor: f64,
    /// Newton iterations it took.
    pub iterations: u32,
    /// The relative residual.
    pub residual: f64,
    /// Whether the equilibrium is stable: its tangent is positive definite.
    pub stable: bool,
}

/// The equilibrium, or the last one that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Positions in m.
    pub positions: Vec<Vec3>,
    /// How it ended.
    pub status: Status,
    /// The factor on loads at `positions`: one if all of the load is carried.
    pub factor: f64,
    /// The same on loads that are no pressure, which [`Control::Volume`] holds while pressures vary.
    pub dead_factor: f64,
    /// The instant of all histories in s; without end where they are over.
    pub time: f64,
    /// How much of the way that was asked for lies behind: of the load, or with [`Control::Volume`] of
    /// the growth in volume. One at the end of it.
    pub reached: f64,
    /// The relative residual.
    pub residual: f64,
    /// Newton iterations in all.
    pub iterations: u32,
    /// Steps of the path that were cut.
    pub back_offs: u32,
    /// All converged points.
    pub path: Vec<PathPoint>,
    /// The load factors at which the body snapped to another equilibrium, with contact.
    pub snaps: Vec<f64>,
    /// The largest load factor of a path that turned back, if it did.
    pub limit: Option<f64>,
    /// Whether the equilibrium at `positions` is stable.
    pub stable: bool,
    /// The memory of the problem at `positions`, besides contact.
    pub memory: Memory,
}

impl Answer {
    /// The factor on a load at the positions that were reached.
    pub fn factor_of(&self, load: &Load) -> f64 {
        let point = Point {
            time: self.time,
            ..Point::of(self.dead_factor, self.factor)
        };
        point.factor_of()(load)
    }
}
