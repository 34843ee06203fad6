//! Relaxation of any body, one vertex at a time.

use voxsoft_solid::balance::{Balance, balance, rests_on_floor};
use voxsoft_solid::vector::Vec3;
use voxsoft_solid::{Problem, State, elastic};

use super::{Arrays, damped};
use crate::damping;

pub(super) struct OnVertices<'a> {
    problem: &'a Problem,
    state: State,
    row_sums: Vec<f64>,
    masses: Vec<f64>,
    forces: Vec<Vec3>,
    before: Vec<Vec3>,
}

impl<'a> OnVertices<'a> {
    pub fn new(problem: &'a Problem) -> Self {
        let count = problem.body().rest().len();
        Self {
            problem,
            state: State::at_rest(problem.body()),
            row_sums: vec![0.0; count],
            masses: vec![0.0; count],
            forces: vec![[0.0; 3]; count],
            before: vec![[0.0; 3]; count],
        }
    }
}

impl Arrays for OnVertices<'_> {
    fn load(&mut self, state: &State) {
        self.state.clone_from(state);
        self.before.fill([0.0; 3]);
    }

    fn store(&self, state: &mut State) {
        state.clone_from(&self.state);
    }

    fn balance(&mut self, state: &State) -> Balance {
        balance(self.problem, &state.positions, f64::INFINITY)
    }

    fn renew_masses(&mut self, factor: f64) {
        elastic::row_sums(
            self.problem.body(),
            &self.state.positions,
            &mut self.row_sums,
        );
        for (mass, sum) in self.masses.iter_mut().zip(&self.row_sums) {
            *mass = factor * sum;
        }
    }

    fn kinetic_energy(&self) -> f64 {
        self.state.kinetic_energy(&self.masses)
    }

    fn step(&mut self, ramp: f64) {
        let (problem, state) = (self.problem, &mut self.state);
        problem.place_clamps(state.time, ramp, &mut state.positions);
        self.forces.fill([0.0; 3]);
        problem.add_loads(&state.positions, state.time, &mut self.forces);
        elastic::add_forces(problem.body(), &state.positions, &mut self.forces);
        release_supported(problem, &state.positions, &mut self.forces);
        let frequency = damping::frequency(
            &state.velocities,
            &self.before,
            &self.forces,
            &self.masses,
            1.0,
        );
        self.before.clone_from(&self.forces);
        advance(
            problem,
            state,
            &self.forces,
            &self.masses,
            damped(frequency),
        );
    }
}

/// Removes the forces that clamps and floor carry.
fn release_supported(problem: &Problem, positions: &[Vec3], forces: &mut [Vec3]) {
    for (vertex, force) in forces.iter_mut().enumerate() {
        for axis in 0..3 {
            if problem.held()[vertex][axis]
                || rests_on_floor(problem, vertex, axis, positions, force[axis])
            {
                force[axis] = 0.0;
            }
        }
    }
}

/// Takes one central-difference step of unit length, with velocities at half steps.
fn advance(
    problem: &Problem,
    state: &mut State,
    forces: &[Vec3],
    masses: &[f64],
    (keep, gain): (f64, f64),
) {
    for vertex in 0..forces.len() {
        for axis in 0..3 {
            let velocity = &mut state.velocities[vertex][axis];
            *velocity = keep * *velocity + gain * forces[vertex][axis] / masses[vertex];
            if problem.held()[vertex][axis] {
                *velocity = 0.0;
            }
            state.positions[vertex][axis] += *velocity;
        }
        if let Some(floor) = problem.floor()
            && !problem.held()[vertex][2]
        {
            let height = &mut state.positions[vertex][2];
            let stopped = floor.stop(*height);
            if stopped != *height {
                *height = stopped;
                state.velocities[vertex][2] = 0.0;
            }
        }
    }
}
