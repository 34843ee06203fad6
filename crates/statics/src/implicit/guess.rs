//! Where the search for the end of a step begins.

use voxsoft_solid::vector::{Vec3, axpy, sub};

use super::Implicit;

/// The kinetic energy over the elastic one above which a step looks whether the motion goes on as it did.
const VIOLENT: f64 = 1e-3;

impl Implicit {
    /// Whether the body moves so fast, or has changed so much, that its motion cannot be foreseen.
    pub(super) fn is_violent(&self) -> bool {
        let kinetic = self.state.kinetic_energy(self.problem.body().masses());
        !(kinetic <= VIOLENT * self.value.energy)
    }

    /// Where the search begins: the motion goes on as it did, clamps are where they belong.
    pub(super) fn predicted(&self, time: f64) -> Vec<Vec3> {
        let step = time - self.state.time;
        let mut positions = self.state.positions.clone();
        if let Some(before) = &self.before {
            let ratio = 0.5 * step * step / (self.state.time - before.time);
            let velocities = self.state.velocities.iter().zip(&before.velocities);
            for (x, (v, old)) in positions.iter_mut().zip(velocities) {
                axpy(x, step, *v);
                axpy(x, ratio, sub(*v, *old));
            }
        } else {
            for (x, v) in positions.iter_mut().zip(&self.state.velocities) {
                axpy(x, step, *v);
            }
        }
        self.place(time, &mut positions);
        positions
    }

    /// Where it begins instead: where the body is, but for its clamps.
    pub(super) fn stayed(&self, time: f64) -> Vec<Vec3> {
        let mut positions = self.state.positions.clone();
        self.place(time, &mut positions);
        positions
    }
}
