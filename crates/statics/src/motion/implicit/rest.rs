//! Test for rest, and the critical damping that reaches it soonest.

use voxsoft_solid::balance::{balance_of_forces, is_still_with};
use voxsoft_solid::loads::grabs::loads_end;
use voxsoft_solid::vector::{Vec3, add, dot, sub};
use voxsoft_solid::{LiveStatus, State, elastic};

use super::Implicit;
use super::objective::Value;

impl Implicit {
    /// Tests whether the body is at rest, and sets the status.
    pub(super) fn judge(&mut self) {
        let positions = &self.state.positions;
        let sum = |forces: &[Vec3]| {
            let pairs = forces.iter().zip(&self.value.external);
            pairs.map(|(a, b)| add(*a, *b)).collect()
        };
        let residual = |net| {
            let external = &self.value.external;
            balance_of_forces(&self.problem, positions, external, net).relative_residual()
        };
        self.residual = residual(sum(&self.value.elastic));
        let tolerance = self.settings.tolerance;
        let settled = self.grabs.arrived() && self.state.time >= loads_end(&self.problem);
        let kinetic = self.state.kinetic_energy(self.problem.body().masses());
        if !settled
            || self.residual > tolerance
            || !is_still_with(&self.problem, self.value.energy, kinetic, tolerance)
        {
            return;
        }
        // Pressures and viscous stress may not have converged: only the elastic forces decide.
        let mut elastic = vec![[0.0; 3]; positions.len()];
        elastic::add_forces(self.problem.body(), positions, &mut elastic);
        self.residual = residual(sum(&elastic));
        if self.residual <= tolerance {
            self.status = LiveStatus::AtRest;
        }
    }

    /// Estimate of the frequency (rad/s) of the present motion: the change of all forces along the motion over the
    /// motion's inertia is a Rayleigh quotient of `M⁻¹ K`.
    pub(super) fn frequency(&self, next: &State, value: &Value) -> f64 {
        if self.value.elastic.is_empty() {
            return 0.0;
        }
        let before = &self.state.positions;
        // Present loads, so that a change of a load counts as no stiffness.
        let mut loads = vec![[0.0; 3]; before.len()];
        self.problem.add_soft_loads(before, next.time, &mut loads);
        let mut after = vec![[0.0; 3]; before.len()];
        self.problem
            .add_soft_loads(&next.positions, next.time, &mut after);
        let (mut stiffness, mut inertia) = (0.0, 0.0);
        for (vertex, mass) in self.problem.body().masses().iter().enumerate() {
            let way = sub(next.positions[vertex], before[vertex]);
            let elastic = sub(self.value.elastic[vertex], value.elastic[vertex]);
            stiffness += dot(way, add(elastic, sub(loads[vertex], after[vertex])));
            inertia += mass * dot(way, way);
        }
        for (_, grab) in self.grabs.all() {
            let vertex = grab.vertex as usize;
            let way = sub(next.positions[vertex], before[vertex]);
            stiffness += grab.stiffness * dot(way, way);
        }
        if inertia > 0.0 {
            (stiffness / inertia).max(0.0).sqrt()
        } else {
            0.0
        }
    }
}
