//! Test for rest, and the critical damping that reaches it soonest.

use voxsoft_solid::balance::{balance_of_forces, is_still_with};
use voxsoft_solid::loads::grabs::loads_end;
use voxsoft_solid::vector::{Vec3, add, dot, norm, sub};
use voxsoft_solid::{LiveStatus, State};

use super::integrator::{InnerSearch, Integrator};
use super::run::{Now, Run};

/// Distance to rest at which a body counts as there, relative to its largest displacement, over the tolerance of its
/// residual: forces that balance each other hide those of a soft bend, which then has a tenth of its way to go.
const REMAINING: f64 = 10.0;

impl<S: InnerSearch> Integrator<S> {
    /// Updates the residual, and the status of a body at rest.
    pub(super) fn judge(&mut self) {
        let (residual, at_rest) = self.rest(self.run.residual());
        self.run.residual = residual;
        if at_rest {
            self.run.status = LiveStatus::AtRest;
        }
    }

    /// Tests whether the body is at rest, given the relative residual of all forces; returns that of the equilibrium if
    /// nothing else moves.
    pub(super) fn rest(&self, residual: f64) -> (f64, bool) {
        let run = &self.run;
        let tolerance = run.settings.tolerance;
        let quiet = run.grabs.arrived()
            && run.state.time >= loads_end(&run.problem)
            && self.search.fluid_is_at_rest(run)
            && residual <= tolerance
            && is_still_with(&run.problem, run.now.elastic, run.now.kinetic, tolerance)
            && run.remaining <= REMAINING * tolerance * run.largest_move();
        if !quiet {
            return (residual, false);
        }
        let residual = self.search.residual_at_rest(run, residual);
        (residual, residual <= tolerance)
    }
}

impl Run {
    /// Relative residual of an equilibrium without inertia.
    pub fn residual(&self) -> f64 {
        let pairs = self.now.internal.iter().zip(&self.now.external);
        self.residual_of(pairs.map(|(a, b)| add(*a, *b)).collect())
    }

    /// Relative residual of net forces (N) at the state.
    pub fn residual_of(&self, net: Vec<Vec3>) -> f64 {
        let external = &self.now.external;
        balance_of_forces(&self.problem, &self.state.positions, external, net).relative_residual()
    }

    /// Largest displacement of a vertex from the unloaded body, m.
    fn largest_move(&self) -> f64 {
        let pairs = self.state.positions.iter().zip(self.problem.body().rest());
        pairs
            .map(|(x, rest)| norm(sub(*x, *rest)))
            .fold(0.0, f64::max)
    }

    /// Distance (m) from the end of a step to rest along its way, as the decrease of the net forces by the step
    /// predicts it: that of a body which swings through, or which creeps against its damping.
    pub fn remaining_after(&self, next: &State, found: &Now) -> f64 {
        if self.now.internal.is_empty() || found.internal.is_empty() {
            return 0.0;
        }
        let net = |now: &Now, vertex: usize| add(now.internal[vertex], now.external[vertex]);
        let (mut ahead, mut decrease, mut farthest) = (0.0, 0.0, 0.0f64);
        for (vertex, (to, from)) in next.positions.iter().zip(&self.state.positions).enumerate() {
            let way = sub(*to, *from);
            let left = net(found, vertex);
            ahead += dot(way, left);
            decrease += dot(way, sub(net(&self.now, vertex), left));
            farthest = farthest.max(norm(way));
        }
        if decrease > 0.0 {
            farthest * ahead.abs() / decrease
        } else {
            0.0
        }
    }

    /// Estimate of the frequency (rad/s) of the present motion: the change of all forces along the motion over the
    /// motion's inertia is a Rayleigh quotient of `M⁻¹ K`.
    pub fn frequency(&self, next: &State, found: &Now) -> f64 {
        if self.now.internal.is_empty() {
            return 0.0;
        }
        let from = &self.state.positions;
        // Present loads, so that a change of a load counts as no stiffness.
        let [mut before, mut after] = [(); 2].map(|()| vec![[0.0; 3]; from.len()]);
        self.problem.add_soft_loads(from, next.time, &mut before);
        self.problem
            .add_soft_loads(&next.positions, next.time, &mut after);
        let (mut stiffness, mut inertia) = (0.0, 0.0);
        for (vertex, mass) in self.problem.body().masses().iter().enumerate() {
            let way = sub(next.positions[vertex], from[vertex]);
            let internal = sub(self.now.internal[vertex], found.internal[vertex]);
            let external = sub(before[vertex], after[vertex]);
            stiffness += dot(way, add(internal, external));
            inertia += mass * dot(way, way);
        }
        for (_, grab) in self.grabs.all() {
            let vertex = grab.vertex as usize;
            let way = sub(next.positions[vertex], from[vertex]);
            stiffness += grab.stiffness * dot(way, way);
        }
        if inertia > 0.0 {
            (stiffness / inertia).max(0.0).sqrt()
        } else {
            0.0
        }
    }
}
