//! Relaxation of a lattice body of voxels, several constraints at a time in SIMD lanes.

use voxsoft_solid::balance::{Balance, balance_of_forces};
use voxsoft_solid::lattice::strips::{Columns, Strips};
use voxsoft_solid::{Problem, State};

use super::{Arrays, damped};
use crate::motion::{self, Advance};
use crate::slots::SlotProblem;

pub(super) struct OnStrips<'a> {
    problem: &'a Problem,
    strips: &'a Strips,
    slots: SlotProblem,
    positions: Columns,
    velocities: Columns,
    forces: Columns,
    before: Columns,
    /// Forces of a check, kept apart from those of two steps.
    looked: Columns,
    masses: Vec<f64>,
    /// Inverse mass of the vertex in a slot; zero in slots without a vertex.
    inverse_masses: Vec<f64>,
}

impl<'a> OnStrips<'a> {
    pub fn new(problem: &'a Problem, strips: &'a Strips) -> Self {
        let empty = Columns::zeros(strips.slots());
        Self {
            problem,
            strips,
            slots: SlotProblem::new(problem, strips),
            positions: empty.clone(),
            velocities: empty.clone(),
            forces: empty.clone(),
            before: empty.clone(),
            looked: empty,
            masses: vec![0.0; strips.slots()],
            inverse_masses: vec![0.0; strips.slots()],
        }
    }

    /// Removes vertical forces that the floor carries: those that press vertices on it downward.
    fn release_on_floor(&mut self) {
        let Some(floor) = self.problem.floor() else {
            return;
        };
        let height = self.positions.axes()[2];
        let [_, _, force] = self.forces.axes_mut();
        for (force, height) in force.iter_mut().zip(height) {
            if floor.carries(*height, *force) {
                *force = 0.0;
            }
        }
    }

    fn advance(&mut self, (keep, gain): (f64, f64)) {
        let positions = self.positions.axes_mut();
        let velocities = self.velocities.axes_mut();
        for (axis, (position, velocity)) in positions.into_iter().zip(velocities).enumerate() {
            let advance = Advance {
                position,
                velocity,
                force: self.forces.axes()[axis],
                inverse_masses: &self.inverse_masses,
                free: &self.slots.free[axis],
                keep,
                gain,
                step: 1.0,
            };
            advance.run();
        }
        let Some(floor) = self.problem.floor() else {
            return;
        };
        let height = self.positions.axes_mut()[2].iter_mut();
        let rise = self.velocities.axes_mut()[2].iter_mut();
        for ((height, rise), free) in height.zip(rise).zip(&self.slots.free[2]) {
            let stopped = floor.stop(*height);
            if *free != 0 && stopped != *height {
                *height = stopped;
                *rise = 0.0;
            }
        }
    }
}

impl Arrays for OnStrips<'_> {
    fn load(&mut self, state: &State) {
        self.strips.load(&state.positions, &mut self.positions);
        self.strips.load(&state.velocities, &mut self.velocities);
        self.forces.clear();
        self.slots.forget_placed();
    }

    fn store(&self, state: &mut State) {
        self.strips.store(&self.positions, &mut state.positions);
        self.strips.store(&self.velocities, &mut state.velocities);
    }

    fn balance(&mut self, state: &State) -> Balance {
        let count = state.positions.len();
        let (mut external, mut net) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let time = f64::INFINITY;
        let (problem, strips) = (self.problem, self.strips);
        self.slots
            .set_loads(problem, strips, &self.positions, time, &mut self.looked);
        self.strips.store(&self.looked, &mut external);
        self.strips.add_forces(&self.positions, &mut self.looked);
        self.strips.store(&self.looked, &mut net);
        balance_of_forces(self.problem, &state.positions, &external, net)
    }

    fn renew_masses(&mut self, factor: f64) {
        self.masses.fill(0.0);
        self.strips.add_row_sums(&self.positions, &mut self.masses);
        for (mass, inverse) in self.masses.iter_mut().zip(&mut self.inverse_masses) {
            *mass *= factor;
            *inverse = if *mass > 0.0 { 1.0 / *mass } else { 0.0 };
        }
    }

    fn kinetic_energy(&self) -> f64 {
        motion::kinetic_energy(&self.velocities, &self.masses)
    }

    fn step(&mut self, ramp: f64) {
        let time = f64::INFINITY;
        let (problem, strips) = (self.problem, self.strips);
        self.slots
            .place_clamps(problem, strips, time, ramp, &mut self.positions);
        std::mem::swap(&mut self.before, &mut self.forces);
        self.slots
            .set_loads(problem, strips, &self.positions, time, &mut self.forces);
        self.strips.add_forces(&self.positions, &mut self.forces);
        self.release_on_floor();
        // Held axes have no velocity, so their forces do not count.
        let frequency = motion::frequency(
            &self.velocities,
            &self.before,
            &self.forces,
            &self.masses,
            1.0,
        );
        self.advance(damped(frequency));
    }
}
