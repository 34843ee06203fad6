use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Load, Memory, Status};

use crate::linear::options::LinearSolver;
use crate::path::load_parameter::LoadParameter;

/// Control of a load path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// All loads and motions grow together to their full values.
    Load,
    /// Loads and motions are those of their histories at an instant, as if all were massless (quasi-static).
    Time {
        /// Instant in s of the equilibrium from which it starts; without one, loads and motions grow together to those
        /// of the end.
        from: Option<f64>,
        /// Instant in s at the end.
        to: f64,
        /// Longest step, as a part of the path, of path-dependent problems.
        longest: f64,
    },
    /// Like [`Control::Time`], with the viscous stress of Prony branches integrated over the time.
    Creep {
        /// Instant in s of the state from which it starts, with its viscous stress. Without one, loads and motions grow
        /// suddenly to those at zero, from which it starts.
        from: Option<f64>,
        /// Instant in s at the end.
        to: f64,
        /// Longest step, as a part of the path, of path-dependent problems.
        longest: f64,
    },
    /// Loads and motions grow like with [`Control::Load`], but steps are measured along the path in displacements and
    /// loads, so that it is followed through snaps, where the load falls. Ends at the full load, or after `steps`.
    ArcLength {
        /// Most steps.
        steps: u32,
    },
    /// Dead loads first, then the volume on which pressures work grows to `ratio` times its value without pressure, and
    /// the pressure is an unknown: balloons are followed past their limit.
    Volume {
        /// Ratio of the volume at the end to that at the start.
        ratio: f64,
        /// Number of steps.
        steps: u32,
    },
}

/// Settings of [`crate::solve`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Relative tolerance of equilibrium: residual force over the loads (or, without loads, over the reactions).
    pub tolerance: f64,
    /// Most Newton iterations of one step of the path; beyond that the step is cut.
    pub max_iterations: u32,
    /// First step, as a part of the full load; 1 tries all at once. With [`Control::ArcLength`] the first arc, in
    /// twentieths of the body's size.
    pub first_step: f64,
    /// Smallest step, as a part of the full load.
    pub least_step: f64,
    /// Control of the path.
    pub control: Control,
    /// Linear solver. Arc length, and volume control with contact, use the direct solver: past a limit the tangent is
    /// indefinite, and divergence of contact is detected by the signs of its pivots.
    pub linear: LinearSolver,
    /// Most bytes of the tangent.
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

/// Converged point of the load path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Factor on loads and motions (on pressures only, for [`Control::Volume`]).
    pub factor: f64,
    /// Newton iterations of the point.
    pub iterations: u32,
    /// Relative residual.
    pub residual: f64,
    /// True if the equilibrium is stable: its tangent is positive definite.
    pub stable: bool,
}

/// Equilibrium, or the last one that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Positions in m.
    pub positions: Vec<Vec3>,
    /// Status at the end.
    pub status: Status,
    /// Factor on loads at `positions`: one if all of the load is carried.
    pub factor: f64,
    /// Factor on loads other than pressures, which [`Control::Volume`] holds while pressures vary.
    pub dead_factor: f64,
    /// Instant of all histories in s; infinite after their end.
    pub time: f64,
    /// Fraction of the requested path that was reached: of the load, or with [`Control::Volume`] of the growth in
    /// volume. One at the end of it.
    pub reached: f64,
    /// Relative residual.
    pub residual: f64,
    /// Newton iterations in all.
    pub iterations: u32,
    /// Steps of the path that were cut.
    pub back_offs: u32,
    /// All converged points.
    pub path: Vec<PathPoint>,
    /// Load factors at which the body snapped to another equilibrium.
    pub snaps: Vec<f64>,
    /// Limit load factor, the largest one of a path that turned back, if it did.
    pub limit: Option<f64>,
    /// True if the equilibrium at `positions` is stable.
    pub stable: bool,
    /// Memory of the problem at `positions`.
    pub memory: Memory,
}

impl Answer {
    /// Factor on a load at the positions that were reached.
    pub fn factor_of(&self, load: &Load) -> f64 {
        let point = LoadParameter {
            time: self.time,
            ..LoadParameter::of(self.dead_factor, self.factor)
        };
        point.factor_of()(load)
    }
}
