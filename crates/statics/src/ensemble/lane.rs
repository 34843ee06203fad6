//! Progress of one candidate on its load path: the adaptive steps of [`crate::solve`], except that the whole load is
//! always tried first.

use voxsoft_solid::vector::Vec3;

use crate::path::equilibrium::{MIXED_ITERATIONS, PATIENCE, is_standstill};
use crate::path::load_path::{EASY, UNSTABLE_CUTS};

/// Smallest step, as a part of the full load.
const LEAST_STEP: f64 = 1e-3;
/// Largest move of a vertex in one step, in sizes of the body.
const FARTHEST: f64 = 20.0;

/// Assessment of the forces at some positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    /// Equilibrium; its stability has to be tested.
    Balanced,
    /// Not in equilibrium: the next step follows.
    Open,
    /// Newton's method has diverged.
    Lost,
}

/// Candidate in progress.
pub(super) struct Lane {
    pub candidate: usize,
    /// Last equilibrium, in m, and the part of the load that it carries.
    pub saved: Vec<Vec3>,
    pub carried: f64,
    /// Part of the load that is being tried.
    pub tried: f64,
    step: f64,
    /// Norm of the full external forces and the forces of a negligible strain, in N.
    full: f64,
    negligible: f64,
    /// Newton steps at this part of the load, and in total.
    pub here: u32,
    pub iterations: u32,
    pub back_offs: u32,
    pub residual: f64,
    lowest: f64,
    since_lowest: u32,
    unstable_cuts: u32,
    stands_still: bool,
}

impl Lane {
    pub fn new(candidate: usize, rest: &[Vec3], full: f64, negligible: f64) -> Self {
        Self {
            candidate,
            saved: rest.to_vec(),
            carried: 0.0,
            tried: 1.0,
            step: 1.0,
            full,
            negligible,
            here: 0,
            iterations: 0,
            back_offs: 0,
            residual: f64::INFINITY,
            lowest: f64::INFINITY,
            since_lowest: 0,
            unstable_cuts: 0,
            stands_still: false,
        }
    }

    /// Assesses the norm (N) of the residual on free coordinates.
    pub fn look(&mut self, norm: f64, tolerance: f64) -> Look {
        self.residual = norm / f64::max(self.tried * self.full, self.negligible);
        if !self.residual.is_finite() {
            return Look::Lost;
        }
        if self.residual <= tolerance || self.stands_still {
            return Look::Balanced;
        }
        self.since_lowest += 1;
        if self.residual < 0.5 * self.lowest {
            (self.lowest, self.since_lowest) = (self.residual, 0);
        }
        if self.since_lowest > PATIENCE || self.here > MIXED_ITERATIONS {
            return Look::Lost;
        }
        Look::Open
    }

    /// Assesses a step from the sum and the largest of the squares (m²) of the moves of vertices, and their distance
    /// from rest (m); returns true if Newton's method may take it.
    pub fn took(&mut self, sum: f64, largest: f64, size: f64, moved: f64) -> bool {
        self.here += 1;
        self.iterations += 1;
        let largest = largest.sqrt();
        self.stands_still = is_standstill(self.residual, largest, size, moved);
        sum.is_finite() && largest < FARTHEST * size
    }

    /// Accepts an equilibrium, and sets the next part of the load; returns `false` if all of it is carried.
    pub fn accept(&mut self) -> bool {
        self.carried = self.tried;
        if self.here <= EASY {
            self.step *= 2.0;
        }
        self.tried = (self.carried + self.step).min(1.0);
        self.begin();
        self.carried < 1.0
    }

    /// Decides if an unstable state is tried again with a shorter step: a long one may reach a branch that the path
    /// does not lead to.
    pub fn refuses_unstable(&mut self) -> bool {
        self.unstable_cuts += 1;
        self.unstable_cuts <= UNSTABLE_CUTS
    }

    /// Goes back to the last equilibrium and cuts the step; returns `false` if it is too short already.
    pub fn cut(&mut self) -> bool {
        self.back_offs += 1;
        self.step = (self.tried - self.carried) / 4.0;
        self.tried = self.carried + self.step;
        self.begin();
        self.step >= LEAST_STEP
    }

    fn begin(&mut self) {
        self.here = 0;
        (self.lowest, self.since_lowest) = (f64::INFINITY, 0);
        self.stands_still = false;
    }
}
