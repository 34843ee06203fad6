//! Loads that depend on velocities, within the steps of a motion.

use std::sync::Arc;

use super::Problem;
use crate::vector::Vec3;
use crate::{Fluid, Load, Velocities};

impl Problem {
    /// This problem for the steps of a motion, within which tendons with friction and drag have a potential.
    #[must_use]
    pub fn with_held_loads(mut self) -> Self {
        for load in &mut self.loads {
            load.kind = load.kind.held();
        }
        self.conservative = self.loads.iter().all(|load| load.kind.is_conservative());
        self
    }

    /// Tests whether some loads depend on velocities.
    pub fn feels_motion(&self) -> bool {
        self.loads.iter().any(|load| load.kind.feels_motion())
    }

    /// Begins a time step in which velocities are `v = σ (x − x̂)` for the loads that depend on them, with the rate `σ`
    /// (1/s) and the positions `x̂` (m); its end is expected near `near` (m). Without it these loads see a body at rest.
    pub fn begin_motion(&mut self, velocities: impl FnOnce() -> Velocities, near: &[Vec3]) {
        if !self.feels_motion() {
            return;
        }
        let mut velocities = velocities();
        self.body.ties().follow(&mut velocities.from);
        let velocities = Arc::new(velocities);
        let near = self.body.ties().seen(near);
        for load in &mut self.loads {
            load.kind.begin(&velocities, &near);
        }
    }

    /// The potential (J) of the loads whose forces do not depend on velocities: energy that a motion may get back.
    pub fn stored_load_potential(
        &self,
        positions: &[Vec3],
        factor_of: &dyn Fn(&Load) -> f64,
    ) -> f64 {
        let positions = &*self.seen(positions);
        let on = self.vertices(positions);
        let stored = self.loads.iter().filter(|load| !load.kind.feels_motion());
        let of_loads: f64 = stored
            .map(|load| load.kind.potential(on, factor_of(load)))
            .sum();
        let of_fluid = |fluid: &Fluid| fluid.potential(positions, fluid.instant(factor_of));
        self.fluid.as_ref().map_or(0.0, of_fluid) + of_loads
    }
}
