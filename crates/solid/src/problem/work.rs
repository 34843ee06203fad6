//! Work of loads and clamps over a step of a motion, by the mean of the forces at both ends.
//!
//! The work differs from that of the motion by the third power of the length of the step, which is the error of a step
//! of second order. A load that jumps acts in such steps as if it had gone evenly to its new value. Velocities of held
//! vertices may jump, and the force of a clamp is large then: its work is the gain in kinetic energy of its vertices,
//! the loss by damping, and minus the work of all other forces there.

use std::borrow::Cow;

use super::Problem;
use crate::vector::{Vec3, add, dot, scale, sub};
use crate::{Past, State, Velocities, elastic};

/// One end of a step.
#[derive(Debug)]
pub struct StepEnd {
    problem: Problem,
    state: State,
    past: Option<Past>,
}

impl StepEnd {
    /// A problem that has begun the time of a state, with the loads there, and the past of the motion.
    pub fn new(mut problem: Problem, state: State, past: Option<Past>) -> Self {
        let (positions, velocities) = (&state.positions, &state.velocities);
        // Forces are those at the state itself, for which the rate of the velocities does not count.
        problem.begin_motion(|| Velocities::of(positions, velocities, 1.0), positions);
        Self {
            problem,
            state,
            past,
        }
    }

    fn seen(&self) -> Cow<'_, [Vec3]> {
        self.problem.seen(&self.state.positions)
    }

    /// Forces of a load in N.
    fn forces_of(&self, load: usize) -> Vec<Vec3> {
        let positions = self.seen();
        let mut forces = vec![[0.0; 3]; positions.len()];
        let load = &self.problem.loads[load];
        let factor = load.history.at(self.state.time);
        let on = self.problem.vertices(&positions);
        load.kind.add_forces(on, factor, &mut forces);
        forces
    }

    /// All forces without inertia, damping and reactions, in N.
    fn net(&self) -> Vec<Vec3> {
        if let Some(past) = &self.past {
            let pairs = past.internal.iter().zip(&past.external);
            return pairs.map(|(a, b)| add(*a, *b)).collect();
        }
        let positions = &self.state.positions;
        let mut forces = vec![[0.0; 3]; positions.len()];
        elastic::add_forces(self.problem.body(), positions, &mut forces);
        self.problem
            .add_loads(positions, self.state.time, &mut forces);
        forces
    }
}

/// Work of a load in J over the step between two states.
///
/// # Panics
///
/// A load that there is not.
pub fn work_of_load([before, after]: &[StepEnd; 2], load: usize) -> f64 {
    let (from, to) = (before.seen(), after.seen());
    let forces = [before, after].map(|end| end.forces_of(load));
    let ways = to.iter().zip(from.iter()).map(|(x, old)| sub(*x, *old));
    let [first, last] = &forces;
    let pairs = first.iter().zip(last).map(|(old, new)| add(*old, *new));
    ways.zip(pairs)
        .map(|(way, force)| 0.5 * dot(way, force))
        .sum()
}

/// Work of each clamp in J over the step between two states. The last clamp that holds an axis of a vertex moves it.
pub fn work_of_clamps([before, after]: &[StepEnd; 2]) -> Vec<f64> {
    let problem = &after.problem;
    let [first, last] = [before, after].map(StepEnd::net);
    let masses = problem.body().masses();
    let rate = after.past.as_ref().map_or(0.0, |past| past.damping_rate);
    let mut owners = vec![[usize::MAX; 3]; masses.len()];
    for (index, clamp) in problem.clamps().iter().enumerate() {
        for &vertex in &clamp.vertices {
            let owner = &mut owners[vertex as usize];
            (0..3)
                .filter(|axis| clamp.axes[*axis])
                .for_each(|axis| owner[axis] = index);
        }
    }
    let mut work = vec![0.0; problem.clamps().len()];
    for (vertex, owner) in owners.iter().enumerate() {
        let way = sub(
            after.state.positions[vertex],
            before.state.positions[vertex],
        );
        let (old, new) = (
            before.state.velocities[vertex],
            after.state.velocities[vertex],
        );
        let (mass, mean) = (masses[vertex], scale(0.5, add(old, new)));
        for axis in (0..3).filter(|axis| owner[*axis] != usize::MAX) {
            let gained = 0.5 * mass * (new[axis].powi(2) - old[axis].powi(2));
            let lost = rate * mass * mean[axis] * way[axis];
            let done = 0.5 * (first[vertex][axis] + last[vertex][axis]) * way[axis];
            work[owner[axis]] += gained + lost - done;
        }
    }
    work
}
