//! Forces and energies of a state, and the balance of energy over a step.

use voxsoft_solid::balance::NEGLIGIBLE_STRAIN;
use voxsoft_solid::vector::{Vec3, add, dot, scale, sub};
use voxsoft_solid::{Problem, State, Term, elastic};

use super::Newton;
use crate::motion::run::{Now, Run};
use crate::motion::scheme::Stage;

/// Tolerance of energy gains, relative to the energy converted in a step: the work of loads that follow the body is
/// known to second order only.
const GAIN: f64 = 1e-2;
/// Tolerance of energy gains, relative to the kinetic energy: that of a steady rotation oscillates by the square of the
/// angle of a step after any change of the step.
const GAIN_OF_MOTION: f64 = 1e-3;
/// Relative rounding of energies, which are sums of many terms.
const ROUNDING: f64 = 1e-9;

impl Now {
    pub(super) fn take_reactions(
        &mut self,
        problem: &Problem,
        accelerations: impl Iterator<Item = Vec3>,
    ) {
        let forces = self.internal.iter().zip(&self.external);
        let all = forces.zip(problem.body().masses()).zip(accelerations);
        let each = all.map(|(((f, load), mass), a)| sub(scale(*mass, a), add(*f, *load)));
        self.reactions = each.collect();
    }
}

impl Run {
    /// Forces and energies at a state, with reactions as of a body at rest.
    pub(super) fn look_at(&self, state: &State) -> Now {
        let (problem, positions) = (&self.problem, &state.positions);
        let mut internal = vec![[0.0; 3]; positions.len()];
        elastic::add_forces(problem.body(), positions, &mut internal);
        let mut external = vec![[0.0; 3]; positions.len()];
        problem.add_loads(positions, state.time, &mut external);
        for (_, grab) in self.grabs.all() {
            let vertex = grab.vertex as usize;
            external[vertex] = add(external[vertex], grab.force(positions[vertex]));
        }
        let stored = elastic::stored_energy(problem.body(), positions);
        let touching = problem
            .contact()
            .map_or(0.0, |contact| contact.energy(positions));
        let mut now = Now {
            viscous: self.viscous_part(positions, &internal),
            internal,
            external,
            reactions: Vec::new(),
            elastic: stored - touching,
            kinetic: state.kinetic_energy(problem.body().masses()),
        };
        now.take_reactions(problem, std::iter::repeat_n([0.0; 3], positions.len()));
        now
    }

    /// Viscous part of internal forces (N) at `positions`; empty without viscous stress.
    fn viscous_part(&self, positions: &[Vec3], internal: &[Vec3]) -> Vec<Vec3> {
        if !self.problem.is_viscous() {
            return Vec::new();
        }
        let mut elastic = vec![[0.0; 3]; positions.len()];
        elastic::add_stored_forces(self.problem.body(), positions, &mut elastic);
        let pairs = internal.iter().zip(&elastic);
        pairs.map(|(all, elastic)| sub(*all, *elastic)).collect()
    }

    /// Work of growing materials from a state on to a time in s, in J: the increase of the stored energy at fixed
    /// positions.
    fn work_of_growth(&self, from: &State, time: f64) -> f64 {
        if self.problem.body().eigenstrain_end() <= from.time {
            return 0.0;
        }
        let mut problem = self.problem.clone();
        let mut stored = |time: f64| {
            problem.begin(time);
            problem.body().hex8_term().energy(&from.positions)
        };
        let before = stored(from.time);
        stored(time) - before
    }
}

impl Newton {
    /// Tests whether a state has more energy than the last one had and received. A second stage returns the energy that
    /// the first one has lost, so that both count as one step.
    pub(super) fn gains_energy(&self, run: &Run, next: &State, found: &Now) -> bool {
        let (from, then) = match (run.stage, &run.before) {
            (Stage::Second, Some(before)) => (before, &self.begun),
            _ => (&run.state, &run.now),
        };
        let held = run.problem.held();
        let mut work = 0.0;
        for (vertex, (x, old)) in next.positions.iter().zip(&from.positions).enumerate() {
            let way = sub(*x, *old);
            let mean = add(found.external[vertex], then.external[vertex]);
            work += dot(mean, way) / 2.0;
            for axis in (0..3).filter(|axis| held[vertex][*axis]) {
                // A contact that closes within a step acts with its final force for all of it.
                let mean = (found.reactions[vertex][axis] + then.reactions[vertex][axis]) / 2.0;
                let last = found.reactions[vertex][axis];
                work += f64::max(mean * way[axis], last * way[axis]);
            }
            let brake = run.damping_rate * run.problem.body().masses()[vertex];
            let velocities = add(next.velocities[vertex], from.velocities[vertex]);
            work -= brake * dot(velocities, way) / 2.0;
        }
        // Branches of Maxwell elements return some of the energy that they take.
        for (vertex, (now, old)) in found.viscous.iter().zip(&then.viscous).enumerate() {
            let way = sub(next.positions[vertex], from.positions[vertex]);
            work += dot(add(*now, *old), way) / 2.0;
        }
        work += run.work_of_growth(from, next.time);
        let (kinetic, stored) = (found.kinetic - then.kinetic, found.elastic - then.elastic);
        let turned_over = kinetic.abs() + stored.abs() + work.abs();
        let moving = found.kinetic + then.kinetic;
        let stored_in_all = found.elastic.abs() + then.elastic.abs();
        let negligible = NEGLIGIBLE_STRAIN.powi(2) * run.problem.body().unit_strain_energy();
        let allowed = GAIN * turned_over + GAIN_OF_MOTION * moving + ROUNDING * stored_in_all;
        kinetic + stored - work > allowed + negligible
    }
}
