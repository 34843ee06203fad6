//! Floor, and other supports of single vertices: clamps and hands.

use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Grab, Problem};

use super::QuasiNewton;
use super::objective::Value;
use crate::motion::run::Run;

/// Stiffness of the floor under a vertex that rests on it, over the inertia of the vertex.
const FLOOR_STIFFNESS: f64 = 1e8;

impl QuasiNewton {
    /// Moves vertices of clamps and floor to their targets.
    pub(super) fn place(&self, problem: &Problem, time: f64, positions: &mut [Vec3]) {
        problem.place_clamps(time, 1.0, positions);
        let Some(floor) = problem.floor() else {
            return;
        };
        for (vertex, x) in positions.iter_mut().enumerate() {
            if !problem.held()[vertex][2] {
                x[2] = if self.carried[vertex] {
                    floor.z
                } else {
                    floor.stop(x[2])
                };
            }
        }
    }

    /// Springs on free coordinates.
    pub(super) fn springs(&self, run: &Run, inertia: f64, grabs: &[Grab]) -> Vec<f64> {
        let Some(lagged) = &self.lagged else {
            return Vec::new();
        };
        let mut springs = vec![0.0; lagged.size()];
        for grab in grabs {
            for axis in 0..3 {
                if let Some(row) = lagged.row_of(grab.vertex as usize, axis) {
                    springs[row] += grab.stiffness;
                }
            }
        }
        let masses = run.problem.body().masses();
        for (vertex, _) in self.carried.iter().enumerate().filter(|(_, c)| **c) {
            if let Some(row) = lagged.row_of(vertex, 2) {
                springs[row] += FLOOR_STIFFNESS * inertia * masses[vertex];
            }
        }
        springs
    }

    /// Updates the active set of the floor: catches vertices below it and releases those that it pulls; returns true if
    /// any changed.
    pub(super) fn touch_floor(
        &mut self,
        problem: &Problem,
        positions: &mut [Vec3],
        value: &Value,
    ) -> bool {
        let Some(floor) = problem.floor() else {
            return false;
        };
        let slack = 1e-9 * problem.body().size();
        let mut changed = false;
        for (vertex, x) in positions.iter_mut().enumerate() {
            if problem.held()[vertex][2] {
                continue;
            }
            let keep = floor.keeps(self.carried[vertex], x[2], value.net[vertex][2], slack);
            if keep {
                x[2] = floor.z;
            }
            changed |= keep != self.carried[vertex];
            self.carried[vertex] = keep;
        }
        changed
    }
}
